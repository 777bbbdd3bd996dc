"""Rules of the free grains, their box and their bed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coupled.scene.grains import Box, Grains
from coupled.scene.intruders import Intruder
from coupled.scene.refusal import Plain, missing, refusal

if TYPE_CHECKING:
    from coupled.scene.scene import Scene


def check_grains(scene: Scene) -> None:
    """Check that the grains fit their box, or that their bed can serve them."""
    if scene.box is not None and len(set(scene.box.walls)) < len(scene.box.walls):
        raise refusal("box.walls", list(scene.box.walls), "names a wall twice; name each once")
    if isinstance(scene.grains, Grains):
        if scene.bed is not None:
            raise refusal("bed", {}, "needs grains.bed; give that name or remove [bed]")
        _check_laid_out(scene.grains, scene.box, scene.intruders)
    elif scene.grains is not None:
        _check_bed(scene, scene.grains.bed)
    elif scene.bed is not None:
        raise refusal("bed", {}, "serves no grains; add [grains] with bed, or remove [bed]")


def _check_laid_out(grains: Grains, box: Box | None, intruders: tuple[Intruder, ...]) -> None:
    if grains.layout == "list":
        _check_positions(grains, box)
        return
    if grains.positions:
        raise refusal(
            "grains.positions",
            Plain("[...]"),
            'belongs to layout = "list"; remove it or set the layout',
        )
    if box is None:
        raise missing("box", "grains on a lattice need its width and height; add [box]")
    _check_size(grains, box)
    capacity = grains.lattice_capacity(box, intruders)
    if grains.count > capacity:
        raise refusal(
            "grains.sizes",
            Plain(f"{grains.count} grains"),
            f"are more than the {capacity} that the lattice holds in the box of {box.width:g} x "
            f"{box.height:g} m; enlarge box.height or take fewer or smaller grains",
        )


def _check_size(grains: Grains, box: Box) -> None:
    for index, size in enumerate(grains.sizes):
        if 2 * size.largest > min(box.width, box.height):
            raise refusal(
                f"grains.sizes.{index}.radius",
                size.radius,
                f"is larger than the box of {box.width:g} x {box.height:g} m; reduce the radius or enlarge the box",
            )


def _check_positions(grains: Grains, box: Box | None) -> None:
    if len(grains.positions) != grains.count:
        raise refusal(
            "grains.positions",
            Plain(f"{len(grains.positions)} rows"),
            f"do not match the {grains.count} grains of grains.sizes; give one row for each",
        )
    if box is None:
        return
    _check_size(grains, box)
    radii = [size.smallest for size in grains.sizes for _ in range(size.count)]
    margin_x, margin_y = (0.0 if axis in box.periodic else 1.0 for axis in "xy")
    for index, (row, radius) in enumerate(zip(grains.positions, radii, strict=True)):
        x, y = row[:2]
        left, below = margin_x * radius, margin_y * radius
        if not (left <= x <= box.width - left and below <= y <= box.height - below):
            raise refusal(
                f"grains.positions.{index}",
                list(row),
                f"puts a grain of radius {radius:g} m outside the box of {box.width:g} x {box.height:g} m; move it in",
            )


def _check_bed(scene: Scene, name: str) -> None:
    bed = scene.bed
    if bed is None:
        raise missing("bed", f'the scene "{name}" that settles the grains; load it from its file')
    if bed.grains is None or bed.structure is not None or bed.rows or bed.shaking is not None:
        raise refusal(
            "grains.bed",
            name,
            "is no bed, which settles free grains and nothing else; name a scene with [grains] and "
            "without [structure], [[rows]] and [shaking]",
        )
    if bed.units != scene.units:
        raise refusal("units", scene.units, f'differs from the bed\'s "{bed.units}"; use the same')
    own, settled = scene.box, bed.box
    if own and settled and own.period != settled.period:
        raise refusal(
            "box.periodic",
            list(own.periodic),
            "repeats otherwise than the bed's box; remove [box] to take the bed's",
        )
    if own and settled and own.width < settled.width:
        raise refusal(
            "box.width",
            own.width,
            f"is narrower than the bed's {settled.width:g} m, so grains would lie outside; widen "
            "it or remove [box] to take the bed's",
        )
