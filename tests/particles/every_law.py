"""Two discs and all contact laws: numbers over many decades, six combinations in which every law occurs.

A combination of law types compiles for some seconds, so the tests draw numbers, not combinations.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import hypothesis.strategies as st
import numpy as np
from hypothesis import settings

from particles import (
    ConstantTorqueRolling,
    Contact,
    ContactModel,
    ContactTable,
    CoulombFriction,
    ElasticPlasticRolling,
    GlobalDamping,
    Grains,
    HertzSpringDashpot,
    LinearSpringDashpot,
    MindlinFriction,
    ParticleSystem,
    Wall,
)
from particles.contact import recipe

EPS = np.finfo(float).eps
KINDS = ("normal only", "damped rolling", "elastic rolling", "Mindlin", "constant torque", "table")
WITH_DAMPING = ("damped rolling", "elastic rolling", "table")  # compiled with GlobalDamping, as in discs.full_law
MANY = settings(deadline=None, derandomize=True, max_examples=40, print_blob=False)


@dataclass(frozen=True, kw_only=True)
class Pair:
    """Two discs and the numbers of their contact; `other` is the second radius over the first.

    Stiffness k [N/m] is the slope of the normal spring at `overlap` times the smaller radius; dashpots
    are given by their damping ratios (zeta), tangential and rolling stiffness by their ratios
    to k_n and k_t R_r^2.
    """

    radius: float = 1e-3
    other: float = 1.0
    density: float = 1000.0
    k: float = 1e5
    overlap: float = 1e-3
    zeta: float = 0.0
    may_pull: bool = False
    shear: float = 0.2
    mu: float = 0.5
    shear_zeta: float = 0.0
    roll: float = 1.0
    mu_r: float = 0.1
    roll_zeta: float = 0.0
    by_modulus: bool = False

    @property
    def radii(self) -> np.ndarray:
        return self.radius * np.array([1.0, self.other])

    @property
    def mass(self) -> np.ndarray:
        return math.pi * self.density * self.radii**2

    @property
    def delta(self) -> float:
        """Overlap [m] at which the normal spring has the slope k."""
        return self.overlap * float(self.radii.min())

    @property
    def reduced_mass(self) -> float:
        return float(1.0 / (1.0 / self.mass).sum())

    @property
    def reduced_radius(self) -> float:
        return float(1.0 / (1.0 / self.radii).sum())

    @property
    def omega_0(self) -> float:
        """Frequency of the undamped contact [1/s]."""
        return math.sqrt(self.k / self.reduced_mass)

    @property
    def distance(self) -> float:
        return float(self.radii.sum()) - self.delta

    def critical(self, k: float) -> float:
        return 2.0 * math.sqrt(self.reduced_mass * k)


def decades(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers from 10^low to 10^high, even in their logarithm."""
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


def or_none(some: st.SearchStrategy[float]) -> st.SearchStrategy[float]:
    return st.one_of(st.just(0.0), some)


def any_pair(**given: st.SearchStrategy[object]) -> st.SearchStrategy[Pair]:
    """Pairs from microns to hundreds of metres, of any stiffness, damping and friction."""
    drawn = {
        "radius": decades(-6.0, 2.0),
        "other": decades(-2.0, 2.0),
        "density": decades(-1.0, 5.0),
        "k": decades(-2.0, 12.0),
        "overlap": decades(-6.0, -1.5),
        "zeta": or_none(decades(-4.0, 0.5)),
        "may_pull": st.booleans(),
        "shear": decades(-3.0, 1.0),
        "mu": or_none(decades(-3.0, 3.0)),
        "shear_zeta": or_none(decades(-4.0, 0.5)),
        "roll": decades(-3.0, 1.0),
        "mu_r": or_none(decades(-4.0, 3.0)),
        "roll_zeta": or_none(decades(-4.0, 0.5)),
        "by_modulus": st.booleans(),
    }
    return st.builds(Pair, **(drawn | given))


def restitution(pair: Pair) -> float:
    """e of the pair's damping ratio; with tension an overdamped contact has none, and takes that of zeta = 0.9."""
    if pair.may_pull:
        return recipe.restitution_with_tension(min(pair.zeta, 0.9))
    return recipe.restitution_without_tension(pair.zeta)


def linear(pair: Pair) -> LinearSpringDashpot:
    return LinearSpringDashpot(stiffness=pair.k, damping=pair.zeta * pair.critical(pair.k), may_pull=pair.may_pull)


def hertz(pair: Pair) -> HertzSpringDashpot:
    """k_h or E* with which the slope at the pair's overlap is k."""
    k_h = pair.k / (1.5 * math.sqrt(pair.delta))
    rest = {"restitution": restitution(pair), "may_pull": pair.may_pull}
    if pair.by_modulus:
        return HertzSpringDashpot(modulus=0.75 * k_h / math.sqrt(pair.reduced_radius), **rest)
    return HertzSpringDashpot(stiffness=k_h, **rest)


def coulomb(pair: Pair) -> CoulombFriction:
    k_t = pair.shear * pair.k
    return CoulombFriction(stiffness=k_t, friction=pair.mu, damping=pair.shear_zeta * pair.critical(k_t))


def elastic_rolling(pair: Pair, eta: float) -> ElasticPlasticRolling:
    stiffness = None if pair.roll == 1.0 else pair.roll * pair.shear * pair.k * pair.reduced_radius**2
    return ElasticPlasticRolling(friction=pair.mu_r, damping_ratio=eta, stiffness=stiffness)


def model_of(kind: str, pair: Pair) -> ContactModel:
    """The contact of one kind; "table" stands for the entries of its table."""
    if kind == "normal only":
        return ContactModel(normal=linear(pair))
    if kind in ("damped rolling", "table"):
        eta = max(pair.roll_zeta, 1e-12)  # zero would be another kind
        return ContactModel(normal=linear(pair), tangential=coulomb(pair), rolling=elastic_rolling(pair, eta))
    if kind == "elastic rolling":
        return ContactModel(normal=linear(pair), tangential=coulomb(pair), rolling=elastic_rolling(pair, 0.0))
    if kind == "Mindlin":
        mindlin = MindlinFriction(stiffness_ratio=pair.shear, friction=pair.mu, damping_ratio=pair.shear_zeta)
        return ContactModel(normal=hertz(pair), tangential=mindlin)
    normal = LinearSpringDashpot(stiffness=pair.k, restitution=restitution(pair), may_pull=pair.may_pull)
    return ContactModel(normal=normal, tangential=coulomb(pair), rolling=ConstantTorqueRolling(friction=pair.mu_r))


def contact_of(kind: str, pair: Pair) -> Contact:
    """The contact law; in a table, between unlike materials, and others of the same kind between like ones."""
    model = model_of(kind, pair)
    if kind != "table":
        return model
    unlike = Pair(radius=2.0 * pair.radius, k=3.0 * pair.k, mu=0.123, mu_r=0.456, may_pull=pair.may_pull)
    other = model_of(kind, unlike)
    return ContactTable([[other, model], [model, other]])


def system_of(
    kind: str, grains: Grains, contact: Contact, *, dt: float, walls: Sequence[Wall] = (), alpha: float = 0.0
) -> ParticleSystem:
    """A system whose kernels are those of `kind`."""
    damping = GlobalDamping(translational=alpha, rotational=alpha) if kind in WITH_DAMPING else None
    return ParticleSystem(grains, contact, time_step=dt, walls=walls, damping=damping)


def discs_of(pair: Pair, place: np.ndarray) -> Grains:
    """Both discs free, of materials 0 and 1."""
    return Grains.discs(place, pair.radii, pair.density, material=[0, 1])


def limits(kind: str, pair: Pair) -> tuple[float, float]:
    """mu and mu_r of the model: zero where a law is not modelled."""
    mu = 0.0 if kind == "normal only" else pair.mu
    return mu, 0.0 if kind in ("normal only", "Mindlin") else pair.mu_r
