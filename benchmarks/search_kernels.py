"""Finding contacts without cells, and with cells but without a list: what the product's own search is measured against.

Each kernel is compiled twice, for one thread and for several. All of them return the number of touching pairs and the
sum of their overlaps (of squares of distances), so that none can skip work and all must agree.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numba

from particles.kernels.jit import inner_kernel, kernel, threaded_kernel

WIDEST = 16  # near partners of later number that a row has room for
CHUNK = 64  # discs that are looked at together


class Build(NamedTuple):
    """One loop as a kernel for one thread and for several."""

    one: Callable[..., Any]
    several: Callable[..., Any]


def _both(function: Callable[..., Any]) -> Build:
    return Build(kernel(function), threaded_kernel(function))


@inner_kernel
def near_in_chunk(x, y, radius, i, skin, first, last):
    """How many of the discs from `first` to before `last` are near disc i: a loop that the compiler vectorises."""
    near = 0
    for j in range(first, last):
        dx, dy, reach = x[j] - x[i], y[j] - y[i], radius[i] + radius[j] + skin
        near += 1 if dx * dx + dy * dy < reach * reach else 0
    return near


@inner_kernel
def touching_in_row(x, y, radius, i):
    """Touching discs of later number and the sum of their overlaps; chunk by chunk, again where one touches."""
    n, count, overlap = x.shape[0], 0, 0.0
    for first in range(i + 1, n, CHUNK):
        last = min(first + CHUNK, n)
        if near_in_chunk(x, y, radius, i, 0.0, first, last) > 0:
            for j in range(first, last):
                dx, dy, reach = x[j] - x[i], y[j] - y[i], radius[i] + radius[j]
                square = dx * dx + dy * dy
                if square < reach * reach:
                    count += 1
                    overlap += reach * reach - square
    return count, overlap


@inner_kernel
def list_row(x, y, radius, i, skin, partner):
    """Near discs of later number, written to `partner`; returns how many there are."""
    n, near = x.shape[0], 0
    for first in range(i + 1, n, CHUNK):
        last = min(first + CHUNK, n)
        if near_in_chunk(x, y, radius, i, skin, first, last) > 0:
            for j in range(first, last):
                dx, dy, reach = x[j] - x[i], y[j] - y[i], radius[i] + radius[j] + skin
                if dx * dx + dy * dy < reach * reach:
                    if near < partner.shape[0]:
                        partner[near] = j
                    near += 1
    return near


def _brute(x, y, radius):
    """All pairs. Rows from both ends in turns, so that threads get equal shares."""
    n, count, overlap = x.shape[0], 0, 0.0
    for half in numba.prange((n + 1) // 2):
        early = touching_in_row(x, y, radius, half)
        late = touching_in_row(x, y, radius, n - 1 - half) if n - 1 - half > half else (0, 0.0)
        count += early[0] + late[0]
        overlap += early[1] + late[1]
    return count, overlap


def _list_by_brute(x, y, radius, skin, partner, held):
    """Near pairs out of all pairs, in rows of fixed width; `held` (n,) is what each row asks for."""
    n = x.shape[0]
    for half in numba.prange((n + 1) // 2):
        held[half] = list_row(x, y, radius, half, skin, partner[half])
        if n - 1 - half > half:
            held[n - 1 - half] = list_row(x, y, radius, n - 1 - half, skin, partner[n - 1 - half])


def _walk_wide(x, y, radius, x_listed, y_listed, partner, held):
    """One step with rows of fixed width: the farthest way since the list was made, then the near pairs."""
    count, overlap, farthest = 0, 0.0, 0.0
    for i in numba.prange(x.shape[0]):
        farthest = max(farthest, (x[i] - x_listed[i]) ** 2 + (y[i] - y_listed[i]) ** 2)
        for k in range(held[i]):
            j = partner[i, k]
            dx, dy, reach = x[j] - x[i], y[j] - y[i], radius[i] + radius[j]
            square = dx * dx + dy * dy
            if square < reach * reach:
                count += 1
                overlap += reach * reach - square
    return count, overlap, farthest


def _walk_rows(x, y, radius, x_listed, y_listed, start, partner):
    """One step with the product's list: rows one behind the other."""
    count, overlap, farthest = 0, 0.0, 0.0
    for i in numba.prange(x.shape[0]):
        farthest = max(farthest, (x[i] - x_listed[i]) ** 2 + (y[i] - y_listed[i]) ** 2)
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            dx, dy, reach = x[j] - x[i], y[j] - y[i], radius[i] + radius[j]
            square = dx * dx + dy * dy
            if square < reach * reach:
                count += 1
                overlap += reach * reach - square
    return count, overlap, farthest


def _through_cells(xs, ys, radius, rows, cell_start):
    """One step with cells alone, grains in the order of their cells: the rest of the own cell and four others."""
    cells, count, overlap = cell_start.shape[0] - 1, 0, 0.0
    for c in numba.prange(cells):
        row = c % rows
        last = cell_start[c + 2] if row + 1 < rows else cell_start[c + 1]  # own cell and the one above
        begin = end = 0
        if c - row + rows < cells:  # three cells of the next column
            begin = cell_start[c + rows - (1 if row > 0 else 0)]
            end = cell_start[c + rows + (2 if row + 1 < rows else 1)]
        for i in range(cell_start[c], cell_start[c + 1]):
            for run in range(2):
                first, beyond = (begin, end) if run else (i + 1, last)
                for j in range(first, beyond):
                    dx, dy, reach = xs[j] - xs[i], ys[j] - ys[i], radius[i] + radius[j]
                    square = dx * dx + dy * dy
                    if square < reach * reach:
                        count += 1
                        overlap += reach * reach - square
    return count, overlap


brute = _both(_brute)
list_by_brute = _both(_list_by_brute)
walk_wide = _both(_walk_wide)
walk_rows = _both(_walk_rows)
through_cells = _both(_through_cells)
