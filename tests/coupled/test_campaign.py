"""Many runs side by side: each as if it were alone, none harmed by another."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from held_leito import wait_until
from same_run import assert_same_run

from coupled.campaign import Task, run_all
from coupled.errors import LeitoError
from coupled.running.run import run_scene
from coupled.scene import load_scene
from coupled.templates import write_template

QUICK = ["time.duration=0.05", "output.figures=false", "output.frames_per_second=0"]
# the grains of the template come to rest in a second, which would end the run: they are never still enough
LONG = ["time.duration=1000.0", "time.stop_at_rest=1e-300", "output.checkpoint_interval=0.02", *QUICK[1:]]
UNSTABLE = ["time.step=4e-4", "time.duration=0.5", "output.history_interval=0.002"]


@pytest.fixture(scope="module")
def grains(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_template("grains", tmp_path_factory.mktemp("campaign") / "grains.toml")


def task(grains: Path, folder: Path, *overrides: str) -> Task:
    return Task(name=folder.name, scene=load_scene(grains, [*QUICK, *overrides]), folder=folder)


def writer_of(folder: Path) -> int:
    """Number of the process that holds the lock on a folder."""
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if any(Path(os.readlink(handle)) == folder for handle in (process / "fd").iterdir()):
                return int(process.name)
        except OSError:
            continue
    raise AssertionError(f"nobody holds {folder}")


def test_runs_have_the_bits_of_a_run_alone_and_a_failing_one_ends_no_other(grains: Path, tmp_path: Path) -> None:
    tasks = [
        task(grains, tmp_path / "one", "grains.seed=1"),
        task(grains, tmp_path / "broken", *UNSTABLE),
        task(grains, tmp_path / "three", "grains.seed=3"),
    ]
    outcomes = run_all(tasks, workers=2, progress=False)
    assert [outcome.task.name for outcome in outcomes] == ["one", "broken", "three"]
    assert [outcome.status for outcome in outcomes] == ["done", "failed", "done"]
    assert "unstable" in outcomes[1].message and "To change: take time.step" in outcomes[1].message
    for outcome in (outcomes[0], outcomes[2]):
        alone = run_scene(outcome.task.scene, out=tmp_path / "alone" / outcome.task.name, threads=1, progress=False)
        assert_same_run(alone, outcome.task.folder)
        # one thread cannot use more processor than time passes; 10 ms is the clock's own grain
        assert 0.0 < outcome.cpu_seconds <= outcome.wall_seconds + 0.01
    assert math.isnan(outcomes[1].wall_seconds)


def test_finished_runs_are_reused_and_begun_ones_taken_up(grains: Path, tmp_path: Path) -> None:
    first = task(grains, tmp_path / "first")
    (done,) = run_all([first], progress=False)
    before = (first.folder / "summary.json").stat().st_mtime_ns
    second = task(grains, tmp_path / "second", "grains.seed=2")
    again, new = run_all([task(grains, tmp_path / "first", "title=Renamed"), second], progress=False)
    assert (again.status, new.status) == ("done", "done")
    assert again.wall_seconds == done.wall_seconds
    assert (first.folder / "summary.json").stat().st_mtime_ns == before, "not computed anew"
    run_all([first], progress=False, overwrite=True)
    assert (first.folder / "summary.json").stat().st_mtime_ns > before


def test_a_run_whose_numbers_are_left_to_the_model_is_known_again(grains: Path, tmp_path: Path) -> None:
    """The folder has numbers where the scene has an "auto" step and factors."""
    left = task(grains, tmp_path / "left", "time.step=auto", "grains.coarsening=2.0", "contact.stiffness_factor=0.5")
    (done,) = run_all([left], progress=False)
    (again,) = run_all([left], progress=False)
    assert (done.status, again.status) == ("done", "done") and again.wall_seconds == done.wall_seconds
    with pytest.raises(LeitoError, match="contact.normal_damping = .* differs"):
        run_all([task(grains, tmp_path / "left", "time.step=auto", "contact.stiffness_factor=0.5")], progress=False)


def test_a_folder_of_another_scene_and_one_for_two_are_refused_before_anything_runs(
    grains: Path, tmp_path: Path
) -> None:
    run_scene(task(grains, tmp_path / "one").scene, out=tmp_path / "one", threads=1, progress=False)
    other = task(grains, tmp_path / "one", "grains.seed=7")
    with pytest.raises(LeitoError, match="grains.seed = 7 differs from 1 of the run in .*one"):
        run_all([task(grains, tmp_path / "new"), other], progress=False)
    with pytest.raises(LeitoError, match="one is the folder of two runs"):
        run_all([other, other], progress=False)
    (tmp_path / "file").write_text("")
    with pytest.raises(LeitoError, match="file is a file; give another folder"):
        run_all([task(grains, tmp_path / "new"), task(grains, tmp_path / "file" / "run")], progress=False)
    assert not (tmp_path / "new").exists()


def test_a_killed_process_loses_no_other_run_and_its_own_goes_on(grains: Path, tmp_path: Path) -> None:
    victim, other = task(grains, tmp_path / "victim", *LONG), task(grains, tmp_path / "other")
    last = task(grains, tmp_path / "last", "grains.seed=2")

    def kill() -> None:
        wait_until((victim.folder / "checkpoint.h5").exists)
        os.kill(writer_of(victim.folder), signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    outcomes = run_all([victim, other, last], workers=2, progress=False)
    killer.join()
    assert [outcome.status for outcome in outcomes] == ["failed", "done", "done"]
    assert "was killed, perhaps for want of memory" in outcomes[0].message


SCRIPT = """
import sys
from pathlib import Path
from coupled.campaign import Task, run_all
from coupled.scene import load_scene
if __name__ == "__main__":
    scene = load_scene(sys.argv[1], sys.argv[3:])
    tasks = [Task(name=name, scene=scene, folder=Path(sys.argv[2]) / name) for name in ("a", "b", "c")]
    for outcome in run_all(tasks, workers=2, progress=False):
        print(outcome.task.name, outcome.status, outcome.message)
"""


@pytest.fixture
def campaign(grains: Path, tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """Two of three long runs on their way, each with a checkpoint."""
    (tmp_path / "script.py").write_text(SCRIPT)
    command = [sys.executable, tmp_path / "script.py", grains, tmp_path, *LONG]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for name in ("a", "b"):
        wait_until((tmp_path / name / "checkpoint.h5").exists, process)
    yield process
    process.kill()


def test_ctrl_c_leaves_a_checkpoint_of_each_run_and_begins_no_other(
    campaign: subprocess.Popen[str], tmp_path: Path
) -> None:
    campaign.send_signal(signal.SIGINT)
    out, said = campaign.communicate(timeout=300)
    a, b, c = out.splitlines()
    assert campaign.returncode == 0 and said == "", said
    for line in (a, b):
        assert "stopped stopped at t = " in line and "--resume" in line
    assert c == "c stopped not begun" and not (tmp_path / "c").exists()
    for name in ("a", "b"):
        assert "stopped at t = " in (tmp_path / name / "log.txt").read_text()


def test_runs_stop_when_the_campaign_itself_is_killed(campaign: subprocess.Popen[str], tmp_path: Path) -> None:
    workers = [writer_of(tmp_path / name) for name in ("a", "b")]
    campaign.kill()
    campaign.wait(timeout=300)
    wait_until(lambda: not any(Path(f"/proc/{worker}").exists() for worker in workers))
    for name in ("a", "b"):
        assert "stopped at t = " in (tmp_path / name / "log.txt").read_text(), "with a checkpoint"


def test_a_shared_bed_is_settled_once(tmp_path: Path) -> None:
    path = write_template("tube", tmp_path / "tube.toml")
    short = ["time.duration=0.01", "bed.time.duration=0.05", "output.figures=false", "output.frames_per_second=0"]
    tasks = [
        Task(name=name, scene=load_scene(path, short), folder=tmp_path / name / "run", shared=tmp_path)
        for name in ("one", "two")
    ]
    assert [outcome.status for outcome in run_all(tasks, workers=2, progress=False)] == ["done", "done"]
    (bed,) = (tmp_path / "beds").iterdir()
    assert (bed / "log.txt").read_text().count("simulated in") == 1
    assert_same_run(tasks[0].folder, tasks[1].folder)
