"""A coupled run that is killed at ten moments, one after the other, ends with the bits of one that nobody touched."""

import csv
import json
import os
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from same_run import assert_same_run

from coupled.output.history import History, read_history
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene
from coupled.templates import write_template

DURATION, KILLED_UNTIL = 0.06, 0.04  # [s]
SETS = [
    f"time.duration={DURATION}", "output.history_interval=0.001", "output.frames_per_second=100",
    "output.checkpoint_interval=0.003", "output.figures=false", "bed.time.duration=0.3", "bed.output.figures=false",
    "structure.loads.0.schedule.over=0.001", "structure.loads.0.total_force=[0.0, -500.0]",
]  # fmt: skip
WAYS: dict[str, tuple[list[str], int]] = {  # changes of the scene, kills
    "glued": ([], 10),
    "facets": (["interface.kind=facets"], 10),
    "sub-cycled": (["interface.substeps=2", "structure.density=10000"], 3),  # heavier, for the stiffness ratio
    "lagged": (["interface.exchange=lagged"], 3),
    "iterated on facets": (["interface.kind=facets", "interface.exchange=iterated", "interface.substeps=2"], 3),
    "corotational": (["interface.kind=facets", "structure.theory=corotational"], 3),
    "iterated": (["interface.exchange=iterated", "interface.substeps=2"], 2),
}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("killed")
    write_template("tube", folder / "tube.toml")
    return folder


def reached(out: Path) -> float:
    """Simulated time [s] of the last whole row of a run."""
    path = out / "history.csv"
    if not path.exists():
        return -1.0
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return max([float(row[0]) for row in rows[1:] if len(row) == len(rows[0])], default=-1.0)


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def before_a_file_appears(out: Path, moment: float) -> None:
    """Die with a file written whole but not in its place."""
    move = os.replace

    def last_move(*args: Any) -> None:
        if reached(out) >= moment:
            die()
        move(*args)

    os.replace = last_move


def after_a_file_appears(out: Path, moment: float) -> None:
    """Die with a file in its place and nothing after it: a frame without its index, a checkpoint."""
    move = os.replace

    def last_move(*args: Any) -> None:
        move(*args)
        if reached(out) >= moment:
            die()

    os.replace = last_move


def in_a_row(out: Path, moment: float) -> None:
    """Die in the middle of a row of the history."""
    write = History.write

    def half(self: History, row: dict[str, float]) -> None:
        if self.last_time >= moment:
            with open(self.path, "a") as file:
                file.write("0.05,1.23")
            die()
        write(self, row)

    History.write = half  # type: ignore[method-assign]


def from_outside(out: Path, moment: float) -> None:
    """Be killed by the parent, wherever it is; a run does not go on to its end before that."""
    write = History.write

    def wait(self: History, row: dict[str, float]) -> None:
        write(self, row)
        if self.last_time >= KILLED_UNTIL:
            time.sleep(300.0)

    History.write = wait  # type: ignore[method-assign]


def killed(scene: Scene, out: Path, moment: float, way: Callable[[Path, float], None]) -> bool:
    """Run or take up a scene in a process of its own that dies after the moment [s]; whether it did."""
    process = os.fork()
    if process == 0:
        try:
            way(out, moment)
            run_scene(scene, out=out, resume=out.exists(), threads=1, progress=False)
        finally:
            os._exit(3)
    status = (0, 0)
    while status[0] == 0:
        status = os.waitpid(process, os.WNOHANG)
        if way is from_outside and status[0] == 0 and reached(out) >= moment:
            os.kill(process, signal.SIGKILL)
        time.sleep(0.002)
    return os.WIFSIGNALED(status[1]) and os.WTERMSIG(status[1]) == signal.SIGKILL


@pytest.mark.parametrize("way", WAYS)
def test_ten_kills_leave_no_trace(way: str, place: Path) -> None:
    sets, kills = WAYS[way]
    scene = load_scene(place / "tube.toml", [*SETS, *sets])
    whole = run_scene(scene, out=place / "runs" / f"{way} whole", threads=1, progress=False)
    pushed = read_history(whole / "history.csv")["reaction_y"] > 0.0
    assert pushed.mean() > 0.5, "grains push the structure while the run is killed"
    random = np.random.default_rng(sorted(WAYS).index(way))
    moments = KILLED_UNTIL * (np.arange(kills) + random.uniform(0.1, 0.9, kills)) / (kills + 1)
    kinds = random.permutation([from_outside, before_a_file_appears, after_a_file_appears, in_a_row, from_outside] * 2)
    out = place / "runs" / f"{way} killed"
    for moment, kind in zip(moments, kinds[:kills], strict=True):
        assert killed(scene, out, moment, kind), (moment, kind)
    assert not (out / "summary.json").exists()
    run_scene(scene, out=out, resume=True, threads=1, progress=False)
    assert_same_run(whole, out)
    done = json.loads((out / "summary.json").read_text())
    assert done["steps"] == json.loads((whole / "summary.json").read_text())["steps"]
