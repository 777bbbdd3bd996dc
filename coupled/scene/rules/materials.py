"""Rules of the materials: names that exist, pairs that meet, numbers of the kind that all pairs share."""

from __future__ import annotations

from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

from coupled.scene.contact import Contact, Pair
from coupled.scene.materials import RESERVED, hertz_between, materials, meet, speakable
from coupled.scene.refusal import missing, nearest, refusal

if TYPE_CHECKING:
    from coupled.scene.scene import Scene


def check_materials(scene: Scene, contact: Contact) -> None:
    """Check the names of the rows, [[contact.pairs]] and [contact.materials]."""
    for index, row in enumerate(scene.rows):
        if row.name in RESERVED:
            raise refusal(f"rows.{index}.name", row.name, f"is taken; choose none of {', '.join(RESERVED)}")
    rows = {row.name for row in scene.rows if row.name is not None}
    for index, intruder in enumerate(scene.intruders):
        if intruder.name in {*RESERVED, *rows}:
            taken = ", ".join([*RESERVED, *sorted(rows)])
            raise refusal(f"intruders.{index}.name", intruder.name, f"is taken; choose none of {taken}")
    _check_pairs(scene, contact)
    for index, pair in enumerate(contact.pairs):
        _check_numbers(contact, pair, f"contact.pairs.{index}")
    if contact.materials is not None:
        _check_constants(scene, contact)


def _check_pairs(scene: Scene, contact: Contact) -> None:
    seen: set[tuple[str, ...]] = set()
    for index, pair in enumerate(contact.pairs):
        key, names = f"contact.pairs.{index}.between", speakable(scene)
        for place, name in enumerate(pair.between):
            if name not in names:
                raise refusal(f"{key}.{place}", name, f"is no material of this scene; {nearest(name, names)}")
        if not meet(scene, *pair.between):
            raise refusal(
                key,
                list(pair.between),
                "never meet: walls touch free grains alone, and a structure not itself; remove this pair",
            )
        met = tuple(sorted(pair.between))
        if met in seen:
            raise refusal(key, list(pair.between), "is a pair that is given already; keep one")
        seen.add(met)


def _check_numbers(contact: Contact, pair: Pair, path: str) -> None:
    given, allowed = pair.numbers(), _shared_kind(contact)
    if not given:
        raise refusal(path, {}, f"has no number of its own; give one of {', '.join(allowed)}")
    for name, value in given.items():
        if name not in allowed:
            raise refusal(
                f"{path}.{name}",
                value,
                f"is of another kind than [contact], which all pairs share; allowed: {', '.join(allowed)}",
            )
    moduli = [name for name in ("youngs_modulus", "poissons_ratio") if name in given]
    if moduli and "hertz_stiffness" in given:
        raise refusal(
            f"{path}.hertz_stiffness", given["hertz_stiffness"], f"is given together with {moduli[0]}; keep one"
        )
    for name in ("youngs_modulus", "poissons_ratio"):
        if moduli and name not in contact.numbers() | given:
            raise missing(f"{path}.{name}", f"Hertz's spring needs it beside {moduli[0]}; give both")


def _shared_kind(contact: Contact) -> tuple[str, ...]:
    """Numbers that a pair may change."""
    if contact.normal == "hertz":
        normal: tuple[str, ...] = ("restitution", "hertz_stiffness", "youngs_modulus", "poissons_ratio")
    elif contact.restitution is not None or contact.recipe is not None:
        normal = ("normal_stiffness", "restitution")
    else:
        normal = ("normal_stiffness", "normal_damping")
    spring = ("ratio", "damping_ratio") if contact.follows_normal else ("stiffness", "damping")
    tangential = ("friction", *(f"tangential_{name}" for name in spring))
    spring = () if contact.rolling == "constant_torque" else ("damping_ratio", "stiffness")
    return (*normal, *tangential, "rolling_friction", *(f"rolling_{name}" for name in spring))


def _check_constants(scene: Scene, contact: Contact) -> None:
    if contact.normal != "hertz":
        raise refusal(
            "contact.materials", {}, 'has elastic constants for contact.normal = "hertz"; set that or remove it'
        )
    if contact.hertz_stiffness is not None:
        raise refusal(
            "contact.hertz_stiffness", contact.hertz_stiffness, "leaves [contact.materials] no part; keep one"
        )
    names = speakable(scene)
    for name in contact.materials or {}:
        if name not in names:
            raise refusal(f"contact.materials.{name}", {}, f"is no material of this scene; {nearest(name, names)}")
    for first, second in combinations_with_replacement(materials(scene), 2):
        if meet(scene, first, second) and hertz_between(contact, first, second) is None:
            lacking = [name for name in (first, second) if name not in (contact.materials or {})]
            raise missing(
                f"contact.materials.{lacking[0]}",
                "Hertz's spring needs its youngs_modulus and poissons_ratio; give them here, or for all in [contact]",
            )
