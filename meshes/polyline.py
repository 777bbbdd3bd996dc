"""The outer boundary as plain arrays, the same on every rank."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshes.errors import MeshError


@dataclass(frozen=True, kw_only=True)
class BoundaryPolyline:
    """Closed counter-clockwise polyline through the nodes of the outer boundary.

    Attributes
    ----------
    points : (n_b, 2)
        Reference positions [m]. Mid-side nodes of order-2 elements are points like the others.
    facets : (n_f, 2)
        Indices into `points` of the start and the end of each facet, counter-clockwise: the
        solid is to the left of ``points[end] - points[start]``.
    facet_names : tuple of str, length n_f
        The name of the boundary that carries the facet: of "bottom", "right", "top", "left" for a
        beam; "loaded_arc" or "free_arc" for a tube; the given name, or "outer", for a mesh from outside.
        Every facet is also on "outer": ask `on`.
    closed : bool
        Always True: the last facet ends at the first point.
    """

    points: NDArray[np.float64]
    facets: NDArray[np.int64]
    facet_names: tuple[str, ...]
    closed: bool = True

    def on(self, name: str) -> NDArray[np.bool_]:
        """Mask (n_f,) of the facets on boundary `name`; "outer" is all of them."""
        if name == "outer":
            return np.ones(len(self.facet_names), dtype=bool)
        if name not in self.facet_names:
            allowed = ", ".join(sorted({"outer", *self.facet_names}))
            raise MeshError(f"boundary '{name}' carries no outer facet: use one of {allowed}")
        return np.array([own == name for own in self.facet_names])

    def lengths(self) -> NDArray[np.float64]:
        """Reference length [m] of each facet, shape (n_f,)."""
        start, end = self.points[self.facets[:, 0]], self.points[self.facets[:, 1]]
        return np.hypot(*(end - start).T)


def trace(
    nodes: NDArray[np.float64],
    edges: Mapping[str, NDArray[np.int64]],
    start: tuple[float, float],
) -> tuple[BoundaryPolyline, NDArray[np.int64]]:
    """Chain oriented edges into the polyline that begins at the node nearest to `start`.

    Parameters
    ----------
    nodes : (n, 2)
        Positions of all mesh nodes.
    edges : name -> (k, 2) or (k, 3)
        Per boundary, (start, end) or (start, end, middle) node of each edge, counter-clockwise.
    start : (x, y)
        Where the polyline begins.

    Returns
    -------
    The polyline, and the mesh node under each of its points, shape (n_b,).
    """
    following: dict[int, tuple[int, str]] = {}
    for name, rows in edges.items():
        for row in rows.tolist():
            chain = (row[0], *row[2:], row[1])
            for first, second in zip(chain[:-1], chain[1:]):
                following[first] = (second, name)
    candidates = np.fromiter(following, dtype=np.int64)
    distance = np.hypot(*(nodes[candidates] - np.asarray(start)).T)
    first = int(candidates[np.argmin(distance)])
    ordered, names, node = [], [], first
    for _ in range(len(following)):
        ordered.append(node)
        node, name = following[node]
        names.append(name)
    assert node == first and len(set(ordered)) == len(following), "the outer edges are not one loop"
    index = np.arange(len(ordered))
    polyline = BoundaryPolyline(
        points=nodes[ordered].copy(),
        facets=np.column_stack([index, np.roll(index, -1)]),
        facet_names=tuple(names),
    )
    return polyline, np.array(ordered, dtype=np.int64)
