"""Statics of a body that nothing holds: solvable where the loads balance."""

from __future__ import annotations

import math

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
SMALL = 1e-13  # of the displacement: a sweep that moves no more is the last


def balanced_displacement(
    body: DiscreteBody, stiffness: PETSc.Mat, material: PlaneStrain, loads: LoadVectors
) -> NDArray[np.float64]:
    """Solution (n, 2) [m] of ``K u = f`` with every load at full strength, orthogonal to the rigid motions.

    K is singular, ``K + s M`` is not: conjugate gradients with its inverse, kept free of rigid motion. Modes far
    above ``omega^2 = s`` take one sweep together; a slender body has a few below, which take one or two each.

    Raises
    ------
    StructureError
        The loads have a resultant force or moment, or the sweeps do not converge.
    """
    force, resultant = loads.at_full_strength()
    rigid = rigid_motions(body)
    _check_balance(body, resultant, force, rigid)
    shift = 1e-2 * stiffness_scale(body, material)
    shifted = stiffness.copy()
    shifted.axpy(shift, body.mass_matrix, structure=PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
    solve = factorise_for_few(shifted)
    residual, solution = stiffness.createVecs()
    step, ahead, image = (solution.duplicate() for _ in range(3))
    residual.array[:] = force
    before = math.inf
    for _ in range(SWEEPS):
        solve(residual, step)
        step.array[:] -= rigid.T @ body.comm.allreduce(rigid @ body.weigh(step.array))
        gain = residual.dot(step)
        ahead.aypx(gain / before, step)
        stiffness.mult(ahead, image)
        length = gain / ahead.dot(image) if gain else 0.0
        solution.axpy(length, ahead)
        residual.axpy(-length, image)
        if abs(length) * ahead.norm() <= SMALL * solution.norm():
            return body.nodes.gather(solution.array)
        before = gain
    raise StructureError(
        f"the position of rest is not found in {SWEEPS} sweeps: the body is too slender for the digits of its "
        "stiffness (some 1 : 3000); make it thicker with a smaller E"
    )


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
