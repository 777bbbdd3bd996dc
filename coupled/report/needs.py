"""What a scene models without need: features that change nothing of its result, and what they cost."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import NamedTuple

from coupled.bodies import stable_ratio
from coupled.build import Built
from coupled.laws import interface_spring
from coupled.report import modelled as m
from coupled.report.shares import FRAMES
from coupled.report.strain import Estimate, estimate
from coupled.scene import Scene
from coupled.scene.grains import Grains

ROUND_OFF = sys.float_info.epsilon
RIGID = 1e-6  # of a contact's overlap: what the structure may deform and still be as good as rigid
SMALL_STRAIN = 1e-3  # below it small-strain theory is right to a thousandth
CALM = 0.3  # of the limit of the plain exchange: below it nothing needs to be iterated
STRESSES = ("max_von_mises", "max_strain", "structure_strain")  # columns that only an elastic body has


class Needless(NamedTuple):
    """A key, why it changes nothing and what to do, and the feature whose share it has."""

    key: str
    why: str
    feature: str | None = None


def without_need(asked: Scene, built: Built) -> list[Needless]:
    """All findings; `asked` is the scene as it was read, which knows the keys that were written."""
    finders: tuple[Callable[[Scene, Built], Iterator[Needless]], ...] = (
        _contact, _motion, _walls, _gravity, _interface, _structure, _output,
    )  # fmt: skip
    return [found for finder in finders for found in finder(asked, built)]


def _contact(scene: Scene, built: Built) -> Iterator[Needless]:
    """Laws with zeros for numbers, and pairs that say what all others do."""
    contact = scene.contact
    if contact is None:
        return
    tables = [table for _, table in contact.tables()]
    if contact.rubs and not any(table.friction for table in tables):
        remedy = "its springs and spins act on nothing: remove the tangential keys"
        yield Needless("contact.friction", f"is 0 everywhere; {remedy}", m.FRICTION)
    if contact.rolls and not any(table.rolling_friction for table in tables):
        yield Needless("contact.rolling_friction", "is 0 everywhere; remove the rolling keys", m.ROLLING)
    usual = contact.numbers()
    for index, pair in enumerate(contact.pairs):
        if not contact.materials and all(usual.get(name) == value for name, value in pair.numbers().items()):
            yield Needless(f"contact.pairs.{index}", "says what [contact] says; remove it", m.MATERIALS)


def _motion(scene: Scene, built: Built) -> Iterator[Needless]:
    """Damping of nothing, and an integrator whose difference nothing sees."""
    damping = scene.damping
    if damping is not None and not (damping.translational or damping.rotational):
        yield Needless("damping", "has two zeros; remove the table", m.DAMPING)
    spins = scene.contact is not None and scene.contact.rubs
    if damping is not None and damping.rotational and not spins:
        yield Needless("damping.rotational", "damps spins that no scene without friction has; remove it", m.DAMPING)
    if m.VERLET in m.models(scene) and not _dissipates(scene):
        why = "differs from the leapfrog in what dashpots see, and there is none; remove the key"
        yield Needless("time.integrator", why, m.VERLET)


def _dissipates(scene: Scene) -> bool:
    """Whether anything depends on a velocity: dashpots of the contacts, or drag."""
    if scene.damping is not None and (scene.damping.translational or scene.damping.rotational):
        return True
    contact = scene.contact
    if contact is None:
        return False
    if contact.recipe is not None or contact.rolling == "constant_torque":
        return True
    names = ("normal_damping", "tangential_damping", "tangential_damping_ratio", "rolling_damping_ratio")
    tables = [table for _, table in contact.tables()]
    if any(getattr(table, name) for table in tables for name in names):
        return True
    return any(table.restitution not in (None, 1.0) for table in tables)


def _walls(scene: Scene, built: Built) -> Iterator[Needless]:
    """Walls that nobody can meet."""
    box = scene.box
    if box is None or not box.walls:
        return
    if scene.first_grains is None:
        yield Needless("box.walls", "meet free grains alone, and there are none; remove [box]", m.WALLS)
    elif "lid" in box.walls and _stays_below_the_lid(scene):
        why = 'has a lid, and grains start at rest below it and fall: only others can throw one so high; take out "lid"'
        yield Needless("box.walls", why, m.WALLS)


def _stays_below_the_lid(scene: Scene) -> bool:
    """Whether nothing lifts grains: all start at rest below the lid and gravity pulls down."""
    still = isinstance(scene.grains, Grains) and not any(any(row[2:]) for row in scene.grains.positions)
    pushed = scene.structure is not None or scene.rows or scene.intruders or scene.shaking is not None
    return still and not pushed and scene.gravity[0] == 0.0 and scene.gravity[1] < 0.0


def _gravity(scene: Scene, built: Built) -> Iterator[Needless]:
    if any(scene.gravity) and scene.first_grains is None:
        why = "acts on free grains, and there are none; a structure's own weight is a load of kind body; remove it"
        yield Needless("gravity", why)


def _interface(scene: Scene, built: Built) -> Iterator[Needless]:
    """An interface that meets nothing on its path, and iterations that a calm exchange does not need."""
    table = scene.interface
    if table is None:
        return
    if _out_of_reach(scene, built):
        why = "stays above all grains on the whole path of the structure: they never meet; remove it, or lower the path"
        yield Needless("interface", why, m.interface_name(scene))
    if table.exchange == "iterated":
        plain = scene.model_copy(update={"interface": table.model_copy(update={"exchange": "predicted"})})
        if built.stiffness_ratio < CALM * stable_ratio(plain):
            why = (
                f'= "iterated" runs each window two times and more, and r = {built.stiffness_ratio:.3g} is far below '
                f'{stable_ratio(plain):.3g}, where "predicted" is stable'
            )
            yield Needless("interface.exchange", why, m.FREE_GRAINS if scene.grains is not None else None)


def _out_of_reach(scene: Scene, built: Built) -> bool:
    """Whether a body on a path stays above grains that can only fall."""
    system, body = built.model.particles, scene.structure
    if system is None or body.path is None or scene.rows or scene.intruders or scene.shaking is not None:
        return False
    if not (scene.gravity[0] == 0.0 and scene.gravity[1] <= 0.0):
        return False
    grains, n = system.grains, system.grains.n_free
    if n == 0 or grains.vx[:n].any() or grains.vy[:n].max() > 0.0:
        return False
    drop = min(point[2] for point in body.path.points)
    lowest = float(built.model.structure.polyline.points[:, 1].min()) + drop
    thick = built.model.interface.radius
    return lowest - (thick if thick < float("inf") else 0.0) > float((grains.y[:n] + grains.radius[:n]).max())


def _structure(scene: Scene, built: Built) -> Iterator[Needless]:
    """Loads and damping of zero, strain that nobody sees, a theory for strain that never comes."""
    body = scene.structure
    if body is None:
        return
    if body.rayleigh is not None and not (body.rayleigh.mass_factor or body.rayleigh.stiffness_factor):
        yield Needless("structure.rayleigh", "has two zeros; remove the table")
    name = m.structure_name(scene)
    found = estimate(scene)
    if found is None:
        return
    if body.theory == "large_strain" and found.strain < SMALL_STRAIN:
        why = (
            f'= "large_strain" is for strains that the loads of this scene do not make (about {found.strain:.2g}); '
            '"corotational" turns with the body as well and is cheaper'
        )
        yield Needless("structure.theory", why, name)
    if any(getattr(quantity, "column", None) in STRESSES for quantity in scene.quantities):
        return
    if _invisible(scene, built, found):
        remedy = 'kind = "free_rigid" (or "rigid") does'
        why = f"= elastic, but its strain stays below {found.strain:.2g} and {_in_words(scene, built, found)}; {remedy}"
        yield Needless("structure.kind", why, name)


def _invisible(scene: Scene, built: Built, found: Estimate) -> bool:
    return found.deflection <= max(_round_off(built), RIGID * _overlap(scene, built, found))


def _round_off(built: Built) -> float:
    """Of the coordinates of the structure [m]."""
    return ROUND_OFF * float(abs(built.model.structure.polyline.points).max())


def _overlap(scene: Scene, built: Built, found: Estimate) -> float:
    """Overlap of one contact that carries the whole force [m]; 0 without grains."""
    system = built.model.particles
    if system is None or scene.interface is None:
        return 0.0
    stiffness = interface_spring(scene, built.contact, system.grains, built.model.interface.radius)[0]
    return found.force / stiffness


def _in_words(scene: Scene, built: Built, found: Estimate) -> str:
    if found.deflection <= _round_off(built):
        return f"moves its faces by {found.deflection:.2g} m, below the round-off of their places"
    share = found.deflection / _overlap(scene, built, found)
    return f"bends it by {share:.1g} of the overlap of a contact with the same force"


def _output(scene: Scene, built: Built) -> Iterator[Needless]:
    """Frames that nobody asked for."""
    output = scene.output
    if output.frames_per_second > 0.0 and "frames_per_second" not in output.model_fields_set:
        why = f"= {output.frames_per_second:g} is the default, the scene does not ask for frames; 0 writes none"
        yield Needless("output.frames_per_second", why, FRAMES)
