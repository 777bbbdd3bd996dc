"""Turning one knob: the keys that a value of it sets in a scene."""

from __future__ import annotations

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
    """The step times a factor, however it is chosen."""
    time = scene.time
    if time.step != "auto":
        return (set_key("time.refinement", (time.refinement or 1.0) / factor),)
    if time.step_fraction is not None:
        return (set_key("time.step_fraction", min(1.0, time.step_fraction * factor)),)
    return (set_key("time.safety", min(1.0, time.safety * factor)),)


def fraction(scene: Scene, value: Value) -> Changes:
    """The step as a fraction of the sharp limit of grains and coupling."""
    return ("time.step=auto", "time.safety=absent", "time.refinement=absent", set_key("time.step_fraction", value))


def coarsening(scene: Scene, value: Value) -> Changes:
    """Grains as many times as large; a given step grows with the root of their mass."""
    key = set_key("grains.coarsening", value * (scene.grains.coarsening or 1.0))
    return (key, *_longer(scene, value))


def stiffness(scene: Scene, value: Value) -> Changes:
    """Springs times a factor; a given step falls with its root."""
    key = set_key("contact.stiffness_factor", value * (scene.contact.stiffness_factor or 1.0))
    return (key, *_longer(scene, float(value) ** -0.5))


def _longer(scene: Scene, factor: Value) -> Changes:
    """A given step times a factor; one that is left to the model follows by itself."""
    return () if scene.time.step == "auto" else step(scene, factor)


def mesh(scene: Scene, factor: Value) -> Changes:
    """Cells times a factor in both directions."""
    return (set_key("structure.refinement", (scene.structure.refinement or 1.0) * factor),)


def glued(scene: Scene, factor: Value) -> Changes:
    """Glued grains per facet times a factor; a diameter that is given keeps its share of their spacing."""
    interface = scene.interface
    per_facet = max(1, round(interface.per_facet * factor))
    changes = (set_key("interface.per_facet", per_facet),)
    if interface.diameter is None:
        return changes
    return (*changes, set_key("interface.diameter", interface.diameter * interface.per_facet / per_facet))


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
