"""Contact search: uniform cells, counted by columns, and the half list of near pairs (model 1.5).

Free grains are stored in the order of their cells, columns first. A grain's partners with a
higher number then stand in two runs of memory: the rest of its own column up to the next row,
and three rows of the next column.
"""

import numpy as np

from particles.kernels.jit import kernel


@kernel
def cell_of(x, y, x_min, y_min, size, columns, rows):
    column = min(max(int((x - x_min) / size), 0), columns - 1)
    row = min(max(int((y - y_min) / size), 0), rows - 1)
    return column * rows + row


@kernel
def sort_by_cell(x, y, first, last, x_min, y_min, size, columns, rows):
    """Stable counting sort. Returns the order and the first place of each cell."""
    cell_start = np.zeros(columns * rows + 1, np.int64)
    cells = np.empty(last - first, np.int64)
    for i in range(first, last):
        cells[i - first] = cell_of(x[i], y[i], x_min, y_min, size, columns, rows)
        cell_start[cells[i - first] + 1] += 1
    for c in range(columns * rows):
        cell_start[c + 1] += cell_start[c]
    place = cell_start[:-1].copy()
    order = np.empty(last - first, np.int64)
    for i in range(first, last):
        order[place[cells[i - first]]] = i
        place[cells[i - first]] += 1
    return order, cell_start


@kernel
def is_near(i, j, x, y, radius, skin):
    dx, dy, reach = x[j] - x[i], y[j] - y[i], radius[i] + radius[j] + skin
    return dx * dx + dy * dy < reach * reach


@kernel
def list_free_pairs(x, y, radius, n_free, skin, x_min, y_min, size, columns, rows, cell_start, start, partner):
    """Rows of near free pairs, partner above owner. Returns the slots needed, stored or not."""
    count = 0
    capacity = partner.shape[0]
    for i in range(n_free):
        start[i] = count
        c = cell_of(x[i], y[i], x_min, y_min, size, columns, rows)
        column, row = c // rows, c % rows
        low, high = max(row - 1, 0), min(row + 1, rows - 1)
        for j in range(i + 1, cell_start[column * rows + high + 1]):
            if is_near(i, j, x, y, radius, skin):
                if count < capacity:
                    partner[count] = j
                count += 1
        if column + 1 < columns:
            base = (column + 1) * rows
            for j in range(cell_start[base + low], cell_start[base + high + 1]):
                if is_near(i, j, x, y, radius, skin):
                    if count < capacity:
                        partner[count] = j
                    count += 1
    start[n_free] = count
    return count


@kernel
def list_prescribed_pairs(
    x, y, radius, body, n_free, skin, x_min, y_min, size, columns, rows, order, cell_start, free_row, partner, start
):
    """Merge the free rows with each grain's prescribed partners of other bodies.

    `free_row, partner` are the free rows; returns the merged partners, `start` is rewritten.
    """
    n = x.shape[0]
    merged = np.empty(partner.shape[0] + 16 + 8 * (n - n_free), np.int32)
    count = 0
    for i in range(n):
        row_begin = count
        if i < n_free:
            for k in range(free_row[i], free_row[i + 1]):
                if count == merged.shape[0]:
                    merged = _grow(merged)
                merged[count] = partner[k]
                count += 1
        c = cell_of(x[i], y[i], x_min, y_min, size, columns, rows)
        column, row = c // rows, c % rows
        low, high = max(row - 1, 0), min(row + 1, rows - 1)
        for other in range(max(column - 1, 0), min(column + 2, columns)):
            for a in range(cell_start[other * rows + low], cell_start[other * rows + high + 1]):
                j = order[a]
                if j > i and body[i] != body[j] and is_near(i, j, x, y, radius, skin):
                    if count == merged.shape[0]:
                        merged = _grow(merged)
                    merged[count] = j
                    count += 1
        start[i] = row_begin
    start[n] = count
    return merged[:count].copy()


@kernel
def _grow(array):
    larger = np.empty(2 * array.shape[0], array.dtype)
    larger[: array.shape[0]] = array
    return larger


@kernel
def list_walls(x, y, radius, n_free, px, py, nx, ny, skin):
    """Near pairs of free grains and walls, by grain."""
    count = 0
    for fill in range(2):
        if fill == 1:
            grain, wall = np.empty(count, np.int32), np.empty(count, np.int32)
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
                        moment[k] = sign * old_moment[slot]
                    if dash_n.shape[0]:
                        dash_n[k] = old_dash_n[slot]
                        dash_t[k] = old_dash_t[slot]
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
                    moment[k] = old_moment[slot]
                if dash_n.shape[0]:
                    dash_n[k] = old_dash_n[slot]
                    dash_t[k] = old_dash_t[slot]
                    dash_r[k] = old_dash_r[slot]
                break
            slot += 1


@kernel
def list_crossings(block_start, start, partner):
    """Contacts whose partner lies in a later block, by owner's block and by partner.

    Returns crossing_start, incoming_grain, incoming_start, incoming, incoming_block.
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
    number = 0
    for b in range(n_blocks):
        for k in range(start[block_start[b]], start[block_start[b + 1]]):
            if partner[k] >= block_start[b + 1]:
                incoming[hits[partner[k]]] = number
                hits[partner[k]] += 1
                number += 1
    incoming_block = np.searchsorted(incoming_grain, block_start)
    return crossing_start, incoming_grain, incoming_start, incoming, incoming_block
