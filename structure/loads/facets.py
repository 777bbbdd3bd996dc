"""The facets of a named boundary, inner ones too, as rows of original nodes on every rank."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshes.kinds import KINDS
from structure import compat
from structure.discrete import DiscreteBody
from structure.errors import StructureError


def boundary_tags(body: DiscreteBody, name: str) -> tuple[int, ...]:
    """Tags of a boundary.

    Raises
    ------
    StructureError
        The mesh has no such boundary.
    """
    named = body.mesh.boundaries
    if name not in named:
        raise StructureError(
            f"boundary = '{name}' is not a boundary of this mesh: use one of {', '.join(sorted(named))}"
        )
    return named[name]


def boundary_facets(body: DiscreteBody, name: str) -> NDArray[np.int64]:
    """Original nodes (facets, order + 1) of each facet of a boundary: start, end (, middle).

    The solid is to the left of the way from start to end. The rows are sorted, so that they do not
    depend on the number of ranks.
    """
    mesh, tags = body.mesh, boundary_tags(body, name)
    topology = mesh.domain.topology
    topology.create_connectivity(1, 2)
    topology.create_connectivity(2, 1)
    cells_of, facets_of = topology.connectivity(1, 2), topology.connectivity(2, 1)
    closures = compat.facet_nodes(body.space, len(KINDS[mesh.cells.shape[1]].sides))
    rows = []
    for facet in mesh.facet_tags.indices[np.isin(mesh.facet_tags.values, tags)]:
        cell = cells_of.links(facet)[0]
        if cell < len(body.nodes.cells):
            side = int(np.flatnonzero(facets_of.links(cell) == facet)[0])
            rows.append(_solid_on_left(mesh.points, body.nodes.cells[cell], closures[side]))
    table = np.array(rows, dtype=np.int64).reshape(-1, mesh.order + 1)
    everyone = np.concatenate(body.comm.allgather(table))
    return everyone[np.lexsort(everyone.T[::-1])]


def _solid_on_left(points: NDArray[np.float64], cell: NDArray[np.int64], side: NDArray[np.int64]) -> NDArray[np.int64]:
    """Nodes of a side of a cell, start and end in the order that leaves the cell to the left."""
    nodes = cell[side].copy()
    start, end = points[nodes[:2]]
    along, inwards = end - start, points[cell].mean(axis=0) - start
    if along[0] * inwards[1] < along[1] * inwards[0]:
        nodes[:2] = nodes[1::-1]
    return nodes


def on_facet(order: int, s: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Shape functions and slopes (order + 1,) of start, end (, middle) at s in (0, 1)."""
    if order == 1:
        return np.array([1.0 - s, s]), np.array([-1.0, 1.0])
    values = np.array([(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0), 4.0 * s * (1.0 - s)])
    return values, np.array([4.0 * s - 3.0, 4.0 * s - 1.0, 4.0 - 8.0 * s])
