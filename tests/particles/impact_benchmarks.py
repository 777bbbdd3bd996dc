"""The eight benchmark impacts of Chung and Ooi (2011, Granular Matter 13:643) for discs: bodies, laws, runs.

Materials, radii, speeds, friction and restitution are theirs as they are quoted in the literature. A
disc has the mass of their sphere (a layer 4/3 r thick) and the moment of inertia ``m r^2/2`` of a
disc, so that Hertz's spring, which is that of spheres, keeps its numbers. The linear springs are
ours: as deep at the benchmark's speed as Hertz's, with Mindlin's ratio of tangential to normal.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from impacts import Body, Impact, Springs, damping_ratio
from numpy.typing import ArrayLike, NDArray

from particles import (
    ContactModel,
    CoulombFriction,
    Grains,
    HertzSpringDashpot,
    LinearSpringDashpot,
    Material,
    MindlinFriction,
    ParticleSystem,
    Wall,
)

Floats = NDArray[np.float64]
Kind = Literal["linear", "hertz"]
KINDS: tuple[Kind, Kind] = ("linear", "hertz")
RIGID = Material(youngs_modulus=1e40, poissons_ratio=0.0)  # E* and G* of the other body alone, to round-off


@dataclass(frozen=True, kw_only=True)
class Stuff:
    """Elastic constants [Pa, -] and density [kg/m3]."""

    name: str
    modulus: float
    poisson: float
    density: float

    @property
    def material(self) -> Material:
        return Material(youngs_modulus=self.modulus, poissons_ratio=self.poisson)

    def ball(self, radius: float) -> Body:
        return Body(radius=radius, mass=4.0 / 3.0 * math.pi * radius**3 * self.density)


GLASS = Stuff(name="glass", modulus=4.8e10, poisson=0.20, density=2800.0)
LIMESTONE = Stuff(name="limestone", modulus=2.0e10, poisson=0.25, density=2500.0)
MAGNESIUM = Stuff(name="magnesium alloy", modulus=4.0e10, poisson=0.35, density=1800.0)
OXIDE = Stuff(name="aluminium oxide", modulus=3.8e11, poisson=0.23, density=4000.0)
IRON = Stuff(name="cast iron", modulus=1.0e11, poisson=0.25, density=7000.0)
ALUMINIUM = Stuff(name="aluminium alloy", modulus=7.0e10, poisson=0.33, density=2700.0)
STEEL = Stuff(name="steel", modulus=2.08e11, poisson=0.30, density=7850.0)
POLYETHYLENE = Stuff(name="polyethylene", modulus=1.0e9, poisson=0.40, density=1400.0)
NYLON = Stuff(name="nylon", modulus=2.5e9, poisson=0.40, density=1000.0)
COPPER = Stuff(name="copper", modulus=1.2e11, poisson=0.35, density=8900.0)


@dataclass(frozen=True, kw_only=True)
class Benchmark:
    """Two balls of `stuff` and `other`, or a ball and a rigid plane (`other_radius` None), at normal speed [m/s]."""

    stuff: Stuff
    radius: float
    speed: float
    other: Stuff | None = None
    other_radius: float | None = None
    mu: float = 0.0
    restitution: float = 1.0
    may_pull: bool = False

    @property
    def bodies(self) -> tuple[Body, Body | None]:
        second = None
        if self.other_radius is not None:
            second = (self.other or self.stuff).ball(self.other_radius)
        return self.stuff.ball(self.radius), second

    def springs(self, kind: Kind) -> Springs:
        """Hertz's and Mindlin's springs from the textbook, or the linear ones that are as deep."""
        first, second = self.stuff, self.other or self.stuff
        pair = [first] if self.other_radius is None else [first, second]
        e_star = 1.0 / sum((1.0 - s.poisson**2) / s.modulus for s in pair)
        g_star = 1.0 / sum(2.0 * (2.0 - s.poisson) * (1.0 + s.poisson) / s.modulus for s in pair)
        curvature = 1.0 / self.radius + (1.0 / self.other_radius if self.other_radius else 0.0)
        hertz = Springs(
            k=4.0 / 3.0 * e_star / math.sqrt(curvature),
            power=1.5,
            ratio=4.0 * g_star / e_star,
            mu=self.mu,
            zeta=damping_ratio(self.restitution, may_pull=self.may_pull),
            may_pull=self.may_pull,
        )
        if kind == "hertz":
            return hertz
        mass = Impact(first=self.bodies[0], second=self.bodies[1], springs=hertz, v_n=-1.0).mass
        return replace(hertz, k=mass * (self.speed / hertz.deepest(mass, self.speed)) ** 2, power=1.0)

    def contact(self, kind: Kind) -> ContactModel:
        """The same as a user asks for it."""
        wish = {"restitution": self.restitution, "may_pull": self.may_pull}
        if kind == "linear":
            law = self.springs("linear")
            return ContactModel(
                normal=LinearSpringDashpot(stiffness=law.k, **wish),
                tangential=CoulombFriction(stiffness=law.ratio * law.k, friction=self.mu),
            )
        pair = (
            self.stuff.material,
            RIGID if self.other_radius is None else (self.other or self.stuff).material,
        )
        return ContactModel(
            normal=HertzSpringDashpot.of_materials(*pair, **wish),
            tangential=MindlinFriction.of_materials(*pair, friction=self.mu),
        )

    def impacts(
        self, kind: Kind, u_t: ArrayLike = 0.0, spin: ArrayLike = 0.0, partner: ArrayLike = 0.0
    ) -> list[Impact]:
        """One impact per tangential velocity [m/s] of the first body against the second (to the right along the plane),
        spin [rad/s] of the first and spin of its partner."""
        first, second = self.bodies
        law = self.springs(kind)
        return [
            Impact(
                first=first, second=second, springs=law, v_n=-self.speed, u_t=-float(u), spins=(float(w), float(w_2))
            )
            for u, w, w_2 in np.broadcast(u_t, spin, partner)
        ]


def grains_before(impacts: Sequence[Impact], dt: float) -> Grains:
    """The bodies of `impacts` side by side, each to touch within the second step, all at different parts of it.

    Before a plane, the floor, they stand in a row; pairs lie along x, above one another, and their
    centre of mass rests.
    """
    gap = dt * (1.0 + np.arange(1, len(impacts) + 1) * 0.6180339887 % 1.0) * np.array([-i.v_n for i in impacts])
    first, second = impacts[0].first, impacts[0].second
    u = np.array([(i.v_n, i.u_t) for i in impacts])
    spins = np.array([i.spins for i in impacts])
    apart = 4.0 * np.arange(len(impacts))
    areal = [b.mass / (math.pi * b.radius**2) for b in (first, second) if b is not None]
    if second is None:  # n down, t to the right: the plane's velocity against the disc is (u_t, -v_n)
        place = np.column_stack([apart * first.radius, first.radius + gap])
        return Grains.discs(
            place, first.radius, areal[0], velocity=np.column_stack([-u[:, 1], u[:, 0]]), spin=spins[:, 0]
        )
    share, row = first.mass / (first.mass + second.mass), apart * max(first.radius, second.radius)
    place = np.vstack([np.column_stack([-first.radius - gap, row]), np.column_stack([0.0 * gap + second.radius, row])])
    return Grains.discs(
        place, np.repeat([first.radius, second.radius], len(impacts)), np.repeat(areal, len(impacts)),
        velocity=np.vstack([-(1.0 - share) * u, share * u]), spin=spins.T.ravel(),
    )  # fmt: skip


def run(impacts: Sequence[Impact], contact: ContactModel, dt: float, duration: float) -> Floats:
    """What the code makes of `impacts` within `duration` [s] of touching: rows like `Rebound.numbers`."""
    n, walls = len(impacts), [Wall(point=(0.0, 0.0), normal=(0.0, 1.0))] if impacts[0].second is None else []
    system = ParticleSystem(grains_before(impacts, dt), contact, time_step=dt, walls=walls, ledger=False)
    system.advance(math.ceil(duration / dt) + 3)
    order = np.argsort(system.grains.number)
    vx, vy, spin = (getattr(system.grains, name)[order] for name in ("vx", "vy", "omega"))
    if walls:
        return np.column_stack([vy, -vx, spin, np.zeros(n)])
    left, right = impacts[0].first.mass, impacts[0].second.mass
    for v in (vx, vy):  # the momentum of every pair was zero: round-off of the kicks
        assert np.abs(left * v[:n] + right * v[n:]).max() <= 1e-13 * left * max(
            abs(i.v_n) + abs(i.u_t) for i in impacts
        )
    return np.column_stack([vx[n:] - vx[:n], vy[n:] - vy[:n], spin[:n], spin[n:]])


def compare(benchmark: Benchmark, kind: Kind, impacts: Sequence[Impact], steps: int) -> tuple[Floats, Floats, Floats]:
    """Reference and code (n, 4) with `steps` per undamped contact, and the largest deviation of each impact.

    Deviations are those of velocities and of surface speeds r omega, over the speed of the surfaces
    against each other before the impact.
    """
    found = [impact.solve() for impact in impacts]
    reference = np.array([rebound.numbers() for rebound in found])
    dt = impacts[0].springs.duration(impacts[0].mass, benchmark.speed) / steps
    ours = run(impacts, benchmark.contact(kind), dt, 1.05 * max(rebound.duration for rebound in found))
    return reference, ours, deviation(impacts, reference, ours)


def deviation(impacts: Sequence[Impact], reference: Floats, ours: Floats) -> Floats:
    radii = (impacts[0].first.radius, impacts[0].second.radius if impacts[0].second else 0.0)
    speed = np.array([math.hypot(i.v_n, i.look_at_start().v_t) for i in impacts])
    return (np.abs(ours - reference) * [1.0, 1.0, *radii]).max(axis=1) / speed


def errors(benchmark: Benchmark, kind: Kind, impacts: Sequence[Impact], steps: Sequence[int]) -> Floats:
    """Root mean square deviation from the reference at each number of steps per contact.

    The force has kinks, so the error depends on where in a step they fall: 16 copies of every impact
    touch at different moments, and the contact time over dt keeps its fractional part 1/3.
    """
    found = [impact.solve() for impact in impacts]
    copies = [impact for impact in impacts for _ in range(16)]
    reference = np.repeat([rebound.numbers() for rebound in found], 16, axis=0)
    duration = impacts[0].springs.duration(impacts[0].mass, benchmark.speed)
    late = 1.05 * max(rebound.duration for rebound in found)
    contact, result = benchmark.contact(kind), []
    for n in steps:
        ours = run(copies, contact, duration / (n + 1.0 / 3.0), late)
        result.append(math.sqrt(np.mean(deviation(copies, reference, ours) ** 2)))
    return np.array(result)


def orders(errors: Floats) -> Floats:
    """Orders in dt where each error was taken at half the step of the one before."""
    return -np.diff(np.log2(errors))
