"""Rules of the intruders and of the periodic sides."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING

from coupled.scene.grains import ACROSS, Box, Grains, SettledGrains
from coupled.scene.intruders import MIDDLE
from coupled.scene.places import places_of
from coupled.scene.refusal import missing, refusal

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

LEAST_RADII = 5.0  # in a period, `particles.periodic`


def check_intruder_sizes(scene: Scene) -> None:
    """Check that intruders are no larger than the box, before grains are sought a place beside them."""
    box = scene.box
    for index, intruder in enumerate(scene.intruders if box is not None else ()):
        if 2.0 * intruder.radius > min(box.width, box.height):
            raise refusal(
                f"intruders.{index}.radius",
                intruder.radius,
                f"is larger than the box of {box.width:g} x {box.height:g} m; reduce it or enlarge the box",
            )


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
            if value != MIDDLE and not margin <= value <= size - margin:
                raise refusal(
                    f"intruders.{index}.{axis}",
                    value,
                    f"puts it outside the box of 0 to {size:g} m; move it in",
                )
    _check_apart(scene)


def _check_apart(scene: Scene) -> None:
    """Check that intruders overlap neither each other nor, in a list, other grains."""
    grains, box = scene.grains, scene.box
    assert isinstance(grains, Grains) and box is not None, "the rules before have seen to it"
    places = places_of(scene.intruders, grains, box)
    for (i, a), (j, b) in combinations(enumerate(scene.intruders), 2):
        apart = _apart(places[i], places[j], box)
        if apart < a.radius + b.radius:
            raise refusal(f"intruders.{j}", {}, f"overlaps intruders.{i}, {apart:g} m away; give it another x or y")
    if grains.layout != "list":
        return
    radii = [size.smallest for size in grains.sizes for _ in range(size.count)]
    for j, b in enumerate(scene.intruders):
        for i, (row, radius) in enumerate(zip(grains.positions, radii, strict=True)):
            apart = _apart(row, places[j], box)
            if apart < radius + b.radius:
                raise refusal(
                    f"intruders.{j}",
                    {},
                    f"overlaps the grain of grains.positions.{i}, {apart:g} m away; give it another x or y",
                )


def _apart(one: Sequence[float], other: Sequence[float], box: Box) -> float:
    """Distance of two centres [m], to the nearest image."""
    gaps = (one[0] - other[0], one[1] - other[1])
    near = [
        gap if length is None else gap - length * round(gap / length)
        for gap, length in zip(gaps, box.period, strict=True)
    ]
    return math.hypot(*near)


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
