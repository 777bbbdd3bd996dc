"""Rules of the contact law: coefficients or recipe, and complete features."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coupled.scene.contact import Contact, Recipe
from coupled.scene.refusal import missing, refusal
from coupled.scene.rules.materials import check_materials

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

_RECIPE_GIVES = (
    "normal_stiffness",
    "normal_damping",
    "restitution",
    "restitution_at",
    "tangential_stiffness",
    "tangential_damping",
    "tangential_ratio",
    "tangential_damping_ratio",
)
_OF_HERTZ = ("hertz_stiffness", "youngs_modulus", "poissons_ratio")
_NEEDS_MASS = ("restitution", "tangential_damping_ratio")


def check_contact(scene: Scene) -> None:
    """Check that each feature of the contact law is complete, and the materials that differ from it."""
    contact = scene.contact
    if contact is None:
        return
    if contact.recipe is not None:
        _check_recipe(scene, contact, contact.recipe)
    elif contact.normal == "hertz":
        _check_hertz(contact)
    else:
        _check_linear(contact)
    if contact.restitution_at is not None and contact.restitution is None and contact.recipe is None:
        raise refusal("contact.restitution_at", contact.restitution_at, "needs contact.restitution; give that as well")
    _check_needed_features(contact)
    _check_tangential_kind(contact)
    _check_rolling_kind(contact)
    check_materials(scene, contact)
    _check_tangential_springs(contact)
    _check_rolling_springs(contact)
    _check_mass(scene, contact)


def _check_linear(contact: Contact) -> None:
    for name in _OF_HERTZ:
        value = getattr(contact, name)
        if value is not None:
            raise refusal(f"contact.{name}", value, 'belongs to contact.normal = "hertz"; set that or remove this')
    if contact.normal_stiffness is None:
        raise missing("contact.normal_stiffness", "give it in N/m, or a table [contact.recipe]")
    if contact.restitution is not None and contact.normal_damping is not None:
        raise refusal(
            "contact.normal_damping",
            contact.normal_damping,
            "is given together with contact.restitution, which sets the dashpot of each contact; keep one",
        )


def _check_hertz(contact: Contact) -> None:
    for name, instead in (("normal_stiffness", "hertz_stiffness"), ("normal_damping", "restitution")):
        value = getattr(contact, name)
        if value is not None:
            raise refusal(
                f"contact.{name}", value, f'belongs to contact.normal = "linear"; give contact.{instead} instead'
            )
    moduli = ("youngs_modulus", "poissons_ratio")
    given = [name for name in moduli if getattr(contact, name) is not None]
    if contact.hertz_stiffness is not None and given:
        raise refusal(
            "contact.hertz_stiffness", contact.hertz_stiffness, f"is given together with contact.{given[0]}; keep one"
        )
    if len(given) == 1:
        other = moduli[1 - moduli.index(given[0])]
        raise missing(f"contact.{other}", f"Hertz's spring needs it beside {given[0]}; give both")
    if contact.hertz_stiffness is None and not given and not contact.materials:
        raise missing(
            "contact.hertz_stiffness", "Hertz's spring needs it in N/m^(3/2), or youngs_modulus and poissons_ratio"
        )


def _check_needed_features(contact: Contact) -> None:
    """Numbers of a feature that is not modelled."""
    tangential = ("tangential_stiffness", "tangential_damping", "tangential_ratio", "tangential_damping_ratio")
    needs = dict.fromkeys((*tangential, "rolling_friction"), ("friction", contact.rubs))
    needs |= dict.fromkeys(("rolling_damping_ratio", "rolling_stiffness"), ("rolling_friction", contact.rolls))
    for path, table in contact.tables():
        for name, (feature, modelled) in needs.items():
            value = getattr(table, name)
            if value is not None and not modelled:
                raise refusal(f"{path}.{name}", value, f"needs contact.{feature}; give that or remove this")
    if contact.rolling is not None and not contact.rolls:
        raise refusal("contact.rolling", contact.rolling, "needs contact.rolling_friction; give that or remove this")


def _check_tangential_kind(contact: Contact) -> None:
    kinds = (("tangential_stiffness", "tangential_damping"), ("tangential_ratio", "tangential_damping_ratio"))
    wrong, right = kinds if contact.follows_normal else kinds[::-1]
    for name, instead in zip(wrong, right, strict=True):
        value = getattr(contact, name)
        if value is not None:
            beside = contact.given_in(right[0]) or 'contact.normal = "hertz"'
            remedy = "keep one" if name == wrong[0] else f"give contact.{instead} or remove this"
            raise refusal(f"contact.{name}", value, f"does not go with {beside}; {remedy}")


def _check_tangential_springs(contact: Contact) -> None:
    """Every contact with friction has a tangential spring."""
    name = "tangential_ratio" if contact.follows_normal else "tangential_stiffness"
    for path, table in contact.tables():
        own = contact.numbers() | table.numbers()
        if contact.recipe is not None or own.get("friction") is None or name in own:
            continue
        if contact.normal == "hertz" and name == "tangential_ratio":
            spring = table.hertz_stiffness or (contact.hertz_stiffness if table.youngs_modulus is None else None)
            if spring is None:
                continue  # Mindlin's, from the elastic constants
            remedy = "give it over the slope of the normal one, or youngs_modulus and poissons_ratio for Mindlin's"
        elif name == "tangential_ratio":
            remedy = "give it over the normal one (usual: 0.05), or remove friction"
        else:
            remedy = "give it in N/m (usual: normal_stiffness/20), or remove friction"
        raise missing(f"{path}.{name}", f"friction = {own['friction']:g} needs a tangential spring; {remedy}")


def _check_rolling_kind(contact: Contact) -> None:
    if contact.rolling != "constant_torque":
        return
    for name in ("rolling_damping_ratio", "rolling_stiffness"):
        value = getattr(contact, name)
        if value is not None:
            raise refusal(
                f"contact.{name}", value, 'belongs to contact.rolling = "elastic_plastic"; set that or remove this'
            )


def _check_rolling_springs(contact: Contact) -> None:
    """Springs that can be had."""
    if contact.rolling == "constant_torque":
        return
    for path, table in contact.tables():
        own = contact.numbers() | table.numbers()
        if not own.get("rolling_friction"):
            continue
        if contact.normal == "hertz" and contact.follows_normal and "rolling_stiffness" not in own:
            raise missing(
                f"{path}.rolling_stiffness",
                "the rolling spring cannot follow a tangential one that changes with the overlap; give it in N m/rad, "
                'or contact.rolling = "constant_torque"',
            )


def _check_mass(scene: Scene, contact: Contact) -> None:
    """Dashpots that follow from an effective mass need a free grain in the contact."""
    if scene.first_grains is not None:
        return
    lossless: dict[str, Any] = {"restitution": 1.0, "tangential_damping_ratio": 0.0}
    for path, table in contact.tables():
        for name in _NEEDS_MASS:
            value = getattr(table, name)
            if value is not None and value != lossless[name]:
                raise refusal(
                    f"{path}.{name}",
                    value,
                    "takes the mass of a free grain, and there are none; give the dashpots of a linear spring outright",
                )


def _check_recipe(scene: Scene, contact: Contact, recipe: Recipe) -> None:
    for name in _RECIPE_GIVES:
        value = getattr(contact, name)
        if value is not None:
            raise refusal(f"contact.{name}", value, "is what [contact.recipe] computes; remove this or the recipe")
    if contact.normal != "linear":
        raise refusal("contact.normal", contact.normal, "has no recipe, which gives a linear spring; remove one")
    for name in _OF_HERTZ:
        value = getattr(contact, name)
        if value is not None:
            raise refusal(f"contact.{name}", value, "does not go with the linear spring of [contact.recipe]; remove it")
    if (recipe.from_drop_height is None) == (recipe.from_impact_speed is None):
        raise refusal(
            "contact.recipe",
            {},
            "needs exactly one of from_drop_height [m] and from_impact_speed [m/s]; give one of them",
        )
    if recipe.from_drop_height is not None and not any(scene.gravity):
        raise refusal(
            "contact.recipe.from_drop_height",
            recipe.from_drop_height,
            "needs gravity to fall; give gravity, or from_impact_speed instead",
        )
    if scene.first_grains is None:
        raise refusal(
            "contact.recipe",
            {},
            "takes mass and radius from free grains, and there are none; give normal_stiffness",
        )
