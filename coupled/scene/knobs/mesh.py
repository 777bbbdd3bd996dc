"""The mesh of a scene under a factor on its numbers of cells, with the glued grains on it."""

from __future__ import annotations

import math
from typing import Any

from coupled.scene.interface import Interface, RowUnder
from coupled.scene.refusal import refusal
from coupled.scene.rules.structure import check_cells
from coupled.scene.scene import Scene
from coupled.scene.shape import Shape

FEWEST = {"around": 6, "layers": 1, "along": 1, "across": 1}


def refined(tables: dict[str, Any], scene: Scene, refinement: float, coarsening: float) -> None:
    """Put finer or coarser cells into the tables of a scene, and glued grains c times as large, in place.

    Their number per facet is rounded, so that it may change by a part; a row of fixed grains under them, whose grains
    are springs, allows no such change.

    Raises
    ------
    SceneError
        If a row under the structure would get another number of grains.
    """
    assert scene.structure is not None
    before = scene.structure.shape
    name = "tube" if scene.structure.tube is not None else "beam"
    cells = tables["structure"][name]
    for key, fewest in FEWEST.items():
        if key in cells:
            cells[key] = max(fewest, _nearest(cells[key] * refinement))
    after = type(before).model_validate(cells)
    check_cells(after)
    interface = scene.interface
    if interface is None or (interface.per_facet is None and interface.count is None):
        return
    own = interface.grains_per_facet(before)
    per_facet = max(1, _nearest(own / (coarsening * refinement)))
    _check_rows(scene, interface, (before, own), (after, per_facet), refinement)
    table = tables["interface"]
    table.pop("count", None)
    table["per_facet"] = per_facet
    if interface.diameter is not None:
        spacing = min(interface.facet_lengths(after)) / per_facet
        table["diameter"] = min(interface.diameter * coarsening, spacing)


def _check_rows(
    scene: Scene, interface: Interface, before: tuple[Shape, int], after: tuple[Shape, int], refinement: float
) -> None:
    """Refuse another number of grains in a row under the structure."""
    for row in scene.rows:
        if not isinstance(row, RowUnder):
            continue
        (old, new) = (len(shape.facet_lengths(row.under)) * number for shape, number in (before, after))
        if old != new:
            raise refusal(
                "structure.refinement",
                refinement,
                f'makes {new} intervals of the {old} of the row under "{row.under}", whose grains are springs; give a '
                f"factor that divides {before[1]} glued grains per facet, or 1",
            )


def _nearest(number: float) -> int:
    """The nearest whole number, halves upward."""
    return math.floor(number + 0.5)
