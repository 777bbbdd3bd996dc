"""A rigid body driven along way points (G 4.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes import StructureMesh
from structure import checks
from structure.boundary import agreed_force, require_finite
from structure.discrete import DiscreteBody
from structure.errors import StructureError
from structure.results import StructureEnergies, StructureFields, StructurePeaks
from structure.rewinding import Rewinding
from structure.rigid.motion import NO_STRESS, RigidMotion, rigid_fields


class PrescribedRigid(Rewinding):
    """Rigid body whose displacement is piecewise linear in time; it never turns.

    At a way point the velocity is that of the piece ahead; after the last one the body rests.
    The interface is `Structure`.

    Parameters
    ----------
    mesh
        The shape.
    path : (k, 3)
        Rows (time [s], x, y displacement [m]); the first is (0, 0, 0), times increase.
    time_step : float
        Length [s] of every step.
    density : float, optional
        [kg/m^3]. Without it the mass is 0 and no kinetic energy is counted.
    """

    REPLACED = (
        "_steps", "_motion", "_force", "_drive_work", "_boundary_work",
        "boundary_displacement", "boundary_velocity", "boundary_acceleration",
    )  # fmt: skip

    def __init__(
        self,
        mesh: StructureMesh,
        *,
        path: ArrayLike,
        time_step: float,
        density: float | None = None,
    ) -> None:
        checks.positive("time_step", time_step, "s")
        if density is not None:
            checks.positive("density", density, "kg/m^3")
        self.mesh, self.comm, self.polyline = mesh, mesh.domain.comm, mesh.outer_polyline
        self.time_step = float(time_step)
        self._times, self._places = _checked_path(path)
        self._velocities = np.zeros_like(self._places)
        self._velocities[:-1] = np.diff(self._places, axis=0) / np.diff(self._times)[:, None]
        body = DiscreteBody(mesh, 1.0 if density is None else density)
        self.mass = 0.0 if density is None else body.mass
        self._reference_centroid = body.centroid
        self._steps = 0
        self._drive_work = self._boundary_work = 0.0
        self._force = np.zeros_like(self.polyline.points)
        self._place()

    @property
    def time(self) -> float:
        """Time [s] since the start."""
        return self._steps * self.time_step

    def begin_under(self, boundary_force: NDArray[np.float64]) -> None:
        """Account for nodal forces (n_b, 2) [N/m] from t = 0 on."""
        self._force = agreed_force(boundary_force, self._force.shape, self.comm)
        require_finite(float(self._force.sum()), self._force, 0.0, self.time_step)

    def acceleration_by(self, boundary_force: NDArray[np.float64]) -> NDArray[np.float64]:
        """Zero (n_b, 2): no force moves a prescribed body."""
        return np.zeros_like(self._force)

    def advance(self, boundary_force: NDArray[np.float64]) -> None:
        """One step along the path; the nodal forces (n_b, 2) [N/m] are only accounted for."""
        force = agreed_force(boundary_force, self._force.shape, self.comm)
        shift, kinetic = self._motion.shift, self._kinetic()
        self._steps += 1
        self._place()
        moved = self._motion.shift - shift
        work = 0.5 * float(moved @ (self._force + force).sum(axis=0))
        self._boundary_work += work
        self._drive_work += self._kinetic() - kinetic - work
        self._force = force
        require_finite(self._drive_work, force, self.time, self.time_step)

    def predict(self, interval: float, order: int = 2) -> NDArray[np.float64]:
        """Boundary displacement (n_b, 2) [m] after `interval` [s]: the path itself."""
        return np.tile(self._shift_at(self.time + interval), (len(self.polyline.points), 1))

    def energies(self) -> StructureEnergies:
        """Energies [J/m]; the external work is that of the drive, found from the balance."""
        return StructureEnergies(
            kinetic=self._kinetic(),
            strain=0.0,
            rayleigh_loss=0.0,
            external_work=self._drive_work,
            boundary_work=self._boundary_work,
        )

    @property
    def boundary_work(self) -> float:
        """Work [J/m] of the nodal forces since the start, as in `energies`."""
        return self._boundary_work

    def centroid(self) -> NDArray[np.float64]:
        """Present centroid (2,) [m]."""
        return self._reference_centroid + self._motion.shift

    def mean_rotation(self) -> float:
        """Rotation [rad]: none."""
        return 0.0

    def momentum(self) -> NDArray[np.float64]:
        """Linear momentum (2,) [kg/s]."""
        return self.mass * self._motion.velocity

    def external_force(self) -> NDArray[np.float64]:
        """Force (2,) [N/m] of the drive that balances the present boundary forces."""
        return -self._force.sum(axis=0)

    def peaks(self) -> StructurePeaks:
        """Zero: a rigid body knows no stress."""
        return NO_STRESS

    def overturned_cell(self) -> None:
        """None: a rigid body does not deform."""

    def fields(self) -> StructureFields:
        """Displacement and velocity; stress and strain are zero."""
        return rigid_fields(self.mesh, self._reference_centroid, self._motion)

    def state(self) -> dict[str, NDArray[np.float64]]:
        """All that is needed to go on with the same bits."""
        return {
            "boundary_force": self._force.copy(),
            "sums": np.array([self._drive_work, self._boundary_work]),
            "steps": np.array(self._steps),
        }

    def restore(self, state: dict[str, NDArray[np.float64]]) -> None:
        """Take up a `state` of the same path and time step; rank 0's counts."""
        state = self.comm.bcast(state, root=0)
        checks.state_of_this_kind(state, self.state())
        self._force = np.array(state["boundary_force"])
        self._drive_work, self._boundary_work = map(float, state["sums"])
        self._steps = int(state["steps"])
        self._place()

    def _kinetic(self) -> float:
        return self.mass * float(self._motion.velocity @ self._motion.velocity) / 2

    def _shift_at(self, time: float) -> NDArray[np.float64]:
        return np.array([np.interp(time, self._times, column) for column in self._places.T])

    def _place(self) -> None:
        """Refresh motion and boundary arrays from the time."""
        time = self.time
        # A step may miss a way point by round-off: then it counts as reached.
        piece = np.searchsorted(self._times, time + 1e-6 * self.time_step, side="right") - 1
        self._motion = RigidMotion(
            shift=self._shift_at(time), velocity=self._velocities[piece], acceleration=np.zeros(2)
        )
        count = len(self.polyline.points)
        self.boundary_displacement = np.tile(self._motion.shift, (count, 1))
        self.boundary_velocity = np.tile(self._motion.velocity, (count, 1))
        self.boundary_acceleration = np.zeros((count, 2))


def _checked_path(path: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    rows = np.asarray(path, dtype=float)
    if rows.ndim != 2 or rows.shape[1] != 3 or not np.all(np.isfinite(rows)):
        raise StructureError(f"path of shape {rows.shape} must have finite rows (time in s, x and y displacement in m)")
    if np.any(rows[0] != 0.0):
        raise StructureError(f"path begins with {rows[0].tolist()}: its first row must be [0, 0, 0]")
    if np.any(np.diff(rows[:, 0]) <= 0):
        raise StructureError(f"path has the times {rows[:, 0].tolist()}: each must be later than the one before")
    return rows[:, 0].copy(), rows[:, 1:].copy()
