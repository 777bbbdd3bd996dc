"""The command line: thin, quick to refuse, one sentence for the user's errors."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import types
from pathlib import Path

import pytest

import coupled
from coupled import cli
from coupled.errors import Interrupted
from coupled.scene import load_scene


@pytest.fixture
def leito(monkeypatch, capsys):
    """Return a function that runs the command line and gives (exit code, stdout, stderr)."""

    def run(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["leito", *map(str, arguments)])
        with pytest.raises(SystemExit) as stop:
            cli.main()
        said = capsys.readouterr()
        return stop.value.code or 0, said.out, said.err

    return run


@pytest.fixture
def stand_in(monkeypatch):
    """Return a function that puts a module of one function in the place of ``coupled.<name>``."""

    def put(name: str, function: str, body) -> None:
        module = types.ModuleType(f"coupled.{name}")
        setattr(module, function, body)
        monkeypatch.setitem(sys.modules, f"coupled.{name}", module)

    return put


def test_version_is_said(leito):
    code, out, _ = leito("--version")
    assert code == 0 and out.startswith("leito ")


def test_list_names_every_scene_with_its_grains(leito):
    code, out, _ = leito("list")
    lines = {line.split()[0]: line for line in out.splitlines()}
    assert code == 0
    assert "15000" in lines["elastic_tube"] and "elastic" in lines["elastic_tube"]
    assert "15000" not in lines["beam_vibration"]


@pytest.mark.parametrize("kind", ["tube", "beam", "grains"])
def test_new_writes_a_scene_that_loads_and_never_overwrites(kind, leito, tmp_path):
    path = tmp_path / "mine.toml"
    code, out, _ = leito("new", kind, "--to", path)
    assert code == 0 and str(path) in out
    scene = load_scene(path)
    assert 100 <= scene.first_grains.count <= 1000
    text = path.read_text()
    code, _, err = leito("new", kind, "--to", path)
    assert code == 2 and "is there already" in err
    assert path.read_text() == text


def test_new_refuses_an_unknown_kind_and_a_missing_folder(leito, tmp_path):
    code, _, err = leito("new", "tub")
    assert code == 2 and "did you mean 'tube'" in err
    code, _, err = leito("new", "tube", "--to", tmp_path / "nowhere" / "a.toml")
    assert code == 2 and "cannot be written" in err


def test_run_hands_everything_over(leito, stand_in, tmp_path):
    calls = []
    stand_in("running.run", "run_scene", lambda scene, **options: calls.append((scene, options)))
    code, *_ = leito(
        "run",
        "bed",
        "--set",
        "time.duration=0.5",
        "--set",
        "grains.sizes.0.count=7",
        "--out",
        tmp_path / "here",
        "--threads",
        2,
        "--overwrite",
        "--no-progress",
    )
    assert code == 0
    scene, options = calls[0]
    assert scene == load_scene("bed", ["time.duration=0.5", "grains.sizes.0.count=7"])
    assert options == {
        "out": tmp_path / "here",
        "resume": False,
        "threads": 2,
        "overwrite": True,
        "progress": False,
    }


@pytest.mark.parametrize(
    ("arguments", "folder"),
    [
        (["elastic_tube"], "runs/elastic_tube"),
        (["scenes/elastic_tube.toml"], "runs/elastic_tube"),
        (["bed", "--set", "output.folder=elsewhere"], "elsewhere"),
    ],
)
def test_run_writes_to_the_folder_of_the_scene(arguments, folder, leito, stand_in, monkeypatch):
    monkeypatch.chdir(Path(coupled.__file__).parents[1])
    calls = []
    stand_in("running.run", "run_scene", lambda scene, **options: calls.append(options["out"]))
    leito("run", *arguments)
    assert calls == [Path(folder)]


def test_check_prints_its_rows(leito, stand_in):
    rows = [("time", "step", "4e-05 s"), ("coupling", "r", "0.3")]
    stand_in("report.check", "check_scene", lambda scene, measure: rows)
    code, out, _ = leito("check", "elastic_tube")
    assert code == 0
    assert [line.split() for line in out.splitlines()[1:]] == [
        ["time", "step", "4e-05", "s"],
        ["coupling", "r", "0.3"],
    ]


def test_plot_names_its_pictures(leito, stand_in, tmp_path):
    stand_in("report.figures", "plot_run", lambda folder: [folder / "figures" / "final.png"])
    code, out, _ = leito("plot", tmp_path)
    assert code == 0 and out.strip().endswith("final.png")
    code, _, err = leito("plot", tmp_path / "absent")
    assert code == 2 and "no such folder" in err


def test_bad_scene_is_one_line_and_exit_code_2(leito):
    code, out, err = leito("run", "elastic_tube", "--set", "structure.youngs_modulus=-1.0")
    assert code == 2 and out == ""
    assert err.splitlines() == [
        "leito: elastic_tube.toml: structure.youngs_modulus = -1 must be greater than 0 (Young's modulus E [Pa])."
    ]


def test_resume_and_overwrite_exclude_each_other(leito):
    code, _, err = leito("run", "bed", "--resume", "--overwrite")
    assert code == 2 and "exclude each other" in err


def test_error_of_a_room_is_a_sentence_and_any_other_is_not_hidden(leito, stand_in, monkeypatch):
    room_error = type("ParticleError", (ValueError,), {"__module__": "particles.errors"})

    def refuse(scene, **options):
        raise room_error("the grains overlap; widen the box.")

    stand_in("running.run", "run_scene", refuse)
    code, _, err = leito("run", "bed")
    assert (code, err) == (2, "leito: the grains overlap; widen the box.\n")

    def fail(scene, **options):
        raise ValueError("a bug of ours")

    stand_in("running.run", "run_scene", fail)
    monkeypatch.setattr(sys, "argv", ["leito", "run", "bed"])
    with pytest.raises(ValueError, match="a bug of ours"):
        cli.main()


def test_interrupted_run_says_how_to_go_on(leito, stand_in):
    def stop(scene, **options):
        raise Interrupted("stopped at 0.3 s; go on with --resume.")

    stand_in("running.run", "run_scene", stop)
    code, _, err = leito("run", "bed")
    assert code == 130 and "--resume" in err


def test_only_the_first_rank_speaks(leito, monkeypatch):
    monkeypatch.setenv("OMPI_COMM_WORLD_RANK", "1")
    code, out, err = leito("run", "nowhere")
    assert (code, out, err) == (2, "", "")


def test_refusal_loads_neither_finite_elements_nor_compiled_kernels():
    """A refusal must not wait for them; a fresh process, because the tests load both."""
    script = (
        "import sys; sys.argv = ['leito', 'run', 'elastic_tube', '--set', 'time.step=-1.0']\n"
        "from coupled.cli import main\n"
        "try: main()\n"
        "finally: print(*{'dolfinx', 'petsc4py', 'mpi4py', 'gmsh', 'numba'} & set(sys.modules))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(Path(coupled.__file__).parents[1])},
        timeout=300,
    )
    assert done.returncode == 2
    assert done.stdout.strip() == ""
    assert "Traceback" not in done.stderr and "time.step = -1" in done.stderr


def test_petsc_options_reach_the_solvers_and_the_provenance(tmp_path):
    """In a process of its own: PETSc's options are one table for all."""
    run = [sys.executable, "-m", "coupled.cli", "run", "beam_vibration", "--set", "time.duration=2e-4", "--out"]
    options = "-leito_ksp_type cg -leito_pc_type gamg -leito_kps_rtol 1e-9"
    done = subprocess.run(
        [*run, str(tmp_path / "out"), "--no-progress", "--petsc", options], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    assert "note: no solver of this scene knows the PETSc option -leito_kps_rtol" in done.stderr
    recorded = json.loads((tmp_path / "out" / "provenance.json").read_text())["petsc_options"]
    assert recorded == {"leito_ksp_type": "cg", "leito_pc_type": "gamg", "leito_kps_rtol": "1e-9"}


@pytest.mark.parametrize("command", ["run", "check"])
def test_petsc_options_of_others_are_refused(command, leito, tmp_path):
    code, _, err = leito(command, "beam_vibration", "--petsc", "-ksp_type cg")
    assert code == 2
    assert "option -ksp_type does not begin with -leito_" in err


def test_petsc_option_without_meaning_is_one_line():
    """In a process of its own: PETSc does not recover from such an error."""
    run = [sys.executable, "-m", "coupled.cli", "check", "beam_vibration", "--petsc", "-leito_ksp_type none_such"]
    done = subprocess.run(run, capture_output=True, text=True, timeout=300)
    assert done.returncode == 2
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith("leito: PETSc cannot set up a solver for 810 unknowns") and "none_such" in line
