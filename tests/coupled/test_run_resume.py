"""Stopped, killed, broken: a run goes on from its last good checkpoint with the same bits."""

import errno
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from held_leito import held_leito, wait_until
from same_run import assert_same_run

from coupled.errors import LeitoError
from coupled.output import checkpoint
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene
from coupled.templates import write_template
from coupled.running.watchdog import Unstable

LEITO = [sys.executable, "-m", "coupled.cli"]
QUICK = ["time.duration=0.4", "output.checkpoint_interval=0.02", "output.figures=false"]


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the small tube scene."""
    folder = tmp_path_factory.mktemp("resume")
    write_template("tube", folder / "tube.toml")
    return folder


@pytest.fixture(scope="module")
def scene(place: Path) -> Scene:
    return load_scene(place / "tube.toml", QUICK)


@pytest.fixture(scope="module")
def whole(place: Path, scene: Scene) -> Path:
    """The run that nobody stopped; it leaves the bed for the others."""
    return run_scene(scene, out=place / "runs" / "whole", threads=1, progress=False)


@pytest.mark.parametrize("wish", [signal.SIGINT, signal.SIGTERM])
def test_a_stop_leaves_a_checkpoint_and_says_how_to_go_on(
    wish: signal.Signals, place: Path, scene: Scene, whole: Path
) -> None:
    out = place / "runs" / wish.name
    sets = [part for text in QUICK for part in ("--set", text)]
    command = ["run", "tube.toml", "--out", f"runs/{wish.name}", "--threads", "1", "--no-progress", *sets]
    process = held_leito(command, at=0.2, cwd=place)
    wait_until((out / "checkpoint.h5").exists, process)
    process.send_signal(wish)
    _, said = process.communicate(timeout=300)
    assert process.returncode == 130, said
    assert "stopped at t = " in said and "--resume" in said and "Traceback" not in said
    stopped, _ = checkpoint.load(out / "checkpoint.h5")
    assert 0 < int(stopped["model.steps_done"]) < 8000
    assert_same_run(whole, run_scene(scene, out=out, resume=True, threads=1, progress=False))


def test_two_threads_give_the_bits_of_one(place: Path, scene: Scene, whole: Path) -> None:
    two = run_scene(scene, out=place / "runs" / "threads", threads=2, progress=False)
    assert_same_run(whole, two)


def test_a_finished_run_can_be_prolonged(place: Path, whole: Path) -> None:
    short = load_scene(place / "tube.toml", [*QUICK, "time.duration=0.2"])
    out = run_scene(short, out=place / "runs" / "prolonged", threads=1, progress=False)
    longer = load_scene(place / "tube.toml", QUICK)
    run_scene(longer, out=out, resume=True, threads=1, progress=False)
    a, _ = checkpoint.load(whole / "checkpoint.h5")
    b, _ = checkpoint.load(out / "checkpoint.h5")
    np.testing.assert_array_equal(a["particles.grains.x"], b["particles.grains.x"])


def test_a_cut_checkpoint_is_refused_in_one_sentence(tmp_path: Path) -> None:
    checkpoint.save(tmp_path / "checkpoint.h5", {"a": np.arange(1000.0)}, scene="x")
    data = (tmp_path / "checkpoint.h5").read_bytes()
    (tmp_path / "checkpoint.h5").write_bytes(data[: len(data) // 2])
    with pytest.raises(LeitoError, match="cannot be read as a checkpoint.*--overwrite"):
        checkpoint.load(tmp_path / "checkpoint.h5")


def test_a_full_disk_is_one_sentence_and_costs_nothing(
    place: Path, scene: Scene, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    full, moves, move = place / "runs" / "full", [0], os.replace

    def refuse(*names: Path) -> None:
        moves[0] += 1
        if moves[0] == 30:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        move(*names)

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(LeitoError, match=r"full cannot be written to \(No space left on device\): make room.*--resume"):
        run_scene(scene, out=full, threads=1, progress=False)
    monkeypatch.undo()
    assert_same_run(whole, run_scene(scene, out=full, resume=True, threads=1, progress=False))


def test_a_run_that_explodes_stops_itself(tmp_path: Path) -> None:
    """A step below the limit of one contact and above that of grains with several: a watchdog ends it."""
    path = write_template("grains", tmp_path / "grains.toml")
    scene = load_scene(path, ["time.step=4e-4", "output.history_interval=0.002", "output.figures=false"])
    with pytest.raises(Unstable, match="t = .* s, the run is unstable: .* To change: take time.step"):
        run_scene(scene, out=tmp_path / "run", threads=1, progress=False)
    assert not (tmp_path / "run" / "checkpoint.h5").exists(), "no checkpoint of a broken state"


def test_coupled_scene_under_mpirun_gives_the_serial_answer(place: Path, whole: Path) -> None:
    sets = [part for text in QUICK for part in ("--set", text)]
    command = ["mpirun", "-n", "2", "--oversubscribe", *LEITO, "run", "tube.toml", "--out", "runs/ranks"]
    environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    done = subprocess.run(
        [*command, "--threads", "1", "--no-progress", *sets, "--set", "time.duration=0.05"],
        cwd=place, env=environment, text=True, capture_output=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("over-damps") == 1, "one rank speaks"
    serial = np.loadtxt(whole / "history.csv", delimiter=",", skiprows=1)
    parallel = np.loadtxt(place / "runs" / "ranks" / "history.csv", delimiter=",", skiprows=1)
    names = (whole / "history.csv").read_text().splitlines()[0].split(",")
    assert len(parallel) == 6
    for name in ("reaction_y [N/m]", "centroid_y [m]", "max_von_mises [Pa]"):
        column = names.index(name)
        scale = np.abs(serial[:6, column]).max()
        # the agreed bound; the two differ by the order of sums inside the solver
        np.testing.assert_allclose(parallel[:, column], serial[:6, column], rtol=1e-9, atol=1e-9 * scale)


def test_beam_vibration_under_mpirun_gives_the_serial_answer(place: Path) -> None:
    sets = ["--set", "time.duration=0.004", "--set", "output.figures=false", "--no-progress"]
    environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    rows = []
    for ranks in (1, 2):
        command = ["mpirun", "-n", str(ranks), "--oversubscribe", *LEITO, "run", "beam_vibration"]
        done = subprocess.run(
            [*command, "--out", f"runs/vibration{ranks}", *sets],
            cwd=place, env=environment, text=True, capture_output=True, timeout=300,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        rows.append(np.loadtxt(place / "runs" / f"vibration{ranks}" / "history.csv", delimiter=",", skiprows=1))
        assert (place / "runs" / f"vibration{ranks}" / "structure.xdmf").exists()
    assert rows[0].shape == rows[1].shape and len(rows[0]) > 5
    scale = np.abs(rows[0]).max(axis=0)
    # columns that are pure round-off (momentum, ledger error) are compared against the energy
    names = (place / "runs" / "vibration1" / "history.csv").read_text().splitlines()[0].split(",")
    energy = scale[names.index("structure_kinetic [J/m]")]
    for column, name in enumerate(names):
        if name.startswith("ledger"):
            continue  # pure round-off on any number of ranks
        # the centroid stays at the origin but for round-off: lengths are compared with the beam's
        own = {"J/m": energy, "m": 1.0, "rad": 1.0, "-": 1e-3}.get(name.partition("[")[2].rstrip("]"), 0.0)
        atol = 1e-9 * max(scale[column], own)
        np.testing.assert_allclose(rows[1][:, column], rows[0][:, column], rtol=1e-9, atol=atol, err_msg=name)


def test_a_state_that_lacks_something_is_refused_in_one_sentence(place: Path, scene: Scene, whole: Path) -> None:
    old = place / "runs" / "old"
    shutil.copytree(whole, old)
    state, title = checkpoint.load(old / "checkpoint.h5")
    del state["model.boundary"]
    checkpoint.save(old / "checkpoint.h5", state, scene=title)
    (old / "summary.json").unlink()
    with pytest.raises(LeitoError, match="lacks model.boundary, it is of another version: start anew with --overwrite"):
        run_scene(scene, out=old, resume=True, threads=1, progress=False)
