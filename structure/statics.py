"""Statics of a body that nothing holds: solvable where the loads balance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from structure.discrete import DiscreteBody
from structure.errors import StructureError
from structure.loads.vectors import LoadVectors
from structure.material import PlaneStrain
from structure.modes import rigid_motions, stiffness_scale
from structure.solvers.solver import factorise_for_few

LARGEST_IMBALANCE = 1e-9
SWEEPS = 100


def balanced_displacement(
    body: DiscreteBody, stiffness: PETSc.Mat, material: PlaneStrain, loads: LoadVectors
) -> NDArray[np.float64]:
    """Solution (n, 2) [m] of ``K u = f`` with every load at full strength, orthogonal to the rigid motions.

    K is singular: ``(K + s M) du = f - K u`` is repeated until nothing is left; each sweep
    multiplies the error in a mode omega by ``s/(omega^2 + s)``.

    Raises
    ------
    StructureError
        The loads have a resultant force or moment.
    """
    force, resultant = loads.at_full_strength()
    rigid = rigid_motions(body)
    _check_balance(body, resultant, force, rigid)
    shift = 1e-2 * stiffness_scale(body, material)
    shifted = stiffness.copy()
    shifted.axpy(shift, body.mass_matrix, structure=PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
    solve = factorise_for_few(shifted)
    right, solution = stiffness.createVecs()
    residual, step = stiffness.createVecs()
    right.array[:] = force
    for _ in range(SWEEPS):
        stiffness.mult(solution, residual)
        residual.aypx(-1.0, right)
        solve(residual, step)
        free = step.array - rigid.T @ body.comm.allreduce(rigid @ body.weigh(step.array))
        solution.array[:] += free
        if body.total(float(free @ free)) <= 1e-26 * solution.dot(solution):
            break
    return body.nodes.gather(solution.array)


def _check_balance(
    body: DiscreteBody,
    resultant: NDArray[np.float64],
    force: NDArray[np.float64],
    rigid: NDArray[np.float64],
) -> None:
    work = np.abs(body.comm.allreduce(rigid @ force))
    scale = np.sqrt(body.total(float(force @ force)) / body.mass)
    if work.max() > LARGEST_IMBALANCE * scale:
        raise StructureError(
            f"loads with the resultant {resultant.tolist()} N/m do not "
            "balance in force and moment: a free body has no position of rest under them"
        )
