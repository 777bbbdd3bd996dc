"""The knobs of a scene."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from coupled.errors import LeitoError
from coupled.scene import RowUnder, Scene
from coupled.scene.refusal import nearest
from coupled.study.settings import turns
from coupled.study.settings.knob import Knob
from coupled.study.settings.turns import Changes, Value, set_key

CELLS = {1: (2.0,), 2: (4.0, 3.0)}  # factors by level: a row of springs may divide by 3 alone
OPEN_STEP = 0.0  # the fraction of a step that is given as a number: none of those that are tried


def _has_grains(scene: Scene) -> bool:
    return scene.grains is not None


def _elastic(scene: Scene) -> bool:
    return scene.structure is not None and scene.structure.kind == "elastic"


def _own_body(scene: Scene) -> Value | None:
    """Rigid paths and released modes have one theory only."""
    if not _elastic(scene) or scene.structure.initial is not None:
        return None
    return scene.structure.theory


def _own_element(scene: Scene) -> Value | None:
    if not _elastic(scene) or scene.structure.shape.order != 1 or scene.structure.shape.cell != "quadrilateral":
        return None
    return None if scene.structure.theory == "large_strain" else scene.structure.element


def _own_rolling(scene: Scene) -> Value | None:
    if scene.contact is None or not scene.contact.rolls or not _has_grains(scene):
        return None
    return scene.contact.rolling or "elastic_plastic"


def _own_glued(scene: Scene) -> Value | None:
    """Glued grains above a row under them are its springs, and belong to the case."""
    interface = scene.interface
    if any(isinstance(row, RowUnder) for row in scene.rows):
        return None
    glued = interface is not None and interface.kind == "glued" and interface.per_facet is not None
    return 1.0 if glued else None


def _set(key: str) -> Callable[[Scene, Value], Changes]:
    """A knob that is one key."""

    def turn(scene: Scene, value: Value) -> Changes:
        return (set_key(key, value),)

    return turn


KNOBS: tuple[Knob, ...] = (
    Knob(
        name="step",
        meaning="time step over that of the scene",
        values=(4.0, 2.0, 0.5),
        own=lambda scene: 1.0,
        turn=turns.step,
        refine=lambda scene, level: (turns.step(scene, 0.5**level),),
        falls=True,
        sets_step=True,
        usual=lambda scene: not _has_grains(scene),
    ),
    Knob(
        name="fraction",
        meaning="time step over the sharp limit of grains and coupling",
        values=(0.9, 0.6, 0.3),
        own=lambda scene: (scene.time.step_fraction or OPEN_STEP) if _has_grains(scene) else None,
        turn=turns.fraction,
        falls=True,
        sets_step=True,
    ),
    Knob(
        name="integrator",
        meaning="scheme of the grains",
        values=("leapfrog", "velocity_verlet"),
        own=lambda scene: scene.time.integrator if _has_grains(scene) else None,
        turn=_set("time.integrator"),
    ),
    Knob(
        name="coarsening",
        meaning="size of the grains over that of the scene",
        values=(3.0, 2.0, 1.5),
        own=lambda scene: 1.0 if scene.first_grains is not None and scene.first_grains.layout == "lattice" else None,
        turn=turns.coarsening,
        falls=True,
    ),
    Knob(
        name="stiffness",
        meaning="contact springs over those of the scene",
        values=(0.1, 0.3, 3.0),
        own=lambda scene: 1.0 if _has_grains(scene) and scene.contact is not None else None,
        turn=turns.stiffness,
    ),
    Knob(
        name="substeps",
        meaning="grain steps per step of the structure",
        values=(20, 10, 5, 2, 1),
        own=lambda scene: scene.interface.substeps if scene.interface and _has_grains(scene) else None,
        turn=_set("interface.substeps"),
        falls=True,
        sets_step=True,
    ),
    Knob(
        name="mesh",
        meaning="cells in each direction over those of the scene",
        values=(0.5, 2.0),
        own=lambda scene: 1.0 if _elastic(scene) else None,
        turn=turns.mesh,
        refine=lambda scene, level: tuple(turns.mesh(scene, factor) for factor in CELLS[level]),
    ),
    Knob(
        name="order",
        meaning="polynomial order of the elements",
        values=(1, 2),
        own=lambda scene: scene.structure.shape.order if _elastic(scene) else None,
        turn=turns.order,
    ),
    Knob(
        name="element",
        meaning="formulation of the elements",
        values=("standard", "enhanced"),
        own=_own_element,
        turn=_set("structure.element"),
    ),
    Knob(
        name="body",
        meaning="rigid body, or theory of an elastic one",
        values=("rigid", "linear", "corotational", "large_strain"),
        own=_own_body,
        turn=turns.body,
    ),
    Knob(
        name="interface",
        meaning="what grains meet",
        values=("glued", "facets"),
        own=lambda scene: scene.interface.kind if scene.interface else None,
        turn=_set("interface.kind"),
    ),
    Knob(
        name="glued",
        meaning="glued grains per facet over those of the scene",
        values=(0.5, 2.0),
        own=_own_glued,
        turn=turns.glued,
    ),
    Knob(
        name="exchange",
        meaning="order of the exchange",
        values=("lagged", "predicted", "iterated"),
        own=lambda scene: scene.interface.exchange if scene.interface and scene.structure.kind != "rigid" else None,
        turn=_set("interface.exchange"),
    ),
    Knob(
        name="rolling",
        meaning="rolling resistance of the grains",
        values=("off", "constant_torque", "elastic_plastic"),
        own=_own_rolling,
        turn=turns.rolling,
    ),
    Knob(
        name="precision",
        meaning="stored state of the grains",
        values=("float32", "float64"),
        own=lambda scene: scene.grains.precision if _has_grains(scene) else None,
        turn=_set("grains.precision"),
    ),
    Knob(
        name="skin",
        meaning="reach of the contact lists over what the program chooses",
        values=(0.5, 2.0),
        own=lambda scene: scene.grains.skin_factor if _has_grains(scene) else None,
        turn=_set("grains.skin_factor"),
        speed_only=True,
    ),
    Knob(
        name="threads",
        meaning="threads of the grains",
        values=(2, 1),
        own=lambda scene: 1 if _has_grains(scene) else None,
        turn=lambda scene, value: (),
        threads=True,
        speed_only=True,
    ),
)
BY_NAME = {knob.name: knob for knob in KNOBS}


def knobs_of(scene: Scene, wanted: Iterable[str] | None = None) -> list[Knob]:
    """The knobs of a scene that are turned where nobody names any, or those wanted.

    Raises
    ------
    LeitoError
        If a wanted one is unknown, or this scene does not have it.
    """
    there = [knob for knob in KNOBS if knob.own(scene) is not None]
    if wanted is None:
        return [knob for knob in there if knob.usual(scene)]
    names = list(dict.fromkeys(wanted))
    for name in names:
        if name not in BY_NAME:
            raise LeitoError(f"--knobs {name}: there is no such knob; {nearest(name, BY_NAME)}")
        if BY_NAME[name] not in there:
            has = ", ".join(knob.name for knob in there)
            raise LeitoError(
                f"--knobs {name}: this scene has no {name} to turn ({BY_NAME[name].meaning}); it has {has}"
            )
    return [knob for knob in there if knob.name in names]


def refined_together(scene: Scene) -> list[Knob]:
    """The knobs of a scene that the reference refines."""
    return [knob for knob in KNOBS if knob.own(scene) is not None and knob.refine is not None]


def values_of(knob: Knob, scene: Scene, asked: Mapping[str, tuple[Value, ...]]) -> list[Value]:
    """Values of a knob to try beside the scene's own one."""
    values = asked.get(knob.name, knob.values)
    return [value for value in dict.fromkeys(values) if value != knob.own(scene)]
