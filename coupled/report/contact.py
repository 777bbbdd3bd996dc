"""What the contact law of a scene came to, in words and in numbers."""

from __future__ import annotations

from itertools import combinations_with_replacement

import particles as dem
from coupled.laws import choose, contact_law
from coupled.scene import Scene
from coupled.scene.materials import materials, meet
from particles.contact.model import NormalLaw, RollingLaw, TangentialLaw

Row = tuple[str, str, str]


def contact_rows(scene: Scene) -> list[Row]:
    """Rows (section, quantity, value): the law, what a recipe chose and from what, and where pairs differ."""
    if scene.contact is None:
        return []
    law = contact_law(scene)
    usual = next(law.models_of([0]))
    several = isinstance(law, dem.ContactTable)
    rows = _law_rows(usual, "between grains: " if several else "")
    rows += [("contact", f"recipe: {name}", value) for name, value in _chosen(scene)]
    if several:
        said = {value for _, _, value in _law_rows(usual)}
        for (a, first), (b, second) in combinations_with_replacement(enumerate(materials(scene)), 2):
            if meet(scene, first, second):
                own = _law_rows(law.rows[a][b], f"{first} and {second}: ")
                rows += [row for row in own if row[2] not in said]
    return rows


def contact_numbers(scene: Scene) -> dict[str, float]:
    """Numbers of the recipe for `summary.json`, by name; empty without one."""
    if scene.contact is None or scene.contact.recipe is None:
        return {}
    choice = choose(scene)
    used = {name: value for name, value in choice.numbers.items() if _used(scene, name)}
    return {f"contact_{name}": value for name, value in used.items()} | {
        "recipe_mass": choice.mass,
        "recipe_radius": choice.radius,
        "recipe_impact_speed": choice.speed,
        "recipe_overlap": choice.overlap,
    }


def contact_sentences(scene: Scene) -> list[str]:
    """What a recipe chose, for the log of a run."""
    return [f"contact.recipe: {name}: {value}" for name, value in _chosen(scene)]


def _used(scene: Scene, name: str) -> bool:
    return scene.contact.rubs or not name.startswith("tangential")


def _chosen(scene: Scene) -> list[tuple[str, str]]:
    if scene.contact is None or scene.contact.recipe is None:
        return []
    choice, of = choose(scene), scene.contact.recipe
    numbers = choice.numbers
    end = of.restitution_at.replace("_", " ")
    chosen = [
        ("for the smallest grain", f"mass {choice.mass:.4g} kg/m, radius {choice.radius:.4g} m"),
        (
            "normal stiffness",
            f"{numbers['normal_stiffness']:.4g} N/m, at most {choice.overlap:.3g} m of overlap when it hits "
            f"something fixed at {choice.speed:.4g} m/s",
        ),
        ("restitution", f"{numbers['restitution']:g} at {end}, each contact with its own effective mass"),
        ("tangential stiffness", f"{numbers['tangential_stiffness']:.4g} N/m"),
        (
            "tangential dashpot",
            f"{numbers['tangential_damping']:.4g} N s/m, from {choice.mass / 2:.4g} kg/m (I/r^2)",
        ),
    ]
    return [(name, value) for name, value in chosen if _used(scene, name)]


def _law_rows(model: dem.ContactModel, between: str = "") -> list[Row]:
    rows = [("contact", f"{between}normal", _normal(model.normal))]
    if model.tangential is not None:
        rows.append(("contact", f"{between}tangential", _tangential(model.tangential)))
    if model.rolling is not None:
        rows.append(("contact", f"{between}rolling", _rolling(model.rolling)))
    return rows


def _normal(law: NormalLaw) -> str:
    end = "zero overlap" if law.may_pull else "zero force"
    rebound = f"restitution {law.restitution:g} at {end}" if law.restitution is not None else ""
    if isinstance(law, dem.LinearSpringDashpot):
        return f"linear, {law.stiffness:.4g} N/m, {rebound or f'dashpot {law.damping:.4g} N s/m'}"
    if law.modulus is not None:
        return f"Hertz, E* = {law.modulus:.4g} Pa, {rebound}"
    return f"Hertz, {law.stiffness:.4g} N/m^(3/2), {rebound}"


def _tangential(law: TangentialLaw) -> str:
    if isinstance(law, dem.CoulombFriction):
        return f"friction {law.friction:g}, {law.stiffness:.4g} N/m, dashpot {law.damping:.4g} N s/m"
    return (
        f"friction {law.friction:g}, {law.stiffness_ratio:.4g} of the normal slope, "
        f"dashpot {law.damping_ratio:g} of critical"
    )


def _rolling(law: RollingLaw) -> str:
    if isinstance(law, dem.ConstantTorqueRolling):
        return f"friction {law.friction:g}, constant torque"
    stiffness = "k_t R_r^2" if law.stiffness is None else f"{law.stiffness:.4g} N m/rad"
    return f"friction {law.friction:g}, {stiffness}, dashpot {law.damping_ratio:g} of critical"
