"""The eight benchmark impacts of Chung and Ooi (2011, Granular Matter 13:643) for discs: bodies and laws.

Materials, radii, speeds, friction and restitution are theirs as they are quoted in the literature. A
disc has the mass of their sphere (a layer 4/3 r thick) and the moment of inertia ``m r^2/2`` of a
disc, so that Hertz's spring, which is that of spheres, keeps its numbers. The linear springs are
ours: as deep at the benchmark's speed as Hertz's, with Mindlin's ratio of tangential to normal.
"""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from impacts import Body, Impact, Springs, damping_ratio
from numpy.typing import ArrayLike

from particles import (
    ContactModel,
    CoulombFriction,
    HertzSpringDashpot,
    LinearSpringDashpot,
    Material,
    MindlinFriction,
)

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
OTHER_ALUMINIUM = Stuff(name="aluminium alloy", modulus=7.0e10, poisson=0.30, density=2699.0)  # of benchmark 2
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

    def at_angles(self, kind: Kind, angles: ArrayLike) -> list[Impact]:
        """Impacts of one resultant speed at `angles` [rad] from the normal, with the springs of the normal impact."""
        tilted = self.impacts(kind, u_t=self.speed * np.sin(angles))
        return [replace(i, v_n=-self.speed * float(c)) for i, c in zip(tilted, np.cos(angles), strict=True)]


ELASTIC_PAIRS = [Benchmark(stuff=s, radius=0.01, other_radius=0.01, speed=20.0) for s in (GLASS, LIMESTONE)]
ELASTIC_PLANES = [Benchmark(stuff=s, radius=0.1, speed=0.2) for s in (OTHER_ALUMINIUM, MAGNESIUM)]
BOUNCES = [Benchmark(stuff=s, radius=0.0025, speed=3.9) for s in (OXIDE, IRON)]
AT_ANGLES = [Benchmark(stuff=s, radius=0.0025, speed=3.9, mu=0.092, restitution=0.98) for s in (OXIDE, ALUMINIUM)]
SIDEWAYS = [Benchmark(stuff=s, radius=1e-5, speed=5.0, mu=0.3) for s in (STEEL, POLYETHYLENE)]
SPINNING = [Benchmark(stuff=s, radius=0.1, speed=0.2, mu=0.4, restitution=0.5) for s in (ALUMINIUM, NYLON)]
TWINS = [
    Benchmark(stuff=s, radius=0.1, other_radius=0.1, speed=0.4, mu=0.4, restitution=0.5) for s in (ALUMINIUM, COPPER)
]
ANVIL = replace(
    SPINNING[0],
    other=replace(ALUMINIUM, name="heavy aluminium", density=1000.0 * ALUMINIUM.density),
    other_radius=0.5,
)
UNEQUAL = replace(SPINNING[1], other=ALUMINIUM, other_radius=0.05)
