"""Rules of the structure: material, shape, place and path."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from coupled.scene.refusal import Plain, missing, refusal
from coupled.scene.rules.loads import check_loads
from coupled.scene.rules.theory import check_theory
from coupled.scene.schemes import SCHEMES, Newmark
from coupled.scene.shape import Shape, Tube
from coupled.scene.structure import Structure

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

_Kind = Literal["elastic", "rigid", "free_rigid"]
_NEEDED: dict[_Kind, tuple[str, ...]] = {
    "elastic": ("density", "youngs_modulus", "poissons_ratio"),
    "rigid": ("path",),
    "free_rigid": ("density",),
}
_ALLOWED: dict[_Kind, tuple[str, ...]] = {
    "elastic": (*_NEEDED["elastic"], "theory", "rayleigh", *SCHEMES, "loads", "initial"),
    "rigid": ("path", "density"),
    "free_rigid": ("density", "loads"),
}
MOST_CELLS = 10_000_000  # a direct solver needs about 1 kB and more for each
LARGEST_WAY = 0.5  # of the smallest grain's radius in a step, as the watchdogs have it
_OPTIONAL = (*_ALLOWED["elastic"], "path")


def check_structure(scene: Scene) -> None:
    """Check that the structure is complete, has one shape, and stands inside the box."""
    structure = scene.structure
    if structure is None:
        return
    _check_kind(structure)
    _check_shape(structure)
    check_loads(structure)
    _check_one_scheme(structure)
    if structure.newmark is not None:
        _check_newmark(structure.newmark)
    check_theory(structure)
    if structure.path is not None:
        _check_path(structure.path.points)
        _check_speed(scene, structure.path.points)
    _check_placement(scene, structure)


def _check_kind(structure: Structure) -> None:
    kind = structure.kind
    for name in _NEEDED[kind]:
        if getattr(structure, name) is None:
            meaning = Structure.model_fields[name].description
            raise missing(f"structure.{name}", f'kind = "{kind}" needs it ({meaning}); add it')
    for name in _OPTIONAL:
        if name not in _ALLOWED[kind] and getattr(structure, name) not in (None, ()):
            value = getattr(structure, name)
            shown = value if isinstance(value, float | str) else Plain("...")
            raise refusal(
                f"structure.{name}",
                shown,
                f'means nothing for kind = "{kind}"; remove it or change structure.kind',
            )


def _check_shape(structure: Structure) -> None:
    tube, beam = structure.tube, structure.beam
    if tube is not None and beam is not None:
        raise refusal("structure.beam", {}, "is given together with structure.tube; keep one of them")
    if tube is None and beam is None:
        raise missing("structure.tube", "a structure needs a shape; add it or [structure.beam]")
    if tube is not None and tube.inner_radius >= tube.outer_radius:
        raise refusal(
            "structure.tube.inner_radius",
            tube.inner_radius,
            f"must be less than outer_radius = {tube.outer_radius:g} m; reduce it",
        )
    check_cells(structure.shape)


def check_cells(shape: Shape) -> None:
    """Refuse a mesh that no machine has the memory for, before its facets are counted."""
    name, many, few = ("tube", "around", "layers") if isinstance(shape, Tube) else ("beam", "along", "across")
    number, other = getattr(shape, many), getattr(shape, few)
    if number * other > MOST_CELLS:
        raise refusal(
            f"structure.{name}.{many}", number, f"times {few} = {other} is above {MOST_CELLS}; take fewer cells"
        )


def _check_one_scheme(structure: Structure) -> None:
    given = [name for name in SCHEMES if getattr(structure, name) is not None]
    if len(given) > 1:
        raise refusal(f"structure.{given[1]}", {}, f"is given together with structure.{given[0]}; keep one of them")


def _check_newmark(newmark: Newmark) -> None:
    beta, gamma = newmark.beta, newmark.gamma
    if gamma < 0.5:
        raise refusal("structure.newmark.gamma", gamma, "is unstable; give at least 0.5")
    least = (0.5 + gamma) ** 2 / 4
    if beta < least * (1.0 - 1e-12):  # (1.1)^2/4 is above 0.3025 by round-off
        raise refusal(
            "structure.newmark.beta",
            beta,
            f"is not unconditionally stable with gamma = {gamma:g}; give at least {least:g}",
        )


def _check_path(points: tuple[tuple[float, float, float], ...]) -> None:
    if points[0] != (0.0, 0.0, 0.0):
        raise refusal(
            "structure.path.points.0",
            list(points[0]),
            "does not start at time 0 without displacement; give [0.0, 0.0, 0.0]",
        )
    for index in range(1, len(points)):
        if points[index][0] <= points[index - 1][0]:
            raise refusal(
                f"structure.path.points.{index}",
                list(points[index]),
                f"must be later than {points[index - 1][0]:g} s; let the times increase",
            )


def _check_speed(scene: Scene, points: tuple[tuple[float, float, float], ...]) -> None:
    """Check that a prescribed path passes over no grain within a step; a step that is left open is checked later."""
    step, grains = scene.time.step, scene.first_grains
    if grains is None or scene.interface is None or isinstance(step, str):
        return
    largest, substeps = LARGEST_WAY * grains.smallest_radius, scene.interface.substeps
    for index in range(1, len(points)):
        time, *place = points[index]
        before, *start = points[index - 1]
        length = math.dist(place, start)
        way = min(length / substeps, length * step / (time - before))
        if way > largest:
            raise refusal(
                f"structure.path.points.{index}",
                list(points[index]),
                f"moves the structure by {way:.3g} m in a time step, more than {LARGEST_WAY:g} of the smallest grain's "
                f"radius, so that grains would be passed over; give this way at least {length * step / largest:.3g} s",
            )


def _check_placement(scene: Scene, structure: Structure) -> None:
    place, box = structure.placement, scene.box
    on_bed = place.y == "on_bed"
    floor = box is not None and "floor" in box.walls
    if on_bed and scene.grains is None and not floor:
        raise refusal("structure.placement.y", "on_bed", "needs grains or a floor below; give a number in m")
    if place.gap > 0 and not on_bed:
        raise refusal("structure.placement.gap", place.gap, 'only counts with y = "on_bed"; remove it')
    if box is None:
        return
    glued = _glued_radius(scene, structure)
    half_width, half_height = (extent + glued for extent in structure.shape.half_extent)
    points = structure.path.points if structure.path is not None else ((0.0, 0.0, 0.0),)
    spans = [("x", place.x, half_width, box.width, [row[1] for row in points])]
    if not isinstance(place.y, str):
        spans.append(("y", place.y, half_height, box.height, [row[2] for row in points]))
    for axis, centre, half, size, moves in spans:
        low, high = centre - half + min(moves), centre + half + max(moves)
        if low < 0 or high > size:
            raise refusal(
                f"structure.placement.{axis}",
                centre,
                f"lets the structure reach from {low:g} to {high:g} m, outside the box of "
                f"0 to {size:g} m; move it or enlarge the box",
            )


def _glued_radius(scene: Scene, structure: Structure) -> float:
    """Return the radius of a glued grain where it is given [m]."""
    interface = scene.interface
    if interface is None or interface.kind != "glued" or interface.diameter is None:
        return 0.0
    return interface.diameter / 2
