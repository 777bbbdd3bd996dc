"""What a mesh from outside must be: one piece, cells that turn one way, a boundary that does not cross itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from meshes.errors import MeshError
from meshes.kinds import KINDS, Kind, determinants

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

FLAT = 1e-12  # area over the square of the longest side
FOLDED = 1e-9  # smallest determinant over the largest


def kind_of(points: Floats, cells: Integers) -> Kind:
    """The kind of cells (m, k) on points (n, 2).

    Raises
    ------
    MeshError
        Arrays of another form, a number of nodes that no kind has, a node that does not exist or that no
        cell uses, two nodes at one place.
    """
    if points.ndim != 2 or points.shape[1] != 2 or not np.all(np.isfinite(points)):
        raise MeshError(f"points of shape {points.shape} must be finite and of shape (n, 2), x and y in metres")
    if cells.ndim != 2 or cells.shape[1] not in KINDS or not len(cells):
        raise MeshError(
            f"cells of shape {cells.shape} must be (m, k) with k = 3 or 6 nodes for triangles of order 1 or 2, "
            "4 or 9 for quadrilaterals"
        )
    if cells.min() < 0 or cells.max() >= len(points):
        raise MeshError(
            f"cells name the nodes {cells.min()} to {cells.max()}: there are the points 0 to {len(points) - 1}"
        )
    unused = np.setdiff1d(np.arange(len(points)), cells)
    if len(unused):
        raise MeshError(f"point {unused[0]} at {_place(points[unused[0]])} belongs to no cell: remove it")
    order = np.lexsort(points.T)
    same = np.flatnonzero((np.diff(points[order], axis=0) == 0.0).all(axis=1))
    if len(same):
        one, other = sorted(order[same[0] : same[0] + 2].tolist())
        raise MeshError(f"points {one} and {other} lie at the same place, {_place(points[one])}: merge them")
    return KINDS[cells.shape[1]]


def counter_clockwise(points: Floats, cells: Integers, kind: Kind) -> Integers:
    """The cells, turned round if all of them run clockwise.

    Raises
    ------
    MeshError
        A cell without area, folded, or inverted against the others.
    """
    corners = points[cells[:, : len(kind.sides)]]
    longest = ((np.roll(corners, -1, axis=1) - corners) ** 2).sum(axis=2).max(axis=1)
    found = determinants(points[cells], kind)
    low, high = found.min(axis=1), found.max(axis=1)
    size = np.maximum(np.abs(low), np.abs(high))
    clockwise = high <= 0.0
    for number in np.flatnonzero(size <= FLAT * longest)[:1]:
        raise MeshError(f"{_name(points, cells, number)} has no area: remove it or move its nodes apart")
    for number in np.flatnonzero(np.minimum(np.abs(low), np.abs(high)) * np.sign(low * high) <= FOLDED * size)[:1]:
        raise MeshError(
            f"{_name(points, cells, number)} is folded: its sides meet at 180 degrees or more, or cross; move its nodes"
        )
    if clockwise.all():
        return cells[:, kind.turned]
    for number in np.flatnonzero(clockwise)[:1]:
        raise MeshError(
            f"{_name(points, cells, number)} is inverted: its nodes run clockwise, those of others counter-clockwise; "
            "move its nodes or list them the other way round"
        )
    return cells


def free_sides(points: Floats, cells: Integers, kind: Kind) -> Integers:
    """Sides (k, 2 or 3) of one cell alone as start, end and middle: the boundary, solid to the left.

    Raises
    ------
    MeshError
        Two cells on the same side of an edge, or several pieces.
    """
    rows = np.concatenate([cells[:, side] for side in kind.sides])
    owner = np.tile(np.arange(len(cells)), len(kind.sides))
    key = np.sort(rows[:, :2], axis=1)
    edge, count = np.unique(key, axis=0, return_inverse=True, return_counts=True)[1:]
    edge = edge.ravel()
    forward = np.bincount(edge, weights=rows[:, 0] < rows[:, 1])
    for number in np.flatnonzero((forward > 1) | (count - forward > 1))[:1]:
        one, two = key[edge == number][0]
        raise MeshError(
            f"two cells lie on the same side of the edge from {_place(points[one])} to {_place(points[two])}: "
            "cells must not overlap"
        )
    order = np.argsort(edge, kind="stable")
    pairs = order[:-1][np.diff(edge[order]) == 0], order[1:][np.diff(edge[order]) == 0]
    graph = coo_matrix((np.ones(len(pairs[0])), (owner[pairs[0]], owner[pairs[1]])), shape=(len(cells), len(cells)))
    pieces, piece = connected_components(graph, directed=False)
    if pieces > 1:
        apart = int(np.flatnonzero(piece != piece[0])[0])
        raise MeshError(
            f"the mesh is in {pieces} pieces, of which one holds {_name(points, cells, apart)}: a structure is "
            "one, whose cells share edges node by node"
        )
    return rows[count[edge] == 1]


def outer_sides(points: Floats, sides: Integers) -> NDArray[np.bool_]:
    """Mask (k,) of the boundary's sides on its outer loop; the others are around holes.

    Raises
    ------
    MeshError
        A boundary that touches or crosses itself.
    """
    starts, count = np.unique(sides[:, 0], return_counts=True)
    for node in starts[count > 1][:1]:
        raise MeshError(
            f"the boundary touches itself at {_place(points[node])}: cells that meet there must share an edge"
        )
    chain = _chain(sides)
    crossing = _first_crossing(points, chain)
    if crossing is not None:
        one, other = (points[chain[k]].mean(axis=0) for k in crossing)
        raise MeshError(
            f"the boundary crosses or touches itself near {_place(one)} and {_place(other)}: cells must not overlap"
        )
    place = np.searchsorted(starts, sides[:, :2])
    ones = np.ones(len(sides))
    loop = connected_components(coo_matrix((ones, place.T), shape=(len(starts),) * 2), directed=False)[1][place[:, 0]]
    (x, y), (ahead_x, ahead_y) = points[sides[:, 0]].T, points[sides[:, 1]].T
    area = np.bincount(loop, weights=x * ahead_y - ahead_x * y)
    return area[loop] > 0.0


def _chain(sides: Integers) -> Integers:
    """Straight pieces (start, end) of sides, two for a side with a middle."""
    if sides.shape[1] == 2:
        return sides
    return np.concatenate([sides[:, [0, 2]], sides[:, [2, 1]]])


def _first_crossing(points: Floats, chain: Integers) -> tuple[int, int] | None:
    """Two pieces (start, end) without a common node that cross or touch, if there are any; a sweep along the body."""
    begin, end = points[chain[:, 0]], points[chain[:, 1]]
    low, high = np.minimum(begin, end), np.maximum(begin, end)
    along = int(np.argmax(np.ptp(points, axis=0)))
    across = 1 - along
    order = np.argsort(low[:, along], kind="stable")
    last = np.searchsorted(low[order, along], high[order, along], side="right")
    for rank, one in enumerate(order.tolist()):
        others = order[rank + 1 : last[rank]]
        near = (low[others, across] <= high[one, across]) & (high[others, across] >= low[one, across])
        others = others[near & ~np.isin(chain[others], chain[one]).any(axis=1)]
        apart = _side(begin[one], end[one], begin[others]) * _side(begin[one], end[one], end[others]) > 0.0
        apart |= _side(begin[others], end[others], begin[one]) * _side(begin[others], end[others], end[one]) > 0.0
        if not apart.all():
            return one, int(others[~apart][0])
    return None


def _side(start: Floats, end: Floats, point: Floats) -> Floats:
    """-1, 0 or 1: on which side of the line from start to end a point lies."""
    ahead, way = end - start, point - start
    return np.sign(ahead[..., 0] * way[..., 1] - ahead[..., 1] * way[..., 0])


def _place(point: Floats) -> str:
    return f"({point[0]:.6g}, {point[1]:.6g})"


def _name(points: Floats, cells: Integers, number: int) -> str:
    return f"cell {number} around {_place(points[cells[number]].mean(axis=0))}"
