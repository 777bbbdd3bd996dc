"""Rules of the intruders and of the periodic sides."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

from coupled.scene.grains import ACROSS, SettledGrains
from coupled.scene.intruders import MIDDLE
from coupled.scene.refusal import missing, refusal

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

LEAST_RADII = 5.0  # in a period, `particles.periodic`


def check_intruders(scene: Scene) -> None:
    """Check that intruders lie among grains, inside the box and apart."""
    if not scene.intruders:
        return
    if scene.grains is None:
        raise refusal("intruders", [], "lie among free grains, and there are none; add [grains]")
    if isinstance(scene.grains, SettledGrains):
        if scene.bed is not None and scene.intruders != scene.bed.intruders:
            raise refusal("intruders", [], "differ from those that have settled with the bed; change bed.intruders")
        return
    if scene.box is None:
        raise missing("box", "intruders need its width and height; add [box]")
    box = scene.box
    for index, intruder in enumerate(scene.intruders):
        for axis, size in (("x", box.width), ("y", box.height)):
            value, margin = getattr(intruder, axis), 0.0 if axis in box.periodic else intruder.radius
            if 2.0 * intruder.radius > size:
                raise refusal(
                    f"intruders.{index}.radius",
                    intruder.radius,
                    f"is larger than the box of {box.width:g} x {box.height:g} m; reduce it or enlarge the box",
                )
            if value != MIDDLE and not margin <= value <= size - margin:
                raise refusal(
                    f"intruders.{index}.{axis}",
                    value,
                    f"puts it outside the box of 0 to {size:g} m; move it in",
                )
    _check_apart(scene)


def _check_apart(scene: Scene) -> None:
    for (i, a), (j, b) in combinations(enumerate(scene.intruders), 2):
        apart = math.inf
        if (a.x == MIDDLE) == (b.x == MIDDLE) and (a.y == MIDDLE) == (b.y == MIDDLE):
            dx = 0.0 if a.x == MIDDLE else a.x - b.x
            dy = 0.0 if a.y == MIDDLE else a.y - b.y
            apart = math.hypot(dx, dy)
        if apart < a.radius + b.radius:
            raise refusal(f"intruders.{j}", {}, f"overlaps intruders.{i}, {apart:g} m away; give it another x or y")


def check_periodic(scene: Scene) -> None:
    """Check the sides of the box that repeat."""
    box = scene.box
    if box is None or not box.periodic:
        return
    if len(set(box.periodic)) < len(box.periodic):
        raise refusal("box.periodic", list(box.periodic), "names an axis twice; name each once")
    for axis in box.periodic:
        for wall in ACROSS[axis]:
            if wall in box.walls:
                raise refusal(
                    "box.walls", list(box.walls), f"has {wall!r} across the periodic axis {axis}; keep one of them"
                )
    if scene.structure is not None:
        raise refusal(
            "box.periodic", list(box.periodic), "does not go together with a structure; remove it or [structure]"
        )
    if scene.first_grains is None:
        return
    largest = max([scene.first_grains.largest_radius, *(intruder.radius for intruder in scene.intruders)])
    for axis, length in zip("xy", box.period, strict=True):
        if length is not None and length < LEAST_RADII * largest:
            raise refusal(
                "box.width" if axis == "x" else "box.height",
                length,
                f"is the period in {axis} and must be at least {LEAST_RADII:g} of the largest radii, "
                f"{LEAST_RADII * largest:g} m; widen it",
            )
