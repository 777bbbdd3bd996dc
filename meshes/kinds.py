"""The kinds of cells: shapes, sides, and the map from the reference cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind of cell, in VTK order.

    nodes (k, 2): places in the reference cell; powers (k, 2): exponents of the monomials that span its
    shapes; sides: (start, end) or (start, end, middle) of each side, counter-clockwise; turned: the nodes
    of the same cell the other way round.
    """

    cell: str
    order: int
    nodes: tuple[tuple[float, float], ...]
    powers: tuple[tuple[int, int], ...]
    sides: tuple[tuple[int, ...], ...]
    turned: tuple[int, ...]


_TRIANGLE = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
_SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
KINDS = {
    3: Kind(
        cell="triangle",
        order=1,
        nodes=_TRIANGLE,
        powers=((0, 0), (1, 0), (0, 1)),
        sides=((0, 1), (1, 2), (2, 0)),
        turned=(0, 2, 1),
    ),
    4: Kind(
        cell="quadrilateral",
        order=1,
        nodes=_SQUARE,
        powers=((0, 0), (1, 0), (0, 1), (1, 1)),
        sides=((0, 1), (1, 2), (2, 3), (3, 0)),
        turned=(0, 3, 2, 1),
    ),
    6: Kind(
        cell="triangle",
        order=2,
        nodes=(*_TRIANGLE, (0.5, 0.0), (0.5, 0.5), (0.0, 0.5)),
        powers=((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)),
        sides=((0, 1, 3), (1, 2, 4), (2, 0, 5)),
        turned=(0, 2, 1, 5, 4, 3),
    ),
    9: Kind(
        cell="quadrilateral",
        order=2,
        nodes=(*_SQUARE, (0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5), (0.5, 0.5)),
        powers=tuple((i, j) for i in range(3) for j in range(3)),
        sides=((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)),
        turned=(0, 3, 2, 1, 7, 6, 5, 4, 8),
    ),
}


def shapes_at(kind: Kind, places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Shape functions (p, k) and their slopes (p, k, 2) at places (p, 2) of the reference cell.

    The reference cell is the unit square, or the triangle with the corners (0, 0), (1, 0), (0, 1).
    """
    powers = np.array(kind.powers)
    to_shapes = np.linalg.inv(np.prod(np.array(kind.nodes)[:, None] ** powers, axis=2))
    slopes = []
    for axis in (0, 1):
        lowered = np.maximum(powers - np.eye(2, dtype=int)[axis], 0)
        slopes.append((powers[:, axis] * np.prod(places[:, None] ** lowered, axis=2)) @ to_shapes)
    return np.prod(places[:, None] ** powers, axis=2) @ to_shapes, np.stack(slopes, axis=2)


def determinants(nodes: NDArray[np.float64], kind: Kind) -> NDArray[np.float64]:
    """Determinant of the map from the reference cell, cells (m, k, 2) at a lattice of places (m, p)."""
    steps = np.linspace(0.0, 1.0, 2 * kind.order + 1)
    places = np.array([(s, t) for s in steps for t in steps if kind.cell == "quadrilateral" or s + t < 1.0 + 1e-9])
    _, slopes = shapes_at(kind, places)
    (a, c), (b, d) = ((slopes[:, :, axis] @ nodes).transpose(2, 0, 1) for axis in (0, 1))
    return a * d - b * c
