"""What the folder of a task holds already."""

from __future__ import annotations

import json
import math
from pathlib import Path

from coupled.campaign.task import Outcome, Task
from coupled.output.folder import SCENE, SUMMARY, finished, require_same_scene
from coupled.scene import Scene
from coupled.scene.knobs import plain

SHAPELESS = ("title", "bed.title", "quantities", "bed.quantities")  # a run is the same with others


def require_own(task: Task) -> None:
    """Refuse a folder that holds the run of another scene; every key that shapes it counts.

    Raises
    ------
    LeitoError
        Naming the key.
    """
    if (task.folder / SCENE).exists():
        require_same_scene(task.folder, _numbered(task.scene), free=SHAPELESS)


def begun(task: Task) -> bool:
    """Whether there is a run to take up."""
    return (task.folder / SCENE).exists()


def is_done(task: Task) -> bool:
    """Whether there is nothing left to do."""
    return begun(task) and finished(task.folder, task.scene)


def done(task: Task) -> Outcome:
    """The outcome of a finished run, out of its summary."""
    summary = json.loads((task.folder / SUMMARY).read_text())
    return Outcome(
        task=task,
        status="done",
        wall_seconds=summary.get("stepping_seconds", math.nan),
        cpu_seconds=summary.get("cpu_seconds", math.nan),
    )


def share_done(task: Task) -> float:
    """How much of the simulated time is done, 0 to 1, by the last row of the history."""
    last = _last_time(task.folder / "history.csv")
    return min(1.0, last / task.scene.time.duration)


def _last_time(path: Path) -> float:
    """Time of the last row [s]; 0 without one. Only the end of the file is read."""
    try:
        with open(path, "rb") as file:
            file.seek(max(0, path.stat().st_size - 4096))
            return float(file.read().splitlines()[-1].split(b",")[0])
    except (OSError, ValueError, IndexError):
        return 0.0


def _numbered(scene: Scene) -> Scene:
    """The scene with numbers in place of factors, "auto" steps and periods in steps, as a run writes it."""
    scene = plain(scene)
    chain = [scene]
    while (bed := chain[-1].bed) is not None:
        chain.append(bed)
    in_steps = any(one.shaking is not None and one.shaking.period_steps is not None for one in chain)
    if not in_steps and all(one.time.step != "auto" for one in chain):
        return scene
    from coupled.step import with_step  # loads FEniCSx

    return with_step(scene)
