"""Packing fraction: exact areas of discs that strips and cells cut."""

import math

import numpy as np
from numpy.typing import ArrayLike

from particles.errors import ParticleError, require
from particles.measures.cells import Cells
from particles.state import Floats


def area_below(height: ArrayLike, radius: ArrayLike) -> Floats:
    """Area [m2] of a disc around the origin below a horizontal line, ``r^2 acos(-h/r) + h sqrt(r^2 - h^2)``.

    `height` h of the line [m], any sign; `radius` r [m]; both broadcast.
    """
    r = np.asarray(radius, float)
    h = np.clip(np.asarray(height, float), -r, r)
    return r**2 * np.arccos(-h / r) + h * np.sqrt(np.maximum(r**2 - h**2, 0.0))


def area_in_quadrant(a: ArrayLike, b: ArrayLike, radius: ArrayLike) -> Floats:
    """Area [m2] of a disc around the origin left of x = a and below y = b.

    A corner (a, b) in the disc adds the rectangle ``a b`` to the halves of both cuts; outside, the two segments that
    are cut off do not meet. Broadcast.
    """
    r = np.asarray(radius, float)
    a, b = np.clip(np.asarray(a, float), -r, r), np.clip(np.asarray(b, float), -r, r)
    left, below, whole = area_below(a, r), area_below(b, r), math.pi * r**2
    inside = 0.5 * (left + below) - 0.25 * whole + a * b
    outside = np.where(
        a > 0.0, np.where(b > 0.0, left + below - whole, below), np.where(b > 0.0, left, np.zeros_like(left))
    )
    return np.where(a**2 + b**2 < r**2, inside, outside)


def fraction_in_strips(y: Floats, radius: Floats, edges: ArrayLike, width: float) -> Floats:
    """Packing fraction of horizontal strips, each disc counted by the exact share that lies in each.

    Parameters
    ----------
    y, radius : (n,)
        Heights and radii of the discs [m]; all of them lie within the width.
    edges : (k + 1,)
        Heights between the strips [m], rising.
    width : float
        Of the strips [m]: the inner width of the box, or the period.

    Returns
    -------
    (k,)
        Area of discs over area of the strip [-]; overlaps count twice.

    Raises
    ------
    ParticleError
        If the edges do not rise or the width is not positive.
    """
    lines = np.asarray(edges, float)
    require("width of the strips", width, above=0.0)
    if lines.ndim != 1 or len(lines) < 2 or not np.all(np.diff(lines) > 0.0):
        raise ParticleError("the edges of strips must be two rising heights or more")
    below = np.array([area_below(line - y, radius).sum() for line in lines])
    return np.diff(below) / (width * np.diff(lines))


def fraction_in_cells(x: Floats, y: Floats, radius: Floats, cells: Cells) -> Floats:
    """Packing fraction of every cell (rows, columns) [-], by the exact area of each disc in each.

    `x`, `y`, `radius` (n,) [m]; what reaches out of the cells is cut off, or comes in on the other side if that is
    periodic. The cost grows with the number of cells that a disc covers, not with that of all.
    """
    area = np.zeros(cells.count)
    wide, high = cells.size
    for across, up, which in cells.images(x, y, radius):
        r = radius[which]
        column, row = np.floor((across - r) / wide).astype(np.int64), np.floor((up - r) / high).astype(np.int64)
        columns = np.floor((across + r) / wide).astype(np.int64) - column + 1
        rows = np.floor((up + r) / high).astype(np.int64) - row + 1
        for i in range(int(columns.max(initial=0))):
            for j in range(int(rows.max(initial=0))):
                c, d = column + i, row + j
                own = (i < columns) & (j < rows) & (c >= 0) & (c < cells.columns) & (d >= 0) & (d < cells.rows)
                if not own.any():
                    continue
                a, b = c[own] * wide - across[own], d[own] * high - up[own]
                part = _in_rectangle(a, a + wide, b, b + high, r[own])
                area += np.bincount(d[own] * cells.columns + c[own], part, minlength=cells.count)
    return cells.shaped(area / (wide * high))


def _in_rectangle(a: Floats, a_end: Floats, b: Floats, b_end: Floats, radius: Floats) -> Floats:
    """Area [m2] of discs around the origin in rectangles from (a, b) to (a_end, b_end) [m]."""
    corners = ((a_end, b_end, 1.0), (a, b_end, -1.0), (a_end, b, -1.0), (a, b, 1.0))
    return sum((sign * area_in_quadrant(p, q, radius) for p, q, sign in corners), np.zeros_like(radius))
