"""Turning one knob: the keys that a value of it sets in a scene."""

from __future__ import annotations

import math
from typing import TypeAlias

from coupled.scene import Scene
from coupled.scene.schemes import SCHEMES

Value: TypeAlias = float | int | str
Changes: TypeAlias = tuple[str, ...]

OF_AN_ELASTIC_BODY = ("youngs_modulus", "poissons_ratio", "element", "theory", "rayleigh", "initial", *SCHEMES)


def written(value: Value) -> str:
    """A value as an override takes it, with all digits."""
    return repr(float(value)) if isinstance(value, float) else str(value)


def set_key(key: str, value: Value) -> str:
    """One override."""
    return f"{key}={written(value)}"


def step(scene: Scene, factor: Value) -> Changes:
    """The grains' step, or the structure's where it stands alone, times a factor."""
    time = scene.time
    if time.step == "auto":
        return (set_key("time.safety", float(time.safety * factor)),)
    return (set_key("time.step", float(time.step * factor)),)


def mesh(scene: Scene, factor: Value) -> Changes:
    """Cells times a factor in both directions; glued grains keep their spacing as nearly as whole numbers allow."""
    shape = scene.structure.shape
    name, directions = ("tube", ("around", "layers")) if scene.structure.tube else ("beam", ("along", "across"))
    cells = {key: max(1, round(getattr(shape, key) * factor)) for key in directions}
    changes = tuple(set_key(f"structure.{name}.{key}", count) for key, count in cells.items())
    interface = scene.interface
    if interface is None or interface.per_facet is None:
        return changes
    return (*changes, *_spaced(scene, max(1, math.floor(interface.per_facet / factor + 0.5)), factor))


def glued(scene: Scene, factor: Value) -> Changes:
    """Glued grains per facet times a factor."""
    per_facet = scene.interface.per_facet
    return _spaced(scene, max(1, round(per_facet * factor)), 1.0)


def _spaced(scene: Scene, per_facet: int, finer: float) -> Changes:
    """Glued grains per facet, where facets are `finer` times as many; a diameter keeps its share of the spacing."""
    interface = scene.interface
    changes = (set_key("interface.per_facet", per_facet),)
    if interface.diameter is None:
        return changes
    spacing = interface.per_facet / (per_facet * finer)
    return (*changes, set_key("interface.diameter", interface.diameter * spacing))


def order(scene: Scene, value: Value) -> Changes:
    """Polynomial order; order 2 has standard cells only."""
    name = "tube" if scene.structure.tube else "beam"
    element = ("structure.element=standard",) if value == 2 else ()
    return (set_key(f"structure.{name}.order", value), *element)


def body(scene: Scene, value: Value) -> Changes:
    """A rigid body, or the theory of an elastic one."""
    if value == "rigid":
        gone = tuple(f"structure.{name}=absent" for name in OF_AN_ELASTIC_BODY)
        return ("structure.kind=free_rigid", *gone)
    element = ("structure.element=standard",) if value == "large_strain" else ()
    return (f"structure.theory={value}", *element)


def rolling(scene: Scene, value: Value) -> Changes:
    """Rolling resistance left out, or of another kind."""
    changes = []
    for path, table in scene.contact.tables():
        given = [name for name in table.numbers() if name.startswith("rolling")]
        changes += [f"{path}.{name}=absent" for name in given if value == "off" or name != "rolling_friction"]
    return (*changes, "contact.rolling=absent" if value == "off" else f"contact.rolling={value}")
