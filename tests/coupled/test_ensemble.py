"""Ensembles: every seed and every combination, the same table whoever runs them, and means that are what they say."""

from __future__ import annotations

import csv
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from held_leito import held_leito, wait_until
from mpi_runs import on_ranks
from scipy import stats

from coupled.ensemble.grid import grid
from coupled.ensemble.samples import samples_of
from coupled.errors import LeitoError
from coupled.running.run import run_scene
from coupled.scene import load_scene
from coupled.templates import write_template

QUICK = ["output.figures=false", "output.frames_per_second=0"]
SHORT = ["time.duration=0.05", *QUICK]
QUANTITIES = """
[[quantities]]
name = "top"
kind = "surface_height"

[[quantities]]
name = "speed"
kind = "value"
column = "fastest_grain"
"""
TABLES = ("ensemble.csv", "ensemble_mean.csv")


@pytest.fixture(scope="module")
def grains(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small bed with two quantities of interest."""
    path = write_template("grains", tmp_path_factory.mktemp("ensemble") / "grains.toml")
    path.write_text(path.read_text() + QUANTITIES)
    return path


def words(scene: Path, out: Path, *more: str, sets: list[str] = SHORT) -> list[str]:
    overrides = [part for text in sets for part in ("--set", text)]
    return ["-m", "coupled.cli", "ensemble", str(scene), "--out", str(out), *overrides, *more]


def leito(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, timeout=300)


def rows_of(path: Path) -> list[dict[str, str]]:
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def same_tables(one: Path, two: Path) -> None:
    for name in TABLES:
        assert (one / name).read_text() == (two / name).read_text()


def test_the_means_are_those_of_runs_made_one_by_one(grains: Path, tmp_path: Path) -> None:
    """Against scipy's interval of runs that were made alone."""
    done = leito(*words(grains, tmp_path / "out", "--samples", "3", "--vary", "contact.friction=0.1,0.8"))
    assert done.returncode == 0, done.stderr
    means = rows_of(tmp_path / "out" / "ensemble_mean.csv")
    assert [(row["contact.friction"], row["quantity"]) for row in means] == [
        ("0.1", "top"), ("0.1", "speed"), ("0.8", "top"), ("0.8", "speed")
    ]  # fmt: skip
    tops = []
    for seed in (1, 2, 3):
        scene = load_scene(grains, [*SHORT, "contact.friction=0.8", f"grains.seed={seed}"])
        alone = run_scene(scene, out=tmp_path / f"alone_{seed}", threads=1, progress=False)
        (column,) = [row for row in rows_of(alone / "history.csv")[-1:]]
        (row,) = [
            row
            for row in rows_of(tmp_path / "out" / "ensemble.csv")
            if (row["contact.friction"], row["seed"]) == ("0.8", str(seed))
        ]
        assert float(row["speed [m/s]"]) == float(column["fastest_grain [m/s]"])
        tops.append(float(row["top [m]"]))
    low, high = stats.t.interval(0.95, 2, loc=sum(tops) / 3, scale=stats.sem(tops))
    top = means[2]
    assert float(top["mean"]) == pytest.approx(0.5 * (low + high), rel=1e-12)  # another order of sums
    assert float(top["half_width_95"]) == pytest.approx(0.5 * (high - low), rel=1e-9)  # a difference of near numbers
    assert "contact.friction  quantity  mean" in done.stdout


def test_one_process_two_and_ranks_give_the_same_table(tmp_path: Path) -> None:
    """An elastic tube on beds of two seeds, so that finite elements and beds are in it."""
    scene = write_template("tube", tmp_path / "tube.toml")
    sets = ["time.duration=0.005", "bed.time.duration=0.05", *QUICK]
    arguments = {name: words(scene, tmp_path / name, "--samples", "2", sets=sets) for name in ("one", "two", "ranks")}
    for name, jobs in (("one", "1"), ("two", "2")):
        done = leito(*arguments[name], "--jobs", jobs)
        assert done.returncode == 0, done.stderr
    done = on_ranks(2, *arguments["ranks"])
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("a row per sample") == 1, "one rank speaks"
    assert [row["seed"] for row in rows_of(tmp_path / "one" / "ensemble.csv")] == ["1", "2"]
    assert len(list((tmp_path / "one" / "beds").iterdir())) == 2, "a bed of each seed"
    same_tables(tmp_path / "one", tmp_path / "two")
    same_tables(tmp_path / "one", tmp_path / "ranks")


def test_a_stopped_ensemble_says_how_to_go_on_and_ends_with_the_same_table(grains: Path, tmp_path: Path) -> None:
    sets = ["time.duration=0.1", "output.checkpoint_interval=0.02", *QUICK]
    command = words(grains, tmp_path / "out", "--samples", "3", "--jobs", "2", sets=sets)
    process = held_leito(command[2:], at=0.05)
    for seed in (1, 2):
        wait_until((tmp_path / "out" / f"seed_{seed}" / "checkpoint.h5").exists, process)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=300)
    assert process.returncode == 130, said
    (line,) = said.strip().splitlines()
    assert line.startswith("leito: stopped with 0 of 3 runs done") and line.endswith(" go on with --resume"), line
    assert not (tmp_path / "out" / "ensemble.csv").exists()
    again = leito(*command)
    assert again.returncode == 2 and "holds a run already; go on with --resume" in again.stderr
    assert leito(*command, "--resume").returncode == 0
    assert leito(*words(grains, tmp_path / "whole", "--samples", "3", sets=sets)).returncode == 0
    same_tables(tmp_path / "out", tmp_path / "whole")


def test_a_sample_that_fails_is_named_and_left_out(grains: Path, tmp_path: Path) -> None:
    """With the larger step the grains explode."""
    sets = ["time.duration=0.5", "output.history_interval=0.002", *QUICK]
    done = leito(*words(grains, tmp_path, "--samples", "1", "--vary", "time.step=1e-4,4e-4", sets=sets))
    assert done.returncode == 2
    assert done.stderr.strip().endswith("1 of 2 samples failed and are left out of the means.")
    (named,) = [line for line in done.stdout.splitlines() if line.startswith("time.step=4e-4/seed_1")]
    assert "the run is unstable" in named
    good, bad = rows_of(tmp_path / "ensemble.csv")
    assert (good["status"], bad["status"], bad["top [m]"]) == ("done", "failed", "")
    counts = [(row["time.step"], row["samples"]) for row in rows_of(tmp_path / "ensemble_mean.csv")]
    assert counts == [("1e-4", "1")] * 2 + [("4e-4", "0")] * 2


REFUSED = [
    (["--samples", "0"], "--samples 0 must be at least 1"),
    (["--vary", "contact.fricton=0.1,0.2"], "contact.fricton is not a known key: did you mean 'friction'"),
    (["--vary", "contact.friction=0.1,-1.0"], "contact.friction = -1 must be at least 0"),
    (["--vary", "time.step=1e-5,1.0", "--vary", "contact.friction=0.1"], "--vary time.step=1.0 contact.friction=0.1: "),
    (["--vary", "contact.friction=0.1", "--vary", "contact.friction=0.2"], "the key is given twice"),
    (["--vary", "contact.friction=0.1", "--set", "contact.friction=0.2"], "the key is given twice"),
    (["--vary", "contact.friction=0.1,0.1"], "would be the folder of two combinations"),
    (["--vary", "contact.friction"], "write it as key=a,b,c"),
    (["--vary", "contact.friction=0.1,,0.2"], "write it as key=a,b,c"),
    (["--vary", "grains.seed=1,2", "--samples", "2"], "the seeds are varied by --samples"),
    (["--samples", "2", "--set", "grains.jitter=0.0", "--set", "grains.sizes=[{radius = 4e-3, count = 9}]"],
     "nothing in"),
    (["--resume", "--overwrite"], "exclude each other"),
]  # fmt: skip


@pytest.mark.parametrize(("arguments", "sentence"), REFUSED)
def test_what_cannot_be_is_refused_before_anything_runs(
    arguments: list[str], sentence: str, grains: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    from coupled import cli

    monkeypatch.setattr(sys, "argv", ["leito", *words(grains, tmp_path / "out", *arguments)[2:]])
    with pytest.raises(SystemExit) as stop:
        cli.main()
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert stop.value.code == 2 and sentence in line
    assert not (tmp_path / "out").exists()


def test_a_scene_without_grains_has_one_sample(tmp_path: Path) -> None:
    (sample,) = samples_of("beam_vibration", 1, out=tmp_path)
    assert sample.seed is None and sample.task.folder == tmp_path / "sample"
    with pytest.raises(LeitoError, match="nothing in beam_vibration is random"):
        samples_of("beam_vibration", 2, out=tmp_path)


def test_the_seed_of_a_bed_below_is_the_one_that_changes(tmp_path: Path) -> None:
    samples = samples_of("elastic_tube", 3, overrides=["bed.grains.seed=7"], out=tmp_path)
    assert [sample.task.scene.bed.grains.seed for sample in samples] == [7, 8, 9]


def test_a_preset_holds_for_every_sample_and_may_be_varied(grains: Path, tmp_path: Path) -> None:
    samples = samples_of(grains, 2, accuracy="draft", vary=["contact.friction=0.1,0.8"], out=tmp_path)
    assert [sample.task.scene.preset.name for sample in samples] == ["draft"] * 4
    samples = samples_of(grains, 1, vary=["accuracy=draft,reference"], out=tmp_path)
    assert [sample.task.scene.preset.name for sample in samples] == ["draft", "reference"]


def test_values_may_be_lists_and_words() -> None:
    found = grid(["gravity=[0.0, -1.0],[0.0, -9.81]", "interface.exchange=predicted,iterated"])
    assert [combination.overrides for combination in found] == [
        ["gravity=[0.0, -1.0]", "interface.exchange=predicted"],
        ["gravity=[0.0, -1.0]", "interface.exchange=iterated"],
        ["gravity=[0.0, -9.81]", "interface.exchange=predicted"],
        ["gravity=[0.0, -9.81]", "interface.exchange=iterated"],
    ]
    assert len({combination.label for combination in found}) == 4
    assert not any(set(combination.label) & set(" /[]\"'") for combination in found)
