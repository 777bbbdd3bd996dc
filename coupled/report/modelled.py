"""What a scene models and what it leaves out, in words."""

from __future__ import annotations

from coupled.scene import Scene

FREE_GRAINS, FRICTION, ROLLING, DAMPING = "free grains", "friction", "rolling resistance", "global damping"
WALLS, PERIODIC, SHAKING, ROWS, GRAVITY = "walls", "periodic sides", "shaken walls", "rows of grains", "gravity"
HERTZ, FOLLOWING, MATERIALS = "Hertz's spring", "a tangential spring that follows the normal one", "materials"
VERLET, INTRUDERS, STRUCTURE = "velocity Verlet", "intruders", "structure"

_OF_CONTACTS = (HERTZ, FRICTION, FOLLOWING, ROLLING, MATERIALS)
_OF_GRAINS = (DAMPING, WALLS, PERIODIC, SHAKING, GRAVITY, VERLET, INTRUDERS)


def models(scene: Scene) -> list[str]:
    """The features that a scene names; whatever it does not name is not computed."""
    return [name for name, wanted in _features(scene).items() if wanted] + _of_structure(scene)


def leaves_out(scene: Scene) -> list[str]:
    """The features that it could have beside those it has."""
    senseless = set() if scene.contact is not None else set(_OF_CONTACTS)
    if scene.grains is None:
        senseless |= set(_OF_GRAINS)
    out = [name for name, wanted in _features(scene).items() if not wanted and name not in senseless]
    return out + ([] if scene.structure is not None else [STRUCTURE])


def structure_name(scene: Scene) -> str:
    """How the structure of a scene is called."""
    return f"{scene.structure.kind} structure"


def interface_name(scene: Scene) -> str:
    """How its interface is called."""
    return f"{scene.interface.kind} interface"


def _features(scene: Scene) -> dict[str, bool]:
    contact, box = scene.contact, scene.box
    rubs = contact is not None and contact.rubs
    return {
        FREE_GRAINS: scene.grains is not None,
        HERTZ: contact is not None and contact.normal == "hertz",
        FRICTION: rubs,
        FOLLOWING: rubs and contact.follows_normal,
        ROLLING: contact is not None and contact.rolls,
        MATERIALS: contact is not None and bool(contact.pairs or contact.materials),
        DAMPING: scene.damping is not None,
        VERLET: scene.grains is not None and scene.time.integrator == "velocity_verlet",
        WALLS: box is not None and bool(box.walls),
        PERIODIC: box is not None and bool(box.periodic),
        SHAKING: scene.shaking is not None,
        INTRUDERS: bool(scene.intruders),
        ROWS: bool(scene.rows),
        GRAVITY: any(scene.gravity),
    }


def _of_structure(scene: Scene) -> list[str]:
    if scene.structure is None:
        return []
    found = [structure_name(scene)]
    if scene.structure.theory is not None:
        found.append(f"{scene.structure.theory.replace('_', '-')} theory")
    return found + ([interface_name(scene)] if scene.interface is not None else [])
