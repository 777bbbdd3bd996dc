"""A free rigid body: three unknowns, finite rotation, an energy balance exact to round-off."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from meshes import StructureMesh
from structure import checks
from structure.boundary import agreed_force, require_finite
from structure.discrete import DiscreteBody
from structure.errors import StructureError
from structure.loads.load import Load
from structure.loads.vectors import LoadVectors
from structure.loads.wrench import FollowingLoads, Wrench
from structure.results import StructureEnergies, StructureFields, StructurePeaks
from structure.rewinding import Rewinding
from structure.rigid.motion import NO_STRESS, RigidMotion, rigid_fields

SWEEPS = 100
MOST_TURNED = 1e6  # rad within a step: far beyond any rule's meaning, and the sine of more is round-off


class FreeRigid(Rewinding):
    """Rigid body under loads and boundary forces.

    Centroid by average acceleration. Rotation by a midpoint rule: with ``da`` the turn of the
    step and ``T_m`` the moment of the mean forces in the middle of it,
    ``I (w1 - w) = dt sin(da/2)/(da/2) T_m``, ``da = dt (w + w1)/2``. The chord in place of the
    arc makes the trapezoidal work of the nodal forces equal to the change of kinetic energy
    exactly. Order 2. A pressure that follows turns with the body: its moment about the centroid stays,
    ``I (w1 - w) = dt T``, its resultant turns; both do the work that the motion takes up. The interface
    is `Structure`.

    Parameters
    ----------
    mesh, density, time_step, loads
        Shape, density [kg/m^3], step [s], external loads. The points where loads act turn with
        the body; the directions of loads stay, unless they follow.
    """

    REPLACED = (
        "_steps", "_motion", "_force", "_boundary", "_external", "_wrench", "_external_work", "_boundary_work",
        "boundary_displacement", "boundary_velocity", "boundary_acceleration",
    )  # fmt: skip

    def __init__(
        self,
        mesh: StructureMesh,
        *,
        density: float,
        time_step: float,
        loads: Sequence[Load] = (),
    ) -> None:
        checks.positive("density", density, "kg/m^3")
        checks.positive("time_step", time_step, "s")
        self.mesh, self.comm, self.polyline = mesh, mesh.domain.comm, mesh.outer_polyline
        self.time_step = float(time_step)
        body = DiscreteBody(mesh, density)
        self.mass, self.inertia = body.mass, body.inertia
        self._reference_centroid = body.centroid
        self._arms = self.polyline.points - body.centroid
        self._loads = LoadVectors(body, loads)
        full = [body.nodes.gather(vector) for vector in self._loads.vectors]
        arms = mesh.points - body.centroid
        self._load_forces = np.array([_resultants(arms, force) for force in full]).reshape(-1, 4)
        self._following = FollowingLoads(self._loads.followers, arms)
        self.set_initial()

    @property
    def time(self) -> float:
        """Time [s] since the start."""
        return self._steps * self.time_step

    def set_initial(
        self,
        *,
        velocity: tuple[float, float] = (0.0, 0.0),
        spin: float = 0.0,
        angle: float = 0.0,
        boundary_force: NDArray[np.float64] | None = None,
    ) -> None:
        """Start anew at t = 0: velocity (2,) [m/s], spin [rad/s], angle [rad], forces [N/m]."""
        checks.plane_vector("velocity", velocity, "m/s")
        checks.plane_vector("(spin, angle)", (spin, angle), "rad/s and rad")
        self._steps = 0
        self._external_work = self._boundary_work = 0.0
        if boundary_force is None:
            boundary_force = np.zeros_like(self._arms)
        self._force = agreed_force(boundary_force, self._arms.shape, self.comm)
        require_finite(float(self._force.sum()), self._force, 0.0, self.time_step)
        self._motion = RigidMotion(
            shift=np.zeros(2),
            angle=angle,
            velocity=np.array(velocity, dtype=float),
            spin=spin,
            acceleration=np.zeros(2),
        )
        self._external, self._wrench = self._external_at(0.0), self._following.at(0.0)
        self._boundary = _resultants(self._arms, self._force)
        self._settle(self._motion)

    def begin_under(self, boundary_force: NDArray[np.float64]) -> None:
        """Start anew at t = 0 with the present velocity, under nodal forces (n_b, 2) [N/m]."""
        now = self._motion
        self.set_initial(velocity=tuple(now.velocity), spin=now.spin, angle=now.angle, boundary_force=boundary_force)

    def acceleration_by(self, boundary_force: NDArray[np.float64]) -> NDArray[np.float64]:
        """Boundary acceleration (n_b, 2) [m/s^2] that nodal forces alone cause on the body at rest."""
        force = agreed_force(boundary_force, self._arms.shape, self.comm)
        resultants = _resultants(self._arms, force)
        turning = RigidMotion(
            shift=np.zeros(2),
            angle=0.0,
            velocity=np.zeros(2),
            acceleration=resultants[:2] / self.mass,
            angular_acceleration=float(resultants[2]) / self.inertia,
        )
        return turning.acceleration_of(self._arms)

    def advance(self, boundary_force: NDArray[np.float64]) -> None:
        """One step with nodal forces (n_b, 2) [N/m] that act at its end; rank 0's count."""
        force = agreed_force(boundary_force, self._arms.shape, self.comm)
        self._steps += 1
        external, boundary = self._external_at(self.time), _resultants(self._arms, force)
        require_finite(float(boundary.sum()), force, self.time, self.time_step)
        wrench = self._following.at(self.time)
        external_mean = (self._external + external) / 2
        boundary_mean = (self._boundary + boundary) / 2
        moved, after, following_work = self._step(external_mean + boundary_mean, wrench)
        self._external_work += float(moved @ external_mean) + following_work
        self._boundary_work += float(moved @ boundary_mean)
        require_finite(self._external_work + self._boundary_work, force, self.time, self.time_step)
        self._force, self._external, self._boundary, self._wrench = force, external, boundary, wrench
        self._settle(after)

    def predict(self, interval: float, order: int = 2) -> NDArray[np.float64]:
        """Boundary displacement (n_b, 2) [m] after `interval` [s], with finite rotation."""
        now, half_square = self._motion, (0.5 * interval**2 if order == 2 else 0.0)
        ahead = RigidMotion(
            shift=now.shift + interval * now.velocity + half_square * now.acceleration,
            angle=now.angle + interval * now.spin + half_square * now.angular_acceleration,
            velocity=now.velocity,
            acceleration=now.acceleration,
        )
        return ahead.displacement_of(self._arms)

    def energies(self) -> StructureEnergies:
        """Energies [J/m] at the present time and sums since the start."""
        motion = self._motion
        turning = self.inertia * motion.spin**2 / 2
        return StructureEnergies(
            kinetic=self.mass * float(motion.velocity @ motion.velocity) / 2 + turning,
            strain=0.0,
            rayleigh_loss=0.0,
            external_work=self._external_work,
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
        """Rotation [rad] since the start, counter-clockwise positive, whole turns counted."""
        return self._motion.angle

    def momentum(self) -> NDArray[np.float64]:
        """Linear momentum (2,) [kg/s]."""
        return self.mass * self._motion.velocity

    def external_force(self) -> NDArray[np.float64]:
        """Resultant (2,) [N/m] of the external loads at the present time."""
        return self._external[:2] + self._wrench.force_on(self._motion.angle)

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
        motion = self._motion
        return {
            "motion": np.array([*motion.shift, motion.angle, *motion.velocity, motion.spin]),
            "boundary_force": self._force.copy(),
            "sums": np.array([self._external_work, self._boundary_work]),
            "steps": np.array(self._steps),
        }

    def restore(self, state: dict[str, NDArray[np.float64]]) -> None:
        """Take up a `state` of the same mesh, time step and loads; rank 0's counts."""
        state = self.comm.bcast(state, root=0)
        checks.state_of_this_kind(state, self.state())
        motion = np.array(state["motion"], dtype=float)
        self._force = np.array(state["boundary_force"])
        self._external_work, self._boundary_work = map(float, state["sums"])
        self._steps = int(state["steps"])
        self._external, self._wrench = self._external_at(self.time), self._following.at(self.time)
        self._boundary = _resultants(self._arms, self._force)
        self._settle(
            RigidMotion(
                shift=motion[:2],
                angle=float(motion[2]),
                velocity=motion[3:5],
                spin=float(motion[5]),
                acceleration=np.zeros(2),
            )
        )

    def _external_at(self, time: float) -> NDArray[np.float64]:
        return self._loads.factors(time) @ self._load_forces

    def _step(self, forces: NDArray[np.float64], wrench: Wrench) -> tuple[NDArray[np.float64], RigidMotion, float]:
        """What the work of mean `forces` (4,) is paired with, the motion after the step, the work of what follows."""
        dt, now = self.time_step, self._motion
        moment = (self._wrench.moment + wrench.moment) / 2
        turn = self._turn(forces, moment)
        push = (self._wrench.force_on(now.angle) + wrench.force_on(now.angle + turn)) / 2
        velocity = now.velocity + dt * (forces[:2] + push) / self.mass
        moved = dt * (now.velocity + velocity) / 2
        middle, chord = now.angle + turn / 2, 2 * math.sin(turn / 2)
        pairing = np.array([*moved, chord * math.cos(middle), chord * math.sin(middle)])
        after = RigidMotion(
            shift=now.shift + moved,
            angle=now.angle + turn,
            velocity=velocity,
            spin=2 * turn / dt - now.spin,
            acceleration=np.zeros(2),
        )
        return pairing, after, float(push @ moved) + moment * turn

    def _turn(self, forces: NDArray[np.float64], moment: float) -> float:
        """Turn [rad] of a step under mean `forces` (4,) and a `moment` [N] that follows: the rule's fixed point."""
        dt, now = self.time_step, self._motion
        free = turn = dt * now.spin
        for _ in range(SWEEPS):
            before = turn
            chord_ratio = math.sin(turn / 2) / (turn / 2) if turn else 1.0
            torque = chord_ratio * _torque(forces, now.angle + turn / 2) + moment
            turn = free + dt**2 / (2 * self.inertia) * torque
            if not abs(turn) < MOST_TURNED:
                break
            if abs(turn - before) <= 4 * sys.float_info.epsilon * abs(turn):
                return turn
        raise StructureError(
            f"time_step = {dt!r} s is too long for a moment of {torque:.3g} N that turns the body "
            f"by {turn:.3g} rad within a step: use a shorter step"
        )

    def _settle(self, motion: RigidMotion) -> None:
        """Take up a motion, with the accelerations of the present forces."""
        forces = self._external + self._boundary
        self._motion = replace(
            motion,
            acceleration=(forces[:2] + self._wrench.force_on(motion.angle)) / self.mass,
            angular_acceleration=(_torque(forces, motion.angle) + self._wrench.moment) / self.inertia,
        )
        self.boundary_displacement = self._motion.displacement_of(self._arms)
        self.boundary_velocity = self._motion.velocity_of(self._arms)
        self.boundary_acceleration = self._motion.acceleration_of(self._arms)


def _resultants(arms: NDArray[np.float64], forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """``(sum F_x, sum F_y, sum R x F, -sum R . F)`` of forces (n, 2) at reference arms R."""
    crosswise = arms[:, 0] @ forces[:, 1] - arms[:, 1] @ forces[:, 0]
    return np.array([*forces.sum(axis=0), crosswise, -np.vdot(arms, forces)])


def _torque(resultants: NDArray[np.float64], angle: float) -> float:
    """Moment [N] about the centroid of a body turned by `angle`."""
    return float(resultants[2] * math.cos(angle) + resultants[3] * math.sin(angle))
