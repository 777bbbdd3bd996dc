"""Bodies held by supports: stiffness from the room, supports and solution by scipy."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import ufl
from dolfinx import fem
from meshes import StructureMesh
from petsc4py import PETSc
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import spsolve
from structure import PlaneStrain
from structure.discrete import DiscreteBody
from structure.elements import element_of


def moved(mesh: StructureMesh, points: np.ndarray) -> StructureMesh:
    """The mesh with its nodes at other places (n, 2) [m]; its polyline stays behind."""
    geometry = mesh.domain.geometry
    geometry.x[:, :2] = points[np.asarray(geometry.input_global_indices)]
    return replace(mesh, points=points)


class HeldBody:
    """K, M (2 n, 2 n) in original order, unknowns x and y of each node in turn."""

    def __init__(self, mesh: StructureMesh, material: PlaneStrain, element: str) -> None:
        body = DiscreteBody(mesh, material.density)
        self._space = body.space
        place = np.argsort(body.nodes.owned)
        self._order = np.column_stack([2 * place, 2 * place + 1]).ravel()
        self.mesh = mesh
        self.stiffness = self._in_order(element_of(element, body, material).stiffness_matrix())
        self.mass = self._in_order(body.mass_matrix)

    def _in_order(self, matrix: PETSc.Mat) -> csr_matrix:
        rows, columns, values = matrix.getValuesCSR()
        return csr_matrix((values, columns, rows), shape=matrix.getSize())[self._order][:, self._order]

    def displacement(self, force: np.ndarray, held: np.ndarray, at: np.ndarray | None = None) -> np.ndarray:
        """Displacement (n, 2) under nodal forces (n, 2); the `held` unknowns are at rest or where `at` (n, 2) is."""
        u = np.zeros(force.size)
        if at is not None:
            u[held] = at.ravel()[held]
        free = np.setdiff1d(np.arange(force.size), held)
        right = force.ravel() - self.stiffness @ u
        u[free] = spsolve(self.stiffness[free][:, free].tocsc(), right[free])
        return u.reshape(-1, 2)

    def distance(self, displacement: np.ndarray, exact: Callable[..., tuple]) -> float:
        """L2 norm over the body of displacement (n, 2) less exact(x, y, sin, cos)."""
        function = fem.Function(self._space)
        function.x.array[self._order] = displacement.ravel()
        at = ufl.SpatialCoordinate(self.mesh.domain)
        off = function - ufl.as_vector(exact(at[0], at[1], ufl.sin, ufl.cos))
        square = ufl.inner(off, off) * ufl.dx(metadata={"quadrature_degree": 2 * self.mesh.order + 4})
        return float(np.sqrt(fem.assemble_scalar(fem.form(square))))

    def unheld_displacement(self, force: np.ndarray) -> np.ndarray:
        """Displacement (n, 2), up to a rigid motion, under nodal forces in balance: three unknowns are held."""
        arm = self.mesh.points - self.mesh.points.mean(axis=0)
        moment = (arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]).sum()
        assert np.abs(force.sum(axis=0)).max() < 1e-9 * np.abs(force).sum()
        assert abs(moment) < 1e-9 * np.abs(arm).max() * np.abs(force).sum()
        left, right = np.argmin(arm[:, 0]), np.argmax(arm[:, 0])
        return self.displacement(force, np.array([2 * left, 2 * left + 1, 2 * right + 1]))


def both(nodes: np.ndarray) -> np.ndarray:
    """The unknowns, x and y, of nodes."""
    return np.column_stack([2 * nodes, 2 * nodes + 1]).ravel()


def pressed(order: int, loop: np.ndarray) -> np.ndarray:
    """Nodal forces (n_b, 2) of a pressure 1 on a closed loop: ``-int N n ds``, exact for chords and for parabolas."""
    along = np.zeros_like(loop)
    if order == 1:
        ahead = np.roll(loop, -1, axis=0) - loop
        along += (ahead + np.roll(ahead, 1, axis=0)) / 2
    else:
        weights = np.array([[-3, 4, -1], [-4, 0, 4], [1, -4, 3]]) / 6  # int N_i dN_j
        facet = np.arange(0, len(loop), 2)[:, None] + np.arange(3)
        np.add.at(along, facet % len(loop), weights @ loop[facet % len(loop)])
    return np.column_stack([-along[:, 1], along[:, 0]])
