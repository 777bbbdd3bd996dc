"""Where a point lies in a mesh: the nodes that share what acts there, and their shares.

Works on the arrays that are the same on every rank, so that every rank finds the same answer.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from meshes import StructureMesh
from meshes.kinds import KINDS, Kind, shapes_at
from structure.errors import StructureError
from structure.loads.facets import on_facet

INSIDE = 1e-9  # of a cell: a point that far outside in reference coordinates is on its side
SWEEPS = 50
SHARPEST_ROUND = 1.1  # rad between facets of a round boundary; a sharper turn is a corner
BULGE = 1.05  # of the arc that touches the facet's neighbours: what a point may lie off
NEGLIGIBLE = 1e-6  # of a facet: as good as on it

Shares = tuple[NDArray[np.int64], NDArray[np.float64]]


def shares_at(mesh: StructureMesh, point: tuple[float, float]) -> Shares:
    """Nodes (k,) and their shape functions' values (k,) at a reference point.

    A point off the mesh by no more than a round boundary bulges over its facets counts as the
    nearest point of the nearest facet.

    Raises
    ------
    StructureError
        The point lies farther off.
    """
    place = np.array(point, dtype=float)
    return _in_cell(mesh, place) or _on_facet(mesh, place)


def _in_cell(mesh: StructureMesh, place: NDArray[np.float64]) -> Shares | None:
    corners = mesh.points[mesh.cells]
    low, high = corners.min(axis=1), corners.max(axis=1)
    # a curved side may reach beyond its nodes
    slack = (high - low) * (0.1 if mesh.order == 2 else INSIDE)
    near = np.all((low - slack <= place) & (place <= high + slack), axis=1)
    kind, found, least = KINDS[mesh.cells.shape[1]], None, INSIDE
    for cell in mesh.cells[near]:
        at = _reference_place(kind, mesh.points[cell] - place)
        if at is not None and (outside := _outside_by(kind, at)) <= least:
            found, least = (cell, shapes_at(kind, at[None])[0][0]), outside
    return found


def _reference_place(kind: Kind, nodes: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Newton's solution of ``sum N_a(at) x_a = 0``, x_a seen from the place; None where there is none near the cell."""
    at = np.mean(kind.nodes, axis=0)
    size = np.ptp(nodes, axis=0).max()
    for _ in range(SWEEPS):
        values, slopes = shapes_at(kind, at[None])
        gap = -values[0] @ nodes
        if np.abs(gap).max() <= 1e-14 * size:
            break
        jacobian = nodes.T @ slopes[0]
        if abs(np.linalg.det(jacobian)) < 1e-12 * size**2 or np.abs(at).max() > 10.0:
            return None
        at = at + np.linalg.solve(jacobian, gap)
    return at if np.abs(gap).max() <= 1e-10 * size else None


def _outside_by(kind: Kind, at: NDArray[np.float64]) -> float:
    """How far a place lies outside the reference cell: 0 on its boundary, negative inside."""
    xi, eta = at
    if kind.cell == "quadrilateral":
        return max(-xi, xi - 1.0, -eta, eta - 1.0)
    return max(-xi, -eta, xi + eta - 1.0)


def _on_facet(mesh: StructureMesh, place: NDArray[np.float64]) -> Shares:
    """The nearest point of the boundary, if it is near enough."""
    facets = _boundary(mesh)
    ends = mesh.points[facets[:, :2]]
    along = ends[:, 1] - ends[:, 0]
    lengths = np.hypot(*along.T)
    share = np.clip(np.sum((place - ends[:, 0]) * along, axis=1) / lengths**2, 0.0, 1.0)
    distance = np.hypot(*(ends[:, 0] + share[:, None] * along - place).T)
    best = (math.inf, 0, 0.0)
    # a curved facet may be nearer than its chord: up to half its length, in the worst of cases
    for number in np.flatnonzero(distance <= distance.min() + (0.5 * lengths.max() if mesh.order == 2 else 0.0)):
        best = min(best, _nearest_on(mesh, facets[number], share[number], place, number))
    off, number, s = best
    values, _ = on_facet(mesh.order, s)
    allowed = _bulge(mesh, facets, number)
    if off > allowed:
        nearest = tuple((values @ mesh.points[facets[number]]).tolist())
        raise StructureError(
            f"point = {tuple(place.tolist())!r} lies {off:.3g} m off the mesh, where at most {allowed:.2g} m is "
            f"allowed: take a point of the body, the nearest is {nearest!r}"
        )
    return facets[number], values


def _boundary(mesh: StructureMesh) -> NDArray[np.int64]:
    """Facets (f, order + 1) that belong to one cell only."""
    sides = np.concatenate([mesh.cells[:, edge] for edge in KINDS[mesh.cells.shape[1]].sides])
    _, first, count = np.unique(np.sort(sides[:, :2], axis=1), axis=0, return_index=True, return_counts=True)
    return sides[first[count == 1]]


def _nearest_on(
    mesh: StructureMesh, facet: NDArray[np.int64], s: float, place: NDArray[np.float64], number: int
) -> tuple[float, int, float]:
    """Distance [m], number and s in (0, 1) of the point of a facet nearest to a place."""
    nodes = mesh.points[facet]
    for _ in range(SWEEPS if mesh.order == 2 else 1):
        values, slopes = on_facet(mesh.order, s)
        tangent = slopes @ nodes
        s = float(np.clip(s + (place - values @ nodes) @ tangent / (tangent @ tangent), 0.0, 1.0))
    values, _ = on_facet(mesh.order, s)
    return float(np.hypot(*(place - values @ nodes))), int(number), s


def _bulge(mesh: StructureMesh, facets: NDArray[np.int64], number: int) -> float:
    """How far [m] a round boundary may bulge over a facet, by the angles to the next ones.

    Facets of length L on a circle turn by phi from one to the next and lie ``L/2 tan(phi/4)`` below it.
    """
    own, turns = facets[number], [0.0]
    for end, node in enumerate(own[:2]):
        others = [k for k in np.flatnonzero(np.any(facets[:, :2] == node, axis=1)) if k != number]
        for other in others:
            here, there = _outwards(mesh, own, end), _outwards(mesh, facets[other], list(facets[other]).index(node))
            turns.append(math.pi - abs(math.atan2(here[0] * there[1] - here[1] * there[0], here @ there)))
    length = float(np.hypot(*np.diff(mesh.points[own[:2]], axis=0)[0]))
    round_turns = [turn for turn in turns if turn <= SHARPEST_ROUND]
    return length * max(NEGLIGIBLE, BULGE / 2 * math.tan(max(round_turns) / 4))


def _outwards(mesh: StructureMesh, facet: NDArray[np.int64], end: int) -> NDArray[np.float64]:
    """Tangent (2,) of a facet at its start (0) or end (1), away from that node."""
    _, slopes = on_facet(mesh.order, float(end))
    return (1 - 2 * end) * (slopes @ mesh.points[facet])
