"""Linear solvers: every kind gives the same motion, on one rank and on two, and says when it cannot."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from petsc4py import PETSc

import meshes
from structure.solvers import solver
from structure import (
    BoundaryLoad,
    ElasticStructure,
    PlaneStrain,
    Rayleigh,
    StructureError,
    set_solver_options,
    solver_options,
    unused_solver_options,
)

ALUMINIUM = PlaneStrain(youngs_modulus=70e9, poissons_ratio=0.35, density=2700.0)


@pytest.fixture(autouse=True)
def no_options_left() -> Iterator[None]:
    yield
    for name in solver_options():
        PETSc.Options().delValue(name)


def thrown(steps: int = 40, time_step: float = 1e-5) -> tuple[np.ndarray, float]:
    """Boundary displacement of a beam hit on top, and the error of its ledger over the work done on it."""
    beam = meshes.beam(length=4.0, height=1.0, along=40, across=10)
    load = BoundaryLoad(boundary="top", total_force=(0.0, -1e6))
    damping = Rayleigh(stiffness_factor=1e-6)
    body = ElasticStructure(beam, material=ALUMINIUM, time_step=time_step, damping=damping, loads=[load])
    for step in range(steps):
        body.advance(np.full_like(beam.outer_polyline.points, 1e3 * np.sin(0.3 * step)))
    e = body.energies()
    error = e.kinetic + e.strain + e.rayleigh_loss - e.external_work - e.boundary_work
    return body.boundary_displacement, abs(error / e.external_work)


@pytest.mark.parametrize("time_step", [1e-6, 1e-4])  # the mass rules, the stiffness rules
@pytest.mark.parametrize("preconditioner", ["jacobi", "icc", "gamg"])
def test_iterative_solvers_move_the_body_as_the_direct_one(preconditioner: str, time_step: float) -> None:
    direct, _ = thrown(time_step=time_step)
    set_solver_options(f"-leito_ksp_type cg -leito_pc_type {preconditioner}")
    iterated, error = thrown(time_step=time_step)
    assert not unused_solver_options()
    # Residuals of 1e-12 over 40 steps.
    np.testing.assert_allclose(iterated, direct, rtol=0, atol=1e-10 * np.abs(direct).max())
    assert error < 1e-10


def test_a_preconditioner_alone_is_iterated_with() -> None:
    """-leito_pc_type gamg leaves PETSc's "preonly" in force, which would apply one cycle and believe it."""
    direct, _ = thrown()
    set_solver_options("-leito_pc_type gamg")
    np.testing.assert_allclose(thrown()[0], direct, rtol=0, atol=1e-10 * np.abs(direct).max())


def test_what_does_not_fit_is_iterated_and_modes_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    direct, _ = thrown()
    monkeypatch.setattr(solver, "available_memory", lambda: 1e5)
    iterated, error = thrown()
    np.testing.assert_allclose(iterated, direct, rtol=0, atol=1e-10 * np.abs(direct).max())
    assert 0.0 < error < 1e-10
    beam = meshes.beam(length=4.0, height=1.0, along=40, across=10)
    with pytest.raises(StructureError, match="902 unknowns need a factor of about .* take a coarser mesh"):
        ElasticStructure(beam, material=ALUMINIUM, time_step=1.0).frequencies(1)


def test_estimate_of_a_factor_is_near_what_petsc_takes() -> None:
    """The estimate may be off by a half; the factor of a beam of 20 000 unknowns is measured."""
    beam = meshes.beam(length=4.0, height=1.0, along=196, across=49)
    body = ElasticStructure(beam, material=ALUMINIUM, time_step=1e-5)
    matrix = body._body.mass_matrix
    factoring = PETSc.KSP().create(matrix.comm)
    factoring.setOperators(matrix)
    factoring.setType("preonly")
    factoring.getPC().setType("lu")
    factoring.setUp()
    entries = factoring.getPC().getFactorMatrix().getInfo()["nz_used"]
    assert solver.factor_memory(matrix) == pytest.approx(12.0 * entries, rel=0.5)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("-ksp_type cg", "option -ksp_type does not begin with -leito_"),
        ("cg", "'cg' where a name is expected"),
        ("-leito_ksp_type cg cg", "'cg' where a name is expected"),
        ("-leito_ksp_type 'cg", "close the quotes"),
    ],
)
def test_bad_options_are_refused(text: str, words: str) -> None:
    with pytest.raises(StructureError) as refusal:
        set_solver_options(text)
    assert words in str(refusal.value)


@pytest.mark.parametrize(
    ("text", "theory"),
    [
        ("-leito_ksp_type cgg", "linear"),
        ("-leito_pc_type luu", "corotational"),
        ("-leito_snes_type newtonls2", "large_strain"),
        ("-leito_snes_linesearch_type bb", "large_strain"),
    ],
)
def test_values_that_petsc_does_not_know_are_refused(text: str, theory: str) -> None:
    set_solver_options(text)
    beam = meshes.beam(length=4.0, height=1.0, along=8)
    with pytest.raises(StructureError, match="change the options -leito_") as refusal:
        ElasticStructure(beam, material=ALUMINIUM, time_step=1e-5, theory=theory)
    assert text.split()[1] in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_options_of_no_use_are_told() -> None:
    """A direct solver does not ask for a tolerance."""
    set_solver_options("-leito_ksp_rtol 1e-11 -leito_kps_type cg -leito_pc_factor_shift_type none -leito_nothing")
    thrown(steps=1)
    assert set(unused_solver_options()) == {"-leito_ksp_rtol", "-leito_kps_type", "-leito_nothing"}


def test_a_solver_that_does_not_converge_says_so() -> None:
    set_solver_options("-leito_ksp_type cg -leito_pc_type jacobi -leito_ksp_max_it 3")
    with pytest.raises(StructureError, match="cg solver with jacobi fails after 3 iterations"):
        thrown(time_step=1e-4)


RANKS = """
import sys
import meshes, numpy as np
from structure import *

set_solver_options("-leito_ksp_type cg -leito_pc_type " + sys.argv[2])
beam = meshes.beam(length=4.0, height=1.0, along=200, across=50)
line = beam.outer_polyline
material = PlaneStrain(youngs_modulus=70e9, poissons_ratio=0.35, density=2700.0)
body = ElasticStructure(beam, material=material, time_step=float(sys.argv[3]), damping=Rayleigh(stiffness_factor=1e-6),
    scheme=GeneralizedAlpha(spectral_radius=0.8), loads=[BoundaryLoad(boundary="top", total_force=(0.0, -1e6))])
force = np.zeros_like(line.points)
force[:50] = [1e3, 2e3]
for _ in range(15):
    body.advance(force)
assert not unused_solver_options()
out = {key: getattr(body, "boundary_" + key) for key in ("displacement", "velocity", "acceleration")}
out |= {key: np.array(value) for key, value in vars(body.energies()).items()}
np.savez(f"{sys.argv[1]}_{beam.domain.comm.rank}.npz", **out)
"""


@pytest.mark.parametrize(("preconditioner", "time_step"), [("gamg", "1e-4"), ("bjacobi", "2e-6")])
def test_two_ranks_agree_when_they_iterate(preconditioner: str, time_step: str, tmp_path: Path) -> None:
    """20 502 unknowns, stiff steps and such as the mass rules."""
    marks = ("OMPI_", "PMIX_", "PRTE_", "ORTE_")  # of an MPI process; a new mpirun must not take it for its own
    clean = {key: value for key, value in os.environ.items() if not key.startswith(marks)}
    tail = [preconditioner, time_step]
    run = [sys.executable, "-c", RANKS]
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"]
    subprocess.run([*run, str(tmp_path / "serial"), *tail], check=True, env=clean, timeout=300)
    subprocess.run([*mpirun, *run, str(tmp_path / "parallel"), *tail], check=True, env=clean, timeout=300)
    serial = np.load(tmp_path / "serial_0.npz")
    for rank in range(2):
        parallel = np.load(tmp_path / f"parallel_{rank}.npz")
        for name in serial.files:
            scale = np.abs(serial[name]).max()
            np.testing.assert_allclose(parallel[name], serial[name], rtol=0, atol=1e-9 * scale, err_msg=name)
