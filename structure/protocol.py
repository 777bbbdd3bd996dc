"""What a structure answers, whatever it is made of: the one place that says it."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from meshes import BoundaryPolyline, StructureMesh
from structure.results import StructureEnergies, StructureFields, StructurePeaks
from structure.rewinding import Snapshot

Floats = NDArray[np.float64]


class Structure(Protocol):
    """A plane body with an outer boundary, stepped in time by forces on the nodes of that boundary.

    `PrescribedRigid`, `FreeRigid` and `ElasticStructure` with any of its theories answer these questions.

    Attributes
    ----------
    mesh, comm, polyline
        Mesh, communicator, reference outer boundary.
    mass : float
        [kg/m]; 0 for a prescribed body without density.
    time_step : float
        Length [s] of every step.
    boundary_displacement, boundary_velocity, boundary_acceleration : (n_b, 2)
        [m], [m/s], [m/s^2], in the order of ``polyline.points``, on every rank.
    """

    mesh: StructureMesh
    comm: MPI.Intracomm
    polyline: BoundaryPolyline
    mass: float
    time_step: float
    boundary_displacement: Floats
    boundary_velocity: Floats
    boundary_acceleration: Floats

    @property
    def time(self) -> float:
        """Time [s] since the start."""
        ...

    @property
    def boundary_work(self) -> float:
        """Work [J/m] of the nodal forces since the start; on every rank, at no cost."""
        ...

    def begin_under(self, boundary_force: Floats) -> None:
        """Start anew at t = 0 as it is, under nodal forces (n_b, 2) [N/m]."""
        ...

    def advance(self, boundary_force: Floats) -> None:
        """One step with nodal forces (n_b, 2) [N/m] that act at its end."""
        ...

    def predict(self, interval: float, order: int = 2) -> Floats:
        """Boundary displacement (n_b, 2) [m] after `interval` [s]."""
        ...

    def acceleration_by(self, boundary_force: Floats) -> Floats:
        """Boundary acceleration (n_b, 2) [m/s^2] that nodal forces (n_b, 2) [N/m] alone cause."""
        ...

    def energies(self) -> StructureEnergies:
        """Energies [J/m] at the present time and sums since the start."""
        ...

    def centroid(self) -> Floats:
        """Present centroid (2,) [m]."""
        ...

    def mean_rotation(self) -> float:
        """Rotation [rad] of the best-fitting rigid motion, counter-clockwise positive."""
        ...

    def momentum(self) -> Floats:
        """Linear momentum (2,) [kg/s]."""
        ...

    def external_force(self) -> Floats:
        """Resultant (2,) [N/m] of the external loads at the present time."""
        ...

    def peaks(self) -> StructurePeaks:
        """Largest stress and strain."""
        ...

    def overturned_cell(self) -> int | None:
        """Number of a cell that deformation has turned inside out, None without any. Collective."""
        ...

    def fields(self) -> StructureFields:
        """Nodal fields in original order, on every rank."""
        ...

    def state(self) -> dict[str, Floats]:
        """All that is needed to go on with the same bits."""
        ...

    def restore(self, state: dict[str, Floats]) -> None:
        """Take up a `state` of the same structure; rank 0's counts."""
        ...

    def snapshot(self) -> Snapshot:
        """This rank's share of the present state, kept in memory."""
        ...

    def rewind(self, snapshot: Snapshot) -> None:
        """Go back to a `snapshot` of this object: the steps that follow have the same bits."""
        ...
