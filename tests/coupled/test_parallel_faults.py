"""What one rank meets alone stops all ranks, with one sentence."""

from pathlib import Path

import pytest
from mpi_runs import on_ranks

from coupled.output import checkpoint
from coupled.templates import write_template

FAILING = """
import os
import sys
from functools import partial
from mpi4py import MPI
from coupled import cli
from coupled.running import run
from coupled.running.record import Record
from particles import ParticleError, ParticleSystem

comm, case = MPI.COMM_WORLD, sys.argv[1]


def without_grains(advance, system, count, taken=[0]):  # on rank 0 alone, in the middle of a coupled step
    coupled = len(system.grains) > system.grains.n_free
    taken[0] += count if coupled else 0
    if taken[0] == 377:
        taken[0] -= 100  # once more when the run has gone back
        raise ParticleError("grain 7 has left the finite numbers")
    advance(system, count)


def without_disk(count, record, seen):  # on rank 1 alone, where nobody expects it
    if comm.rank == 1:
        raise OSError("rank 1 has lost its disk")
    count(record, seen)


if case == "grains":
    advance = ParticleSystem.advance
    ParticleSystem.advance = lambda self, count: without_grains(advance, self, count)
if case == "disk":
    os.dup2(os.open(sys.argv[2], os.O_WRONLY | os.O_CREAT | os.O_APPEND), 2)  # mpirun may drop last words
    count = Record.count
    Record.count = lambda self, seen: without_disk(count, self, seen)
    run.LeaveTogether = partial(run.LeaveTogether, patience=1.0)
sys.argv = ["leito", "run", "tube.toml", "--out", "runs/" + case, "--threads", "1", "--no-progress"]
for text in ("time.duration=0.05", "bed.time.duration=0.2", "output.figures=false", "bed.output.figures=false"):
    sys.argv += ["--set", text]
cli.main()
"""
SHAPE = """
import numpy as np
from mpi4py import MPI
from meshes import tube
from structure import ElasticStructure, PlaneStrain, StructureError

rank = MPI.COMM_WORLD.rank
material = PlaneStrain(youngs_modulus=1e9, poissons_ratio=0.3, density=1000.0)
body = ElasticStructure(tube(outer_radius=0.05, inner_radius=0.04), time_step=1e-5, material=material)
heard = []
for shape in ((3, 2), body.polyline.points.shape):
    try:
        body.advance(np.zeros(shape) if rank == 0 else None)
        heard.append(f"rank {rank} takes {shape[0]} forces")
    except StructureError as error:
        heard.append(f"rank {rank} says {error}")
heard = MPI.COMM_WORLD.gather(heard)
if rank == 0:
    print(*heard[0], *heard[1], sep="\\n")
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("ranks")
    write_template("tube", folder / "tube.toml")
    return folder


def sentences(said: str) -> list[str]:
    return [line for line in said.splitlines() if line.startswith("leito: ") and "note:" not in line]


def test_a_failure_of_the_grains_stops_both_ranks(place: Path) -> None:
    """The grains live on rank 0; the other rank waits for their forces in the middle of a step."""
    done = on_ranks(2, "-c", FAILING, "grains", cwd=place)
    assert done.returncode == 2, done.stderr
    (said,) = sentences(done.stderr)
    assert "the run is unstable: grain 7 has left the finite numbers" in said and "before_failure.h5" in said
    assert "Traceback" not in done.stderr
    before, _ = checkpoint.load(place / "runs" / "grains" / "before_failure.h5")
    assert before["model.steps_done"] == 0 and "particles.grains.x" in before, "whole, and before the first look"


def test_a_step_above_all_limits_stops_both_ranks(place: Path) -> None:
    """As a user meets it: the same sentence as on one rank."""
    sets = ["time.step=3e-4", "interface.largest_stiffness_ratio=1000", "bed.time.duration=0.2"]
    sets += ["output.figures=false", "bed.output.figures=false"]
    words = [word for text in sets for word in ("--set", text)]
    said = []
    for ranks in (1, 2):
        out = f"runs/unstable{ranks}"
        command = ["-m", "coupled.cli", "run", "tube.toml", "--out", out, "--threads", "1", "--no-progress", *words]
        done = on_ranks(ranks, *command, cwd=place)
        assert done.returncode == 2, done.stderr
        (sentence,) = sentences(done.stderr)
        said.append(sentence.replace(out, "there"))
    assert said[0] == said[1]


def test_an_error_that_one_rank_meets_alone_ends_the_others(place: Path) -> None:
    """Else they would wait for ever, and `on_ranks` has a limit."""
    done = on_ranks(2, "-c", FAILING, "disk", "said.txt", cwd=place)
    assert done.returncode != 0
    assert sentences((place / "said.txt").read_text()) == ["leito: rank 1: rank 1 has lost its disk"]


def test_a_force_of_the_wrong_shape_is_refused_on_both_ranks() -> None:
    done = on_ranks(2, "-c", SHAPE)
    assert done.returncode == 0, done.stderr
    wrong = "says boundary_force has shape (3, 2): one force per boundary node, (30, 2), is needed"
    expected = [f"rank {rank} {what}" for rank in (0, 1) for what in (wrong, "takes 30 forces")]
    assert done.stdout.splitlines() == expected
