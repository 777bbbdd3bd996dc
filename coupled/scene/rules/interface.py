"""Rules of the interface and of the rows of fixed grains."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coupled.scene.interface import Interface, RowUnder
from coupled.scene.refusal import missing, nearest, refusal
from coupled.scene.shape import Shape

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

LOOSEST_TOLERANCE = 1e-2  # what the predicted exchange misses of the boundary's motion in a step
FEWEST_ITERATIONS = 3


def check_interface(scene: Scene) -> None:
    """Check the interface against the shape that carries it."""
    interface, structure = scene.interface, scene.structure
    if interface is None or structure is None:
        return
    if scene.grains is None and not scene.rows:
        raise refusal(
            "interface",
            {},
            "has nothing to touch, as walls meet free grains alone; add [grains] or [[rows]]",
        )
    shape = structure.shape
    _check_boundaries(interface, shape)
    _check_iteration(interface)
    if interface.kind == "facets" and interface.velocity == "mean":
        raise refusal(
            "interface.velocity",
            "mean",
            'is that of glued grains, facets move with both nodes; remove it or say kind = "glued"',
        )
    if interface.kind == "glued" or interface.per_facet is not None or interface.count is not None:
        _check_number(interface, shape)
    if interface.kind == "glued" and interface.diameter is not None:
        spacing = interface.smallest_spacing(shape)
        # one part in 1e9: a diameter of exactly the spacing may be written with rounding
        if interface.diameter > spacing * (1 + 1e-9):
            raise refusal(
                "interface.diameter",
                interface.diameter,
                f"makes glued grains overlap, {spacing:.6g} m apart; give at most that, or fewer per facet",
            )


def _check_iteration(interface: Interface) -> None:
    for key in ("tolerance", "iterations"):
        value = getattr(interface, key)
        if value is not None and interface.exchange != "iterated":
            raise refusal(
                f"interface.{key}", value, 'is that of the iterated exchange; remove it or say exchange = "iterated"'
            )
    if interface.tolerance is not None and interface.tolerance > LOOSEST_TOLERANCE:
        raise refusal(
            "interface.tolerance",
            interface.tolerance,
            f'is above {LOOSEST_TOLERANCE:g}, more than the exchange gains; give less, or exchange = "predicted"',
        )
    if interface.iterations is not None and interface.iterations < FEWEST_ITERATIONS:
        raise refusal(
            "interface.iterations",
            interface.iterations,
            f"is too few: most windows need two; give at least {FEWEST_ITERATIONS}",
        )


def _check_boundaries(interface: Interface, shape: Shape) -> None:
    names = interface.boundaries
    for index, name in enumerate(names):
        if name not in shape.glueable:
            raise refusal(
                f"interface.boundaries.{index}",
                name,
                f"is no outer boundary of the shape; {nearest(name, shape.glueable)}",
            )
    if len(set(names)) < len(names) or ("outer" in names and len(names) > 1):
        raise refusal(
            "interface.boundaries",
            list(names),
            'names a boundary twice ("outer" is all of them); name each once',
        )


def _check_number(interface: Interface, shape: Shape) -> None:
    per_facet, count = interface.per_facet, interface.count
    if per_facet is not None and count is not None:
        raise refusal("interface.count", count, f"is given together with per_facet = {per_facet}; keep one")
    if count is None:
        if per_facet is None:
            raise missing("interface.per_facet", "say how many glued grains sit on each facet")
        return
    facets = len(interface.facet_lengths(shape))
    if "outer" not in interface.boundaries and len(interface.boundaries) > 1:
        raise refusal("interface.count", count, "is ambiguous on several boundaries; give per_facet instead")
    open_end = 0 if "outer" in interface.boundaries else 1
    if count <= open_end or (count - open_end) % facets:
        raise refusal(
            "interface.count",
            count,
            f"does not spread over {facets} facets; give {open_end} plus a multiple of {facets}, or per_facet",
        )


def check_rows(scene: Scene) -> None:
    """Check the rows of fixed grains."""
    for index, row in enumerate(scene.rows):
        if isinstance(row, RowUnder):
            _check_under(scene, row.under, f"rows.{index}.under")
        elif (row.count == 1) != (row.start == row.end):
            raise refusal(
                f"rows.{index}.count",
                row.count,
                "does not suit start and end: one grain needs end = start, several a distance",
            )


def _check_under(scene: Scene, under: str, key: str) -> None:
    interface, structure = scene.interface, scene.structure
    if interface is None or structure is None:
        raise refusal(key, under, "needs a structure above; add [structure] and [interface] or give start")
    if interface.per_facet is None and interface.count is None:
        raise missing(
            "interface.per_facet", f'a row under "{under}" takes its number from it; give it, or start and end'
        )
    covered = under in interface.boundaries or "outer" in interface.boundaries
    if under not in structure.shape.glueable or not covered:
        allowed = structure.shape.glueable if covered else interface.boundaries
        raise refusal(key, under, f"meets no grains; {nearest(under, allowed)}")
