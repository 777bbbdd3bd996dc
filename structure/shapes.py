"""Shape functions of the four kinds of cells, nodes in VTK's order, as plain arithmetic."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Nodes of the edges of a cell, counter-clockwise: start, end (, middle).
EDGES = {
    ("quadrilateral", 1): ((0, 1), (1, 2), (2, 3), (3, 0)),
    ("quadrilateral", 2): ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)),
    ("triangle", 1): ((0, 1), (1, 2), (2, 0)),
    ("triangle", 2): ((0, 1, 3), (1, 2, 4), (2, 0, 5)),
}
CENTRES = {"quadrilateral": np.array([0.5, 0.5]), "triangle": np.array([1 / 3, 1 / 3])}

# Position of the nodes of a quadrilateral in the tensor product, along xi and along eta.
_TENSOR = {
    1: ((0, 1, 1, 0), (0, 0, 1, 1)),
    2: ((0, 1, 1, 0, 2, 1, 2, 0, 2), (0, 0, 1, 1, 0, 2, 1, 2, 2)),
}


def on_line(order: int, s: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Values and derivatives (order + 1,) at s in (0, 1) of the functions of start, end (, middle)."""
    if order == 1:
        return np.array([1.0 - s, s]), np.array([-1.0, 1.0])
    values = np.array([(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0), 4.0 * s * (1.0 - s)])
    return values, np.array([4.0 * s - 3.0, 4.0 * s - 1.0, 4.0 - 8.0 * s])


def in_cell(cell: str, order: int, at: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Values (nodes,) and derivatives (nodes, 2) at a point (2,) of the reference cell.

    The reference cell is the unit square, or the triangle with the corners (0, 0), (1, 0), (0, 1).
    """
    xi, eta = at
    if cell == "quadrilateral":
        along, across = (np.array(index) for index in _TENSOR[order])
        (f, df), (g, dg) = on_line(order, xi), on_line(order, eta)
        return f[along] * g[across], np.column_stack([df[along] * g[across], f[along] * dg[across]])
    corner = np.array([1.0 - xi - eta, xi, eta])
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    if order == 1:
        return corner, slope
    after = np.roll(corner, -1)
    values = np.concatenate([corner * (2.0 * corner - 1.0), 4.0 * corner * after])
    edges = 4.0 * (slope * after[:, None] + np.roll(slope, -1, axis=0) * corner[:, None])
    return values, np.concatenate([(4.0 * corner - 1.0)[:, None] * slope, edges])


def outside_by(cell: str, at: NDArray[np.float64]) -> float:
    """How far a reference point lies outside the reference cell: 0 on its boundary, negative inside."""
    xi, eta = at
    if cell == "quadrilateral":
        return max(-xi, xi - 1.0, -eta, eta - 1.0)
    return max(-xi, -eta, xi + eta - 1.0)
