"""Elastic modes of the free body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from slepc4py import SLEPc

from structure.discrete import DiscreteBody
from structure.errors import StructureError
from structure.material import PlaneStrain
from structure.solvers.solver import configure

RIGID_MODES = 3


def stiffness_scale(body: DiscreteBody, material: PlaneStrain) -> float:
    """Square of an angular frequency [1/s^2], about the lowest elastic one or below."""
    size = np.ptp(body.mesh.points, axis=0).max()
    return 1e-2 * material.youngs_modulus / material.density / size**2


def rigid_motions(body: DiscreteBody) -> NDArray[np.float64]:
    """Two translations and the small rotation, (3, owned unknowns), orthonormal in the mass."""
    arm = body.mesh.points[body.nodes.owned] - body.centroid
    return np.array(
        [
            np.tile([1.0, 0.0], len(arm)) / np.sqrt(body.mass),
            np.tile([0.0, 1.0], len(arm)) / np.sqrt(body.mass),
            np.column_stack([-arm[:, 1], arm[:, 0]]).ravel() / np.sqrt(body.inertia),
        ]
    )


def elastic_modes(
    body: DiscreteBody, stiffness: PETSc.Mat, material: PlaneStrain, count: int
) -> tuple[NDArray[np.float64], list[NDArray[np.float64]]]:
    """The lowest elastic modes of ``K x = omega^2 M x``, rigid motions left out.

    Returns
    -------
    frequencies : (count,)
        [Hz], ascending.
    shapes : list of (n, 2)
        In original node order, the largest nodal displacement 1, the largest component positive.
    """
    unknowns = stiffness.getSize()[0]
    if not 1 <= count <= unknowns - RIGID_MODES:
        raise StructureError(f"mode {count} does not exist: this mesh has elastic modes 1 to {unknowns - RIGID_MODES}")
    solver = _solver(body, stiffness, material, count)
    solver.solve()
    if solver.getConverged() < count:
        raise StructureError(f"only {solver.getConverged()} of {count} modes converged: ask for fewer")
    vector, rigid = stiffness.createVecRight(), rigid_motions(body)
    pairs = []
    for k in range(count):
        square = solver.getEigenpair(k, vector).real
        # the eigensolver leaves some where the numbers of the mass are far from 1
        rigid_share = body.totals(rigid @ body.weigh(vector.array))
        shape = body.nodes.gather(vector.array - rigid_share @ rigid)
        shape /= np.hypot(*shape.T).max()
        largest = np.argmax(np.abs(shape) > (1 - 1e-6) * np.abs(shape).max())
        pairs.append((np.sqrt(square) / (2 * np.pi), shape * np.sign(shape.flat[largest])))
    pairs.sort(key=lambda pair: pair[0])
    return np.array([pair[0] for pair in pairs]), [pair[1] for pair in pairs]


def _solver(body: DiscreteBody, stiffness: PETSc.Mat, material: PlaneStrain, count: int) -> SLEPc.EPS:
    """Shift and invert below zero, where ``K - shift M`` is positive definite."""
    solver = SLEPc.EPS().create(body.comm)
    solver.setOperators(stiffness, body.mass_matrix)
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    rigid = []
    for motion in rigid_motions(body):
        vector = stiffness.createVecRight()
        vector.array[:] = motion
        rigid.append(vector)
    solver.setDeflationSpace(rigid)
    solver.setDimensions(nev=count)
    shift = -stiffness_scale(body, material)
    solver.setTarget(shift)
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTolerances(tol=1e-12, max_it=1000)
    transform = solver.getST()
    transform.setType(SLEPc.ST.Type.SINVERT)
    configure(transform.getKSP(), stiffness)
    solver.setOptionsPrefix("leito_modes_")
    solver.setFromOptions()
    return solver
