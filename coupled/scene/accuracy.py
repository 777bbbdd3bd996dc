"""Presets: how much accuracy a run is to have, as tables of keys.

A preset sets numerical keys alone, never the physics of a scene: friction, loads and material stay, and so do springs,
which scenes give as numbers of their own. Where a scene has nothing that a key acts on, the key is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, get_args

from pydantic import Field

from coupled.scene.grains import Grains
from coupled.scene.interface import RowUnder
from coupled.scene.types import Table

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

Accuracy = Literal["draft", "standard", "reference"]
NAMES: tuple[str, ...] = get_args(Accuracy)
MANY = 2000  # free grains from which on a bed is still one when a quarter of them is left
Keys = Mapping[str, Any]


class Preset(Table):
    """What a preset did to a scene; written where the scene is read, not by hand."""

    name: Accuracy = Field(description="the preset")
    gives: tuple[str, ...] = Field((), description="keys that it has set, with their values")
    by_hand: tuple[str, ...] = Field((), description="keys that it would have set, were they not written by hand")


@dataclass(frozen=True, kw_only=True)
class Group:
    """Keys that a preset sets together.

    Attributes
    ----------
    keys : mapping
        Values by dotted key.
    where : function
        Whether a scene, as it is without the preset, has something that they act on.
    rivals : tuple of str
        Keys that, written by hand, leave no place for the group.
    set_rivals : tuple of str
        Keys that do so if they come from ``--set``, but not if they stand in the file.
    drops : tuple of str
        Keys of the file that do not go with the group.
    """

    keys: Keys
    where: Callable[[Scene], bool]
    rivals: tuple[str, ...] = ()
    set_rivals: tuple[str, ...] = ()
    drops: tuple[str, ...] = ()


OTHER_STEPS = ("time.safety", "time.refinement")


def grain_step(fraction: float) -> Group:
    """The step as a share of the sharp limit, or of that of the coupling."""
    return Group(
        keys={"time.step": "auto", "time.step_fraction": fraction},
        where=lambda scene: scene.first_grains is not None and not _counts_steps(scene),
        rivals=("time.step", *OTHER_STEPS),
        drops=OTHER_STEPS,
    )


def structure_step(refinement: float, *, where: Callable[[Scene], bool]) -> Group:
    """The step of a scene without free grains."""
    return Group(
        keys={"time.refinement": refinement},
        where=lambda scene: scene.first_grains is None and where(scene),
        set_rivals=("time.step",),
    )


def coarse_grains(factor: float) -> tuple[Group, ...]:
    """Larger grains in a bed of many that stand for soil, and the step of that bed."""
    bed = Group(
        keys={"bed.time.step": "auto", "bed.time.step_fraction": DRAFT_STEP},
        where=lambda scene: scene.bed is not None and _many(scene),
        rivals=("grains.coarsening", "bed.time.step", *(f"bed.{key}" for key in OTHER_STEPS)),
        drops=tuple(f"bed.{key}" for key in OTHER_STEPS),
    )
    return Group(keys={"grains.coarsening": factor}, where=_many), bed


def mesh(refinement: float, *, where: Callable[[Scene], bool]) -> Group:
    """Cells of an elastic structure."""
    return Group(keys={"structure.refinement": refinement}, where=lambda scene: _elastic(scene) and where(scene))


def exchange(name: str) -> Group:
    """Exchange with a body that forces move."""
    of_iterated = () if name == "iterated" else ("interface.tolerance", "interface.iterations")

    def where(scene: Scene) -> bool:
        moved = scene.structure is not None and scene.structure.kind != "rigid"
        return moved and scene.interface is not None and scene.interface.exchange != name

    return Group(
        keys={"interface.exchange": name},
        where=where,
        rivals=of_iterated,
        drops=of_iterated,
    )


def _counts_steps(scene: Scene) -> bool:
    """Whether a number of steps is part of the scene."""
    return scene.shaking is not None and scene.shaking.period_steps is not None


def _many(scene: Scene) -> bool:
    """Whether the free grains are so many, and none of them told apart, that larger ones may stand for them."""
    table = scene.first_grains
    laid_out = isinstance(table, Grains) and table.layout == "lattice" and table.count >= MANY
    return laid_out and not scene.intruders


def _elastic(scene: Scene) -> bool:
    return scene.structure is not None and scene.structure.kind == "elastic"


def _alone(scene: Scene) -> bool:
    """Whether no coupling bounds the step of the structure."""
    return scene.interface is None


def _divides(factor: int) -> Callable[[Scene], bool]:
    """Whether a row under the structure keeps its springs when cells are that much smaller; true without a row."""

    def where(scene: Scene) -> bool:
        if scene.interface is None or not any(isinstance(row, RowUnder) for row in scene.rows):
            return True
        return scene.interface.grains_per_facet(scene.structure.shape) % factor == 0

    return where


def _only(first: int, second: int) -> Callable[[Scene], bool]:
    """Whether the second factor keeps the springs of a row, and the first does not."""
    return lambda scene: _divides(second)(scene) and not _divides(first)(scene)


AS_WRITTEN_GRAINS = Group(
    keys={"grains.coarsening": 1.0},
    where=lambda scene: scene.grains is not None and scene.grains.coarsening is not None,
)
AS_WRITTEN_MESH = Group(
    keys={"structure.refinement": 1.0},
    where=lambda scene: scene.structure is not None and scene.structure.refinement is not None,
)
DRAFT_STEP, REFERENCE_STEP = 0.9, 0.25  # of the sharp limit
PRESETS: dict[str, tuple[Group, ...]] = {
    "draft": (
        grain_step(DRAFT_STEP),
        *coarse_grains(2.0),
        structure_step(0.5, where=_alone),
        exchange("predicted"),
    ),
    # the scene as it is, whatever its file asks for
    "standard": (
        AS_WRITTEN_GRAINS,
        AS_WRITTEN_MESH,
    ),
    "reference": (
        grain_step(REFERENCE_STEP),
        AS_WRITTEN_GRAINS,
        structure_step(4.0, where=lambda scene: True),
        mesh(2.0, where=_divides(2)),
        mesh(3.0, where=_only(2, 3)),
        exchange("iterated"),
    ),
}
