"""Two processes at one folder: a bed is settled by one of them and waited for, a run is refused."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from coupled.bed import bed_folder
from coupled.errors import LeitoError
from coupled.output import checkpoint
from coupled.output.lock import only_process
from coupled.running.run import run_scene
from coupled.scene import load_scene
from coupled.step import with_step
from coupled.templates import write_template

LEITO = [sys.executable, "-m", "coupled.cli"]
SHORT = ["time.duration=0.01", "bed.time.duration=0.2", "output.figures=false", "output.frames_per_second=0"]


def start(place: Path, out: str) -> subprocess.Popen[str]:
    sets = [part for text in SHORT for part in ("--set", text)]
    command = [*LEITO, "run", "tube.toml", "--out", f"runs/{out}", "--threads", "1", "--no-progress", *sets]
    return subprocess.Popen(command, cwd=place, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def test_two_processes_that_want_the_same_bed_settle_it_once(tmp_path: Path) -> None:
    """Both find it held by a third one, wait, and when it is free one settles it and the other takes it."""
    scene = load_scene(write_template("tube", tmp_path / "tube.toml"), SHORT)
    with only_process(bed_folder(with_step(scene), tmp_path / "runs")):
        both = [start(tmp_path, name) for name in ("one", "two")]
        for process in both:
            assert "waiting for another process that settles the bed in" in process.stderr.readline()
    said = [process.communicate(timeout=300) for process in both]
    assert [process.returncode for process in both] == [0, 0], said
    assert sum(out.count("Small bed:") for out, _ in said) == 1, "settled once"
    one, two = (checkpoint.load(tmp_path / "runs" / name / "checkpoint.h5")[0] for name in ("one", "two"))
    for name in one.keys() - {"run.seconds"}:
        np.testing.assert_array_equal(one[name], two[name], err_msg=name)


def test_a_folder_that_another_run_holds_is_refused(tmp_path: Path) -> None:
    scene = load_scene(write_template("grains", tmp_path / "grains.toml"), ["time.duration=0.001"])
    with only_process(tmp_path / "run"):
        with pytest.raises(LeitoError, match="run is being written by another process: wait .* --out"):
            run_scene(scene, out=tmp_path / "run", progress=False)
    assert not (tmp_path / "run").exists(), "a folder left empty is removed"


def test_a_folder_that_is_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("mine")
    with pytest.raises(LeitoError, match="run is a file; give another folder"):
        with only_process(tmp_path / "run"):
            pass
    assert (tmp_path / "run").read_text() == "mine"
