"""From the contact table of a scene to contact laws, for one material or a table of several."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import particles as dem
from coupled.scene import Contact, Scene
from coupled.scene.contact import Elasticity
from coupled.scene.materials import GRAINS, STRUCTURE, hertz_between, materials, meet, numbers_between
from particles.contact import recipe
from particles.contact.model import NormalLaw, RollingLaw, TangentialLaw
from particles.timestep import ALLOWED_OVERLAP

Numbers = dict[str, float]
Spring = float | tuple[Elasticity, Elasticity] | None
SPRINGS = ("tangential_stiffness", "tangential_ratio", "rolling_stiffness", "rolling_damping_ratio")
USUAL_RATIO = 0.05  # tangential over normal stiffness where no friction strains it


@dataclass(frozen=True, kw_only=True)
class Choice:
    """What the recipe of model 1.3 chose, and for which grain.

    Attributes
    ----------
    numbers : dict
        `normal_stiffness` [N/m], `restitution` [-], `tangential_stiffness` [N/m],
        `tangential_damping` [N s/m].
    mass, radius : float
        Of the smallest grain [kg/m], [m].
    speed, overlap : float
        Of its impact on something fixed [m/s], [m].
    """

    numbers: Numbers
    mass: float
    radius: float
    speed: float
    overlap: float


def contact_law(scene: Scene) -> dem.Contact:
    """The contact law of a scene: a table only if it tells materials apart."""
    contact = scene.contact
    chosen = {} if contact.recipe is None else choose(scene).numbers
    if not contact.pairs and not contact.materials:
        return _model(contact, chosen | contact.numbers(), hertz_between(contact, GRAINS, GRAINS))
    names = materials(scene)
    numbers = {pair: chosen | numbers_between(contact, *pair) for pair in _meeting(scene, names)}
    _fill(list(numbers.values()))
    models = {frozenset(pair): _model(contact, own, hertz_between(contact, *pair)) for pair, own in numbers.items()}
    usual = models[frozenset([GRAINS])]  # where two materials never meet
    return dem.ContactTable([[models.get(frozenset([a, b]), usual) for b in names] for a in names])


def damping_of(scene: Scene) -> dem.GlobalDamping | None:
    """The global damping of a scene."""
    given = scene.damping
    if given is None:
        return None
    return dem.GlobalDamping(translational=given.translational, rotational=given.rotational)


def choose(scene: Scene) -> Choice:
    """Numbers of the recipe, for the smallest grain (model 1.3).

    The restitution is left to the law, which keeps it for every pair and at walls. The tangential
    spring acts in both directions: its dashpot is that of a contact that may pull, with the
    rotational mass ``I/r^2 = m/2``.
    """
    wish, grains = scene.contact.recipe, scene.first_grains
    mass, overlap = grains.smallest_mass, wish.max_overlap * grains.smallest_radius
    if wish.from_impact_speed is None:
        gravity = math.hypot(*scene.gravity)
        speed = math.sqrt(2.0 * gravity * wish.from_drop_height)
        stiffness = recipe.stiffness_from_drop_height(
            mass=mass, gravity=gravity, drop_height=wish.from_drop_height, largest_overlap=overlap
        )
    else:
        speed = wish.from_impact_speed
        stiffness = recipe.stiffness_from_impact_speed(mass=mass, speed=speed, largest_overlap=overlap)
    tangential = wish.stiffness_ratio * stiffness
    numbers = {
        "normal_stiffness": stiffness,
        "restitution": wish.restitution,
        "tangential_stiffness": tangential,
        "tangential_damping": recipe.damping_from_restitution(
            restitution=wish.restitution, effective_mass=mass / 2, stiffness=tangential, may_pull=True
        ),
    }
    return Choice(numbers=numbers, mass=mass, radius=grains.smallest_radius, speed=speed, overlap=overlap)


def interface_spring(
    scene: Scene, law: dem.Contact, grains: dem.Grains, radius: float, overlap: float | None = None
) -> tuple[float, float]:
    """Stiffest spring [N/m] and strongest dashpot [N s/m] that an interface of some `radius` [m] may meet.

    Hertz's spring by its slope at an `overlap` [m], 5 % of the smallest radius if none is given, with the largest
    partner. Dashpots that follow from a restitution with the mass of the heaviest free grain:
    nothing is heavier, as two prescribed grains have none.
    """
    partner = float(grains.radius.max())
    overlap = ALLOWED_OVERLAP * float(grains.radius.min()) if overlap is None else overlap
    effective = partner / (1.0 + partner / radius)
    mass = float(grains.mass.max())
    springs = []
    for model in _models_of(law, scene, STRUCTURE):
        slope = model.normal.stiffness_at(overlap, effective)
        springs.append((slope, _dashpot(model.normal, slope, mass)))
    return max(k for k, _ in springs), max(c for _, c in springs)


def _models_of(law: dem.Contact, scene: Scene, name: str) -> Iterator[dem.ContactModel]:
    """The laws between one material and all that it can meet."""
    if not isinstance(law, dem.ContactTable):
        yield law
        return
    names = materials(scene)
    yield from (law.rows[names.index(name)][k] for k, other in enumerate(names) if meet(scene, name, other))


def _dashpot(normal: NormalLaw, slope: float, mass: float) -> float:
    """Coefficient [N s/m] of a normal dashpot where the spring has a slope [N/m], for an effective mass [kg/m]."""
    if normal.restitution is None:
        return normal.damping
    zeta = recipe.damping_ratio(normal.restitution, may_pull=normal.may_pull)
    tsuji = math.sqrt(5.0 / 6.0) if isinstance(normal, dem.HertzSpringDashpot) else 1.0  # k_h sqrt(delta) is 2/3 slope
    return 2.0 * tsuji * zeta * math.sqrt(mass * slope)


def _meeting(scene: Scene, names: tuple[str, ...]) -> list[tuple[str, str]]:
    """Pairs of materials that can touch, each once."""
    return [(a, b) for k, a in enumerate(names) for b in names[k:] if meet(scene, a, b)]


def _fill(pairs: list[Numbers]) -> None:
    """Zero friction where a pair has none, and springs for the features that other pairs have.

    Without friction these springs do nothing; the softest is taken, which asks for no smaller step.
    """
    for feature in ("friction", "rolling_friction"):
        if any(feature in own for own in pairs):
            for own in pairs:
                own.setdefault(feature, 0.0)
    for name in SPRINGS:
        given = [own[name] for own in pairs if own.get(name)]
        idle = "rolling_friction" if name.startswith("rolling") else "friction"
        for own in pairs:
            if given and not own.get(idle) and not own.get(name):
                own[name] = min(given)


def _model(contact: Contact, numbers: Numbers, spring: Spring) -> dem.ContactModel:
    tangential = rolling = None
    if "friction" in numbers:
        tangential = _tangential(contact, numbers, spring)
    if "rolling_friction" in numbers:
        rolling = _rolling(contact, numbers)
    return dem.ContactModel(normal=_normal(contact, numbers, spring), tangential=tangential, rolling=rolling)


def _normal(contact: Contact, numbers: Numbers, spring: Spring) -> NormalLaw:
    end = contact.recipe.restitution_at if contact.recipe is not None else contact.restitution_at
    may_pull = end == "zero_overlap"
    if contact.normal == "linear":
        dashpot: dict[str, Any] = {"damping": numbers.get("normal_damping", 0.0)}
        if "restitution" in numbers:
            dashpot = {"restitution": numbers["restitution"]}
        return dem.LinearSpringDashpot(stiffness=numbers["normal_stiffness"], may_pull=may_pull, **dashpot)
    options = {"restitution": numbers["restitution"], "may_pull": may_pull}
    if isinstance(spring, tuple):
        return dem.HertzSpringDashpot.of_materials(*_materials(spring), **options)
    return dem.HertzSpringDashpot(stiffness=spring, **options)


def _tangential(contact: Contact, numbers: Numbers, spring: Spring) -> TangentialLaw:
    friction = numbers["friction"]
    if not contact.follows_normal:
        return dem.CoulombFriction(
            stiffness=numbers["tangential_stiffness"], friction=friction, damping=numbers["tangential_damping"]
        )
    damping = {"friction": friction, "damping_ratio": numbers["tangential_damping_ratio"]}
    if "tangential_ratio" in numbers or not isinstance(spring, tuple):
        return dem.MindlinFriction(stiffness_ratio=numbers.get("tangential_ratio", USUAL_RATIO), **damping)
    return dem.MindlinFriction.of_materials(*_materials(spring), **damping)


def _rolling(contact: Contact, numbers: Numbers) -> RollingLaw:
    if contact.rolling == "constant_torque":
        return dem.ConstantTorqueRolling(friction=numbers["rolling_friction"])
    return dem.ElasticPlasticRolling(
        friction=numbers["rolling_friction"],
        damping_ratio=numbers["rolling_damping_ratio"],
        stiffness=numbers.get("rolling_stiffness"),
    )


def _materials(pair: tuple[Elasticity, Elasticity]) -> Iterator[dem.Material]:
    for own in pair:
        yield dem.Material(youngs_modulus=own.youngs_modulus, poissons_ratio=own.poissons_ratio)
