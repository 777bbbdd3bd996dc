"""One factorisation, many solves: the size chooses the solver, PETSc options override."""

from __future__ import annotations

from collections.abc import Callable

from petsc4py import PETSc

LARGE = 10_000


def configure(solver: PETSc.KSP, unknowns: int) -> None:
    """Direct solver: PETSc's own LU for a small serial system, MUMPS otherwise.

    For a few hundred unknowns PETSc's LU solves some twenty times faster than MUMPS.
    """
    solver.setType("preonly")
    preconditioner = solver.getPC()
    preconditioner.setType("lu")
    parallel = solver.comm.size > 1
    preconditioner.setFactorSolverType("mumps" if parallel or unknowns > LARGE else "petsc")


def factorise(matrix: PETSc.Mat) -> Callable[[PETSc.Vec, PETSc.Vec], None]:
    """Function ``solve(b, x)`` of a square, constant matrix.

    Options with the prefix ``leito_`` (say ``-leito_ksp_type cg -leito_pc_type gamg``) replace
    the direct solver.
    """
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    configure(solver, matrix.getSize()[0])
    solver.setOptionsPrefix("leito_")
    solver.setFromOptions()
    solver.setErrorIfNotConverged(True)
    solver.setUp()
    return solver.solve
