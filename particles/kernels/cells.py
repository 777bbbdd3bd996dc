"""Contact search on a hierarchy of uniform cells, and the half list of near pairs (model 1.5).

Grains are sorted into levels by size, each with cells of at least its largest diameter plus the
skin. A grain meets those of its own level in its cell and the following ones, and those of coarser
levels in the nine cells around its centre: the cost per grain does not depend on the size ratio.
"""

import numpy as np

from particles.kernels.jit import inner_kernel, kernel


@inner_kernel
def cell_of(x, y, grid):
    column = min(max(int((x - grid.x_min) / grid.size), 0), grid.columns - 1)
    row = min(max(int((y - grid.y_min) / grid.size), 0), grid.rows - 1)
    return column * grid.rows + row


@kernel
def sort_by_cell(x, y, members, grid):
    """Stable counting sort of `members` by cell, columns first. Returns the order and the first place of each cell."""
    cells = np.empty(members.shape[0], np.int64)
    cell_start = np.zeros(grid.columns * grid.rows + 1, np.int64)
    for k in range(members.shape[0]):
        cells[k] = cell_of(x[members[k]], y[members[k]], grid)
        cell_start[cells[k] + 1] += 1
    for c in range(grid.columns * grid.rows):
        cell_start[c + 1] += cell_start[c]
    place = cell_start[:-1].copy()
    order = np.empty(members.shape[0], np.int64)
    for k in range(members.shape[0]):
        order[place[cells[k]]] = members[k]
        place[cells[k]] += 1
    return order, cell_start


@inner_kernel
def may_touch(i, j, x, y, radius, body, skin):
    dx, dy, reach = x[j] - x[i], y[j] - y[i], radius[i] + radius[j] + skin
    return dx * dx + dy * dy < reach * reach and (body[i] != body[j] or body[i] < 0)


@kernel
def pairs_within(x, y, radius, body, skin, grid, order, cell_start, found, count):
    """Near pairs of one level, written to `found` (capacity, 2) from `count` on. Returns the new count.

    Sorted by columns, the following partners of a grain stand in two runs: the rest of its column
    up to the next row, and three rows of the next column. Nothing is written beyond the capacity.
    """
    xs, ys, reach_of = x[order], y[order], radius[order] + 0.5 * skin
    rows, free = np.uint64(grid.rows), np.uint64(count)
    for c in range(np.uint64(cell_start.shape[0] - 1)):
        row = c % rows
        low, high = row - min(row, np.uint64(1)), min(row + np.uint64(1), rows - np.uint64(1))
        column_end = np.uint64(cell_start[c - row + high + np.uint64(1)])
        begin = end = np.uint64(0)
        if c - row + rows < np.uint64(cell_start.shape[0] - 1):
            begin = np.uint64(cell_start[c - row + rows + low])
            end = np.uint64(cell_start[c - row + rows + high + np.uint64(1)])
        for a in range(np.uint64(cell_start[c]), np.uint64(cell_start[c + np.uint64(1)])):
            for run in range(2):
                first, last = (begin, end) if run else (a + np.uint64(1), column_end)
                for b in range(first, last):
                    dx, dy, reach = xs[b] - xs[a], ys[b] - ys[a], reach_of[b] + reach_of[a]
                    if dx * dx + dy * dy < reach * reach:
                        i, j = order[a], order[b]
                        if body[i] != body[j] or body[i] < 0:
                            if free < np.uint64(found.shape[0]):
                                found[free, 0], found[free, 1] = min(i, j), max(i, j)
                            free += np.uint64(1)
    return np.int64(free)


@kernel
def pairs_between(x, y, radius, body, skin, members, grid, order, cell_start, found, count):
    """Near pairs of `members` of a finer level with a coarser one. As `pairs_within`."""
    for a in range(members.shape[0]):
        i = members[a]
        c = cell_of(x[i], y[i], grid)
        column, row = c // grid.rows, c % grid.rows
        low, high = max(row - 1, 0), min(row + 1, grid.rows - 1)
        for other in range(max(column - 1, 0), min(column + 2, grid.columns)):
            for b in range(cell_start[other * grid.rows + low], cell_start[other * grid.rows + high + 1]):
                if may_touch(i, order[b], x, y, radius, body, skin):
                    if count < found.shape[0]:
                        found[count, 0], found[count, 1] = min(i, order[b]), max(i, order[b])
                    count += 1
    return count


@kernel
def rows_of(found, n):
    """Half list by rows of the lower index: first slot of each row, owner and partner of each slot."""
    start = np.zeros(n + 1, np.int64)
    for k in range(found.shape[0]):
        start[found[k, 0] + 1] += 1
    for i in range(n):
        start[i + 1] += start[i]
    place = start[:-1].copy()
    owner, partner = np.empty(found.shape[0], np.uint32), np.empty(found.shape[0], np.uint32)
    for k in range(found.shape[0]):
        slot = place[found[k, 0]]
        owner[slot], partner[slot] = found[k, 0], found[k, 1]
        place[found[k, 0]] += 1
    return start, owner, partner


@kernel
def list_walls(x, y, radius, n_free, px, py, nx, ny, skin):
    """Near pairs of free grains and walls, by grain."""
    count = 0
    for fill in range(2):
        if fill == 1:
            grain, wall = np.empty(count, np.uint32), np.empty(count, np.uint32)
        count = 0
        for i in range(n_free):
            for w in range(px.shape[0]):
                if (x[i] - px[w]) * nx[w] + (y[i] - py[w]) * ny[w] < radius[i] + skin:
                    if fill == 1:
                        grain[count], wall[count] = i, w
                    count += 1
    return grain, wall


@kernel
def carry_pairs(old_of, old_start, old_partner, old_history, start, partner, history):
    """Copy spring, moment and dashpots of every pair that was listed before.

    `old_of` (n,) maps the new number of a grain to its old one. If the owner changes, what turns
    the owner (rolling) changes sign; the tangential force does not (its tangent turns as well).
    """
    spring, moment, dash_n, dash_t, dash_r = history
    old_spring, old_moment, old_dash_n, old_dash_t, old_dash_r = old_history
    for i in range(old_of.shape[0]):
        for k in range(start[i], start[i + 1]):
            a, b = old_of[i], old_of[partner[k]]
            sign = 1.0
            if a > b:
                a, b, sign = b, a, -1.0
            for slot in range(old_start[a], old_start[a + 1]):
                if old_partner[slot] == b:
                    if spring.shape[0]:
                        spring[k] = old_spring[slot]
                    if moment.shape[0]:
                        moment[k] = sign * old_moment[slot]
                    if dash_n.shape[0]:
                        dash_n[k] = old_dash_n[slot]
                        dash_t[k] = old_dash_t[slot]
                    if dash_r.shape[0]:
                        dash_r[k] = sign * old_dash_r[slot]
                    break


@kernel
def carry_walls(old_of, n_free, old_grain, old_wall, old_history, grain, wall, history):
    """Copy the history of every grain and wall that were listed before."""
    spring, moment, dash_n, dash_t, dash_r = history
    old_spring, old_moment, old_dash_n, old_dash_t, old_dash_r = old_history
    first = np.full(n_free, -1, np.int64)
    for k in range(old_grain.shape[0] - 1, -1, -1):
        first[old_grain[k]] = k
    for k in range(grain.shape[0]):
        old = old_of[grain[k]]
        slot = first[old]
        while 0 <= slot < old_grain.shape[0] and old_grain[slot] == old:
            if old_wall[slot] == wall[k]:
                if spring.shape[0]:
                    spring[k] = old_spring[slot]
                if moment.shape[0]:
                    moment[k] = old_moment[slot]
                if dash_n.shape[0]:
                    dash_n[k] = old_dash_n[slot]
                    dash_t[k] = old_dash_t[slot]
                if dash_r.shape[0]:
                    dash_r[k] = old_dash_r[slot]
                break
            slot += 1


@kernel
def list_crossings(block_start, start, partner):
    """Contacts whose partner lies in a later block, by owner's block and by partner.

    Returns crossing_start, incoming_grain, incoming_start, incoming, incoming_block, first_source.
    """
    n, n_blocks = start.shape[0] - 1, block_start.shape[0] - 1
    crossing_start = np.zeros(n_blocks + 1, np.int64)
    hits = np.zeros(n + 1, np.int64)
    for b in range(n_blocks):
        count = 0
        for k in range(start[block_start[b]], start[block_start[b + 1]]):
            if partner[k] >= block_start[b + 1]:
                hits[partner[k] + 1] += 1
                count += 1
        crossing_start[b + 1] = crossing_start[b] + count
    incoming_grain = np.nonzero(hits[1:])[0]
    incoming_start = np.zeros(incoming_grain.shape[0] + 1, np.int64)
    for a in range(incoming_grain.shape[0]):
        incoming_start[a + 1] = incoming_start[a] + hits[incoming_grain[a] + 1]
        hits[incoming_grain[a]] = incoming_start[a]
    incoming = np.empty(crossing_start[n_blocks], np.int64)
    first_source = np.arange(n_blocks)
    number = 0
    for b in range(n_blocks):
        for k in range(start[block_start[b]], start[block_start[b + 1]]):
            if partner[k] >= block_start[b + 1]:
                incoming[hits[partner[k]]] = number
                hits[partner[k]] += 1
                number += 1
                target = np.searchsorted(block_start, partner[k], side="right") - 1
                first_source[target] = min(first_source[target], b)
    incoming_block = np.searchsorted(incoming_grain, block_start)
    return crossing_start, incoming_grain, incoming_start, incoming, incoming_block, first_source
