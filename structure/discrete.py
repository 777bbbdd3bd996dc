"""A body made discrete: space, node map, mass, and the rigid-body measures that mass defines."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from meshes import StructureMesh
from structure import compat, forms
from structure.nodes import NodeMap
from structure.solvers.solver import know_rigid_motions


class DiscreteBody:
    """A mesh with its displacement space and consistent mass.

    Attributes
    ----------
    mesh, comm, space, nodes
        The mesh, its communicator, the vector space, the node map.
    unknowns : int
        Number of unknowns of this rank.
    mass_matrix : PETSc.Mat
        Consistent mass [kg/m].
    mass, centroid, inertia
        Mass [kg/m], reference centroid (2,) [m], polar moment of inertia about it [kg m].
    measures : (4, owned unknowns)
        M times the translations along x and y, times J R and times R: R is the reference position
        relative to the centroid [m], J a quarter turn counter-clockwise.
    """

    def __init__(self, mesh: StructureMesh, density: float) -> None:
        self.mesh, self.comm = mesh, mesh.domain.comm
        self.space = compat.vector_space(mesh.domain, mesh.order)
        self.nodes = NodeMap(mesh, self.space)
        self.mass_matrix = forms.mass_matrix(self.space, density, mesh.order)
        self.unknowns = self.mass_matrix.getLocalSize()[0]
        places = mesh.points[self.nodes.owned]
        know_rigid_motions(self.mass_matrix, places)
        along_x = self.weigh(np.tile([1.0, 0.0], len(places)))
        along_y = self.weigh(np.tile([0.0, 1.0], len(places)))
        self.mass = self.total(along_x[0::2].sum())
        self.centroid = (
            np.array([self.total(along_x @ places.ravel()), self.total(along_y @ places.ravel())]) / self.mass
        )
        arm = places - self.centroid
        radial = self.weigh(arm.ravel())
        turning = self.weigh(np.column_stack([-arm[:, 1], arm[:, 0]]).ravel())
        self.inertia = self.total(radial @ arm.ravel())
        self.measures = np.array([along_x, along_y, turning, radial])

    def total(self, share: float) -> float:
        """Sum over the ranks."""
        return float(share if self.comm.size == 1 else self.comm.allreduce(share))

    def totals(self, shares: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sums over the ranks, one by one; a single rank is not asked."""
        if self.comm.size == 1:
            return shares
        sums = np.empty_like(shares)
        self.comm.Allreduce(shares, sums)
        return sums

    def weigh(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """``M values`` for this rank's flat values."""
        right, left = self.mass_matrix.createVecs()
        right.array[:] = values
        self.mass_matrix.mult(right, left)
        return left.array.copy()

    def momentum(self, velocity: NDArray[np.float64]) -> NDArray[np.float64]:
        """Linear momentum (2,) [kg/s] of flat nodal velocities [m/s]."""
        return self.totals(self.measures[:2] @ velocity)

    def centroid_now(self, displacement: NDArray[np.float64]) -> NDArray[np.float64]:
        """Centroid (2,) [m] of the displaced body."""
        return self.centroid + self.totals(self.measures[:2] @ displacement) / self.mass

    def mean_rotation(self, displacement: NDArray[np.float64]) -> float:
        """Rotation [rad] of the rigid motion that fits best, weighted by mass.

        ``atan2(int rho R x r, int rho R . r)``, R and r the reference and present positions
        relative to the centroid: exact for a rigid motion of any size; within (-pi, pi].
        """
        cross, along = self.totals(self.measures[2:] @ displacement)
        return math.atan2(cross, self.inertia + along)
