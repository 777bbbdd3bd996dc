"""Two discs that are led: velocities given at every step, whatever the forces, to see one contact at work."""

import math
from dataclasses import dataclass

import hypothesis.strategies as st
import numpy as np
from every_law import Pair, contact_of, decades, discs_of, system_of

from particles import Grains, ParticleSystem, Wall


@dataclass(frozen=True, kw_only=True)
class Drive:
    """Velocities that two discs are given at each of three steps, whatever the forces.

    `dt` in 1/omega_0; `speeds` (3, 6), velocities and r omega of both discs, in overlaps times omega_0.
    """

    dt: float
    speeds: np.ndarray
    gap: float
    turn: float

    def time_step(self, pair: Pair) -> float:
        return self.dt / pair.omega_0

    def velocities(self, pair: Pair) -> np.ndarray:
        """(3, 6) [m/s], at most 1 % of the smaller radius in a step."""
        fastest = 0.01 * pair.radii.min() / self.time_step(pair)
        return np.clip(self.speeds * pair.delta * pair.omega_0, -fastest, fastest)

    def along(self) -> np.ndarray:
        return np.array([math.cos(self.turn), math.sin(self.turn)])


def signed(low: float, high: float) -> st.SearchStrategy[float]:
    return st.tuples(st.sampled_from([-1.0, 0.0, 1.0]), decades(low, high)).map(lambda pair: pair[0] * pair[1])


any_drive = st.builds(
    Drive,
    dt=decades(-4.0, -0.5),
    speeds=st.lists(signed(-3.0, 2.0), min_size=18, max_size=18).map(lambda s: np.array(s).reshape(3, 6)),
    gap=st.floats(-2.0, 0.5),
    turn=st.floats(-math.pi, math.pi),
)


@dataclass(frozen=True, kw_only=True)
class Seen:
    """One contact after a step: overlap, normal and lever arms, forces (2, 2) and torques (2,) on the discs."""

    delta: float
    normal: np.ndarray
    apart: np.ndarray
    arms: np.ndarray
    force: np.ndarray
    torque: np.ndarray

    @property
    def f_n(self) -> float:
        return float(-self.force[0] @ self.normal)

    @property
    def f_t(self) -> float:
        return float(self.force[0] @ np.array([-self.normal[1], self.normal[0]]))

    @property
    def moment(self) -> float:
        """Rolling moment on the first disc [N]."""
        return float(self.torque[0] - self.arms[0] * self.f_t)


def seen(system: ParticleSystem, pair: Pair) -> Seen:
    g, order = system.grains, np.argsort(system.grains.number)[-2:]
    apart = np.array([np.diff(g.x[order])[0], np.diff(g.y[order])[0]])
    distance = math.hypot(*apart)
    delta = float(pair.radii.sum()) - distance
    return Seen(
        delta=delta, normal=apart / distance, apart=apart, arms=pair.radii - 0.5 * delta,
        force=np.column_stack([g.fx[order], g.fy[order]]), torque=g.torque[order].copy(),
    )  # fmt: skip


def driven(
    kind: str, pair: Pair, drive: Drive, *, turn: float = 0.0, shift: float = 0.0, wind: float = 0.0
) -> list[Seen]:
    """The contact after each of three steps; the whole experiment turned, shifted, and seen from a moving frame."""
    cos, sin = math.cos(turn), math.sin(turn)
    rotation = np.array([[cos, -sin], [sin, cos]])
    along, away = rotation @ drive.along(), np.array([0.6, -0.8])
    distance = float(pair.radii.sum()) + drive.gap * pair.delta
    place = np.array([[0.0, 0.0], distance * along]) + shift * away
    system = system_of(kind, discs_of(pair, place), contact_of(kind, pair), dt=drive.time_step(pair))
    system.start()
    found = []
    for motion in drive.velocities(pair):
        g, order = system.grains, np.argsort(system.grains.number)
        g.vx[order], g.vy[order] = rotation @ motion[:4].reshape(2, 2).T + wind * away[:, None]
        g.omega[order] = motion[4:] / pair.radii
        system.advance(1)
        found.append(seen(system, pair))
    return found


def driven_at_a_wall(kind: str, pair: Pair, drive: Drive) -> list[Seen]:
    """The first disc led at a moving wall: the contact after each of three steps, the wall as second body."""
    along, motions = drive.along(), drive.velocities(pair)
    grains = Grains.discs([[0.0, 0.0]], pair.radius, pair.density)
    point = (pair.radius + drive.gap * pair.delta) * along
    wall = Wall(point=tuple(point), normal=tuple(-along), velocity=tuple(motions[0, 2:4]), material=1)
    system = system_of(kind, grains, contact_of(kind, pair), dt=drive.time_step(pair), walls=[wall])
    system.start()
    found = []
    for motion in motions:
        g = system.grains
        g.vx[0], g.vy[0], g.omega[0] = motion[0], motion[1], motion[4] / pair.radius
        system.advance(1)
        place = np.array([system.list.walls.px[0] - g.x[0], system.list.walls.py[0] - g.y[0]])
        delta = pair.radius - float(place @ along)
        force = np.array([[g.fx[0], g.fy[0]], system.wall_force[0]])
        arms = np.array([pair.radius - 0.5 * delta, 0.0])
        found.append(Seen(delta=delta, normal=along, apart=along, arms=arms, force=force, torque=g.torque.copy()))
    return found


def turntable(kind: str, pair: Pair, dt: float) -> ParticleSystem:
    """The discs as two prescribed bodies at the pair's overlap, the first at the origin; a free disc stands far away."""
    far = Grains.discs([[1e3 * pair.distance, 0.0]], pair.radius, pair.density)
    grains = far.with_prescribed([[0.0, 0.0]], pair.radii[0], 0, material=0)
    grains = grains.with_prescribed([[pair.distance, 0.0]], pair.radii[1], 1, material=1)
    system = system_of(kind, grains, contact_of(kind, pair), dt=dt)
    system.start()
    return system


def turned(system: ParticleSystem, pair: Pair, *, path: float, roll: float) -> Seen:
    """Turn both discs in one step: the surfaces slip by `path` [m], the first turns by `roll` [rad] more than the second.

    Lengths are those of model 1.1: path = -(a_i theta_i + a_j theta_j).
    """
    arms = pair.radii - 0.5 * pair.delta
    second = -(path + arms[0] * roll) / arms.sum()
    system.grains.omega[1:] = np.array([second + roll, second]) / system.time_step
    system.advance(1)
    system.grains.omega[1:] = 0.0
    return seen(system, pair)
