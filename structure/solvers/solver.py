"""Linear systems with one matrix and many right-hand sides: how they are solved, by size and by stiffness.

The measurements behind the choice are in docs/decisions.md, "Linear solvers". PETSc options replace any part of it,
with the prefix ``leito_`` for steps and masses, ``leito_statics_`` for statics, ``leito_modes_`` for modes.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from structure.errors import StructureError
from structure.solvers.memory import available_memory

Solve = Callable[[PETSc.Vec, PETSc.Vec], None]

PREFIX, STATICS_PREFIX = "leito_", "leito_statics_"
LARGE = 10_000  # unknowns from which a few solves take MUMPS, which factorises faster, and a mass is not factorised
MANY_RANKS_ITERATE = 200_000  # unknowns from which several ranks iterate if the mass dominates
MASS_DOMINATES = 1.0  # largest ratio of the stiffness to the mass on the diagonal at which a handful of iterations do
INCOMPLETE_UP_TO = 500.0  # the same ratio, up to which incomplete Cholesky beats multigrid
RESIDUAL = 1e-12  # of iterative solves, over the right-hand side: what ranks differ by, and the ledger's noise
ANY = 1e300  # growth of a residual: a first guess may be far off where loads vanish at once
FACTOR_BYTES = 0.55  # of a factor, per entry of the matrix and binary logarithm of the unknowns, times 12
SMALLEST_PIVOT = sys.float_info.epsilon**2  # over the largest number on the diagonal; PETSc's own is absolute, 2e-14
SHARE_OF_MEMORY = 0.7  # that a factor may take of what is available


def factorise(matrix: PETSc.Mat, mass: PETSc.Mat | None = None) -> Solve:
    """Function ``solve(b, x)`` of a square, symmetric, positive definite, constant matrix; set up once.

    Direct while the factor fits into memory: PETSc's own LU, on several ranks gathered on one of them. Iterative
    otherwise, and on several ranks for large systems that are nearly a mass matrix: conjugate gradients with incomplete
    Cholesky or, where the stiffness rules, with multigrid that knows the rigid motions. x is then the first guess.

    Parameters
    ----------
    mass
        What the matrix would be with a step of length zero; tells how stiff it is, and multigrid the rigid motions
        (`know_rigid_motions`). May be the matrix itself. Without it the matrix counts as stiff.
    """
    if mass is not None and (rigid := mass.getNearNullSpace()):
        matrix.setNearNullSpace(rigid)
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    solver.setOptionsPrefix(PREFIX)
    solver.setTolerances(rtol=RESIDUAL, divtol=ANY)
    with _Defaults(_settings(matrix, mass)):
        _set_up(solver)
    return solver.solve if solver.getType() == "preonly" else _told(solver)


def factorise_for_few(matrix: PETSc.Mat) -> Solve:
    """Function ``solve(b, x)`` of a matrix that has some ten right-hand sides, direct; see `configure`."""
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    configure(solver, matrix)
    solver.setOptionsPrefix(STATICS_PREFIX)
    solver.setTolerances(rtol=RESIDUAL, divtol=ANY)
    _set_up(solver)
    return _told(solver)


def configure(solver: PETSc.KSP, matrix: PETSc.Mat) -> None:
    """LU for some ten solves with a matrix of this pattern: by MUMPS where it is large or on several ranks.

    Raises
    ------
    StructureError
        The factor does not fit into memory.
    """
    unknowns = matrix.getSize()[0]
    needed, free = factor_memory(matrix), available_memory()
    if needed > SHARE_OF_MEMORY * free:
        raise StructureError(
            f"{unknowns} unknowns need a factor of about {needed / 2**30:.3g} GiB and {free / 2**30:.3g} GiB of memory "
            "are available: take a coarser mesh"
        )
    solver.setType("preonly")
    preconditioner = solver.getPC()
    preconditioner.setType("lu")
    if solver.comm.size > 1 or unknowns > LARGE:
        preconditioner.setFactorSolverType("mumps")
    else:
        preconditioner.setFactorSolverType("petsc")
        preconditioner.setFactorPivot(SMALLEST_PIVOT * _largest_on_diagonal(matrix))


def factor_memory(matrix: PETSc.Mat) -> float:
    """Estimate [bytes] of a nested-dissection factor of a matrix on a plane mesh."""
    unknowns = matrix.getSize()[0]
    entries = matrix.getInfo(PETSc.Mat.InfoType.GLOBAL_SUM)["nz_used"]
    return 12.0 * FACTOR_BYTES * entries * math.log2(max(unknowns, 2))


def know_rigid_motions(matrix: PETSc.Mat, places: NDArray[np.float64]) -> None:
    """Tell a matrix what its smoothest vectors are: the rigid motions of this rank's nodes at `places` (n, 2) [m]."""
    vector = matrix.createVecRight()
    vector.array[:] = places.ravel()
    vector.setBlockSize(2)
    matrix.setNearNullSpace(PETSc.NullSpace().createRigidBody(vector))


def _settings(matrix: PETSc.Mat, mass: PETSc.Mat | None) -> dict[str, str]:
    ranks, unknowns = matrix.comm.size, matrix.getSize()[0]
    stiffness = math.inf if mass is None else stiffness_over_mass(matrix, mass)
    fits = factor_memory(matrix) < SHARE_OF_MEMORY * available_memory()
    pivot = repr(SMALLEST_PIVOT * _largest_on_diagonal(matrix))
    if fits and not (stiffness < MASS_DOMINATES and unknowns > _iterated_above(ranks, mass is matrix)):
        direct = {"pc_type": "lu", "pc_factor_mat_solver_type": "petsc", "pc_factor_zeropivot": pivot}
        if ranks == 1:
            return {"ksp_type": "preonly"} | direct
        gathered = {f"telescope_{name}": value for name, value in ({"ksp_type": "preonly"} | direct).items()}
        return {"ksp_type": "preonly", "pc_type": "telescope", "pc_telescope_reduction_factor": str(ranks)} | gathered
    krylov = {"ksp_type": "cg", "ksp_norm_type": "unpreconditioned", "ksp_initial_guess_nonzero": "1"}
    if stiffness < INCOMPLETE_UP_TO:
        return krylov | {
            "pc_type": "bjacobi",
            "sub_ksp_type": "preonly",
            "sub_pc_type": "icc",
            "sub_pc_factor_zeropivot": pivot,
        }
    return krylov | {"pc_type": "gamg", "mg_levels_ksp_type": "chebyshev", "mg_levels_pc_type": "jacobi"}


def _iterated_above(ranks: int, pure_mass: bool) -> float:
    """Unknowns above which a matrix near the mass is not factorised; the mass itself has few right-hand sides."""
    if pure_mass:
        return LARGE
    return MANY_RANKS_ITERATE if ranks > 1 else math.inf


def stiffness_over_mass(matrix: PETSc.Mat, mass: PETSc.Mat) -> float:
    """Largest ratio of the diagonals, less 1; the same for any number of ranks."""
    ratio, below = matrix.getDiagonal(), mass.getDiagonal()
    ratio.pointwiseDivide(ratio, below)
    return ratio.max()[1] - 1.0


def _largest_on_diagonal(matrix: PETSc.Mat) -> float:
    return matrix.getDiagonal().max()[1]


def _set_up(solver: PETSc.KSP) -> None:
    """Take up the options and do all work that does not depend on the right-hand side."""
    with set_up_told(solver.getOperators()[0].getSize()[0], solver.getOptionsPrefix()):
        solver.setFromOptions()
        _iterate_if_inexact(solver)
        solver.setErrorIfNotConverged(True)
        solver.setUp()
        solver.getPC().setUp()


@contextmanager
def set_up_told(unknowns: int, prefix: str) -> Iterator[None]:
    """Say in a sentence that PETSc cannot set up a solver, for which a user's options are the usual cause."""
    try:
        yield
    except PETSc.Error as error:
        raise StructureError(
            f"PETSc cannot set up a solver for {unknowns} unknowns ({_last_line(error)}): "
            f"change the options -{prefix}..., or the mesh"
        ) from None


def _told(solver: PETSc.KSP) -> Solve:
    """The solve of an iterative solver; that it does not converge is said in a sentence."""

    def solve(right: PETSc.Vec, solution: PETSc.Vec) -> None:
        try:
            solver.solve(right, solution)
        except PETSc.Error as error:
            raise StructureError(
                f"the {solver.getType()} solver with {solver.getPC().getType()} fails after "
                f"{solver.getIterationNumber()} iterations ({_last_line(error)}): "
                f"change the options -{solver.getOptionsPrefix()}..."
            ) from None

    return solve


def _last_line(error: PETSc.Error) -> str:
    return str(error).strip().splitlines()[-1]


def _iterate_if_inexact(solver: PETSc.KSP) -> None:
    """Wrap conjugate gradients around a preconditioner of the user's that solves only about."""
    exact = ("lu", "cholesky", "telescope", "redundant")
    if solver.getType() == "preonly" and solver.getPC().getType() not in exact:
        solver.setType("cg")
        solver.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
        solver.setInitialGuessNonzero(True)


class _Defaults:
    """Our settings as PETSc options where the user has none, for as long as a solver is set up."""

    def __init__(self, settings: dict[str, str]) -> None:
        self._settings = settings

    def __enter__(self) -> None:
        options = PETSc.Options(PREFIX)
        self._ours = [name for name in self._settings if not options.hasName(name)]
        for name in self._ours:
            options[name] = self._settings[name]

    def __exit__(self, *error: object) -> None:
        options = PETSc.Options(PREFIX)
        for name in self._ours:
            options.delValue(name)
