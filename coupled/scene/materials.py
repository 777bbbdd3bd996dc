"""Which materials a scene tells apart, and the numbers of the contact law between two of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

from coupled.scene.contact import Contact, Elasticity, Pair
from coupled.scene.grains import Wall

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

GRAINS, STRUCTURE, WALLS = "grains", "structure", "walls"
SIDES: tuple[str, ...] = get_args(Wall)
RESERVED = (GRAINS, STRUCTURE, WALLS, *SIDES)


def materials(scene: Scene) -> tuple[str, ...]:
    """Names of the materials, the free grains first; a row or an intruder without a name is of theirs."""
    structure = (STRUCTURE,) if scene.interface is not None else ()
    walls = scene.box.walls if scene.box is not None else ()
    rows = dict.fromkeys(row.name for row in scene.rows if row.name is not None)
    intruders = dict.fromkeys(intruder.name for intruder in scene.intruders if intruder.name is not None)
    return (GRAINS, *structure, *walls, *rows, *intruders)


def intruder_materials(scene: Scene) -> list[int]:
    """The material of each intruder, by its place in `materials`."""
    of = materials(scene).index
    return [of(intruder.name or GRAINS) for intruder in scene.intruders]


def speakable(scene: Scene) -> tuple[str, ...]:
    """Names that a pair or a table of materials may use."""
    walls = (WALLS,) if scene.box is not None and scene.box.walls else ()
    return (*materials(scene), *walls)


def meet(scene: Scene, first: str, second: str) -> bool:
    """Whether two materials can touch: walls meet free grains alone, the structure does not meet itself."""
    if _is_wall(first) or _is_wall(second):
        others = {first, second} - {WALLS, *SIDES}
        return bool(others) and others <= {GRAINS, *(intruder.name for intruder in scene.intruders)}
    return (first, second) != (STRUCTURE, STRUCTURE)


def pair_between(contact: Contact, first: str, second: str) -> Pair | None:
    """The pair that speaks of two materials; one that names a wall goes before one for all walls."""
    for a, b in ((first, second), (_group(first), _group(second))):
        for pair in contact.pairs:
            if sorted(pair.between) == sorted((a, b)):
                return pair
    return None


def numbers_between(contact: Contact, first: str, second: str) -> dict[str, float]:
    """Numbers of [contact] with those of the pair over them."""
    pair = pair_between(contact, first, second)
    return contact.numbers() | ({} if pair is None else pair.numbers())


def hertz_between(contact: Contact, first: str, second: str) -> float | tuple[Elasticity, Elasticity] | None:
    """Hertz's spring of two materials: k_h [N/m^(3/2)] or the constants of both. None if nothing is said.

    What the pair says goes before [contact.materials], and that before [contact].
    """
    pair = pair_between(contact, first, second)
    if pair is not None:
        if pair.hertz_stiffness is not None:
            return pair.hertz_stiffness
        both = _own_constants(contact.numbers() | pair.numbers())
        if both is not None and (pair.youngs_modulus is not None or pair.poissons_ratio is not None):
            return both, both
    own = [constants(contact, name) for name in (first, second)]
    if own[0] is not None and own[1] is not None:
        return own[0], own[1]
    return contact.hertz_stiffness


def constants(contact: Contact, name: str) -> Elasticity | None:
    """Elastic constants of a material: its own, those of all walls, those of [contact]."""
    table = contact.materials or {}
    return table.get(name) or table.get(_group(name)) or _own_constants(contact.numbers())


def _own_constants(numbers: dict[str, float]) -> Elasticity | None:
    if "youngs_modulus" not in numbers or "poissons_ratio" not in numbers:
        return None
    return Elasticity(youngs_modulus=numbers["youngs_modulus"], poissons_ratio=numbers["poissons_ratio"])


def _is_wall(name: str) -> bool:
    return name == WALLS or name in SIDES


def _group(name: str) -> str:
    return WALLS if name in SIDES else name
