"""Rules of the contact law: coefficients or recipe, and complete features."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coupled.scene.contact import Contact
from coupled.scene.refusal import missing, refusal

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

_COEFFICIENTS = (
    "normal_stiffness",
    "normal_damping",
    "tangential_stiffness",
    "tangential_damping",
)


def check_contact(scene: Scene) -> None:
    """Check that each feature of the contact law is complete."""
    contact = scene.contact
    if contact is None:
        return
    if contact.recipe is not None:
        _check_recipe(scene, contact)
    elif contact.normal_stiffness is None:
        raise missing("contact.normal_stiffness", "give it in N/m, or a table [contact.recipe]")
    else:
        _check_friction(contact)
    for name in ("rolling_friction", "rolling_damping_ratio", "rolling_stiffness"):
        needs = "friction" if name == "rolling_friction" else "rolling_friction"
        value = getattr(contact, name)
        if value is not None and getattr(contact, needs) is None:
            raise refusal(f"contact.{name}", value, f"needs contact.{needs}; give that or remove this")


def _check_friction(contact: Contact) -> None:
    if contact.friction is not None and contact.tangential_stiffness is None:
        raise missing(
            "contact.tangential_stiffness",
            f"friction = {contact.friction:g} needs a tangential spring; give it in N/m "
            f"(usual: normal_stiffness/20), or remove friction",
        )
    for name in ("tangential_stiffness", "tangential_damping"):
        value = getattr(contact, name)
        if value is not None and contact.friction is None:
            raise refusal(f"contact.{name}", value, "needs contact.friction; give that or remove this")


def _check_recipe(scene: Scene, contact: Contact) -> None:
    recipe = contact.recipe
    assert recipe is not None
    for name in _COEFFICIENTS:
        value = getattr(contact, name)
        if value is not None:
            raise refusal(
                f"contact.{name}",
                value,
                "is what [contact.recipe] computes; remove this or the recipe",
            )
    if (recipe.drop_height is None) == (recipe.impact_speed is None):
        raise refusal(
            "contact.recipe",
            {},
            "needs exactly one of drop_height [m] and impact_speed [m/s]; give one of them",
        )
    if recipe.drop_height is not None and not any(scene.gravity):
        raise refusal(
            "contact.recipe.drop_height",
            recipe.drop_height,
            "needs gravity to fall; give gravity, or impact_speed instead",
        )
    if scene.first_grains is None:
        raise refusal(
            "contact.recipe",
            {},
            "takes mass and radius from free grains, and there are none; give normal_stiffness",
        )
