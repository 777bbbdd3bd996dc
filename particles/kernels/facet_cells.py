"""Which features of a polyline a disc may touch soon: boxes around them, put into cells."""

import math

import numpy as np

from particles.kernels.cells import cell_of
from particles.kernels.features import side_of
from particles.kernels.jit import inner_kernel, kernel


@inner_kernel
def distance2(facets, f, x, y):
    """Square of the distance from (x, y) to feature f."""
    a, c, b = facets.before[f], facets.at[f], facets.after[f]
    if c >= 0:
        return (x - facets.x[c]) ** 2 + (y - facets.y[c]) ** 2
    tx, ty = facets.x[b] - facets.x[a], facets.y[b] - facets.y[a]
    dx, dy = x - facets.x[a], y - facets.y[a]
    share = min(max((dx * tx + dy * ty) / (tx * tx + ty * ty), 0.0), 1.0)
    return (dx - share * tx) ** 2 + (dy - share * ty) ** 2


@kernel
def features_by_cell(low, high, grid):
    """First place of each cell, and the features whose box (low, high) (n, 2) reaches into it, ascending."""
    cells = grid.columns * grid.rows
    start = np.zeros(cells + 1, np.int64)
    for fill in range(2):
        if fill == 1:
            for c in range(cells):
                start[c + 1] += start[c]
            place, members = start[:-1].copy(), np.empty(start[cells], np.int64)
        for f in range(low.shape[0]):
            first, last = cell_of(low[f, 0], low[f, 1], grid), cell_of(high[f, 0], high[f, 1], grid)
            for column in range(first // grid.rows, last // grid.rows + 1):
                for row in range(first % grid.rows, last % grid.rows + 1):
                    c = column * grid.rows + row
                    if fill == 1:
                        members[place[c]] = f
                        place[c] += 1
                    else:
                        start[c + 1] += 1
    return start, members


@kernel
def list_features(x, y, radius, facets, skin, low, high, grid):
    """Near pairs of grains and features, by grain and then by feature, and the side of each."""
    start, members = features_by_cell(low, high, grid)
    x_low, y_low, x_high, y_high = low[:, 0].min(), low[:, 1].min(), high[:, 0].max(), high[:, 1].max()
    count = 0
    for fill in range(2):
        if fill == 1:
            grain, feature = np.empty(count, np.uint32), np.empty(count, np.uint32)
            side = np.empty(count, np.uint8)
        count = 0
        for i in range(x.shape[0]):
            if not (x_low <= x[i] <= x_high and y_low <= y[i] <= y_high):
                continue
            c, reach = cell_of(x[i], y[i], grid), radius[i] + skin
            for m in range(start[c], start[c + 1]):
                if distance2(facets, members[m], x[i], y[i]) < reach * reach:
                    if fill == 1:
                        grain[count], feature[count] = i, members[m]
                        side[count] = side_of(facets, members[m], x[i], y[i])
                    count += 1
    return grain, feature, side


@kernel
def deepest_inside(grains, facets):
    """Overlap over radius of the free grain whose centre is deepest inside closed polylines, and its place or -1.

    A centre is inside if a ray from it crosses the polylines an odd number of times. Open ones have no inside.
    """
    x, y, radius = grains.x, grains.y, grains.radius
    n_free = grains.block_start[grains.block_start.shape[0] - 2]
    worst, at = 0.0, -1
    if facets.following.min() < 0:
        return worst, at
    left, right, low, high = facets.x.min(), facets.x.max(), facets.y.min(), facets.y.max()
    for i in range(n_free):
        if not (left <= x[i] <= right and low <= y[i] <= high):
            continue
        inside, nearest2 = False, np.inf
        for f in range(facets.at.shape[0]):
            if facets.at[f] < 0:
                ax, ay = facets.x[facets.before[f]], facets.y[facets.before[f]]
                bx, by = facets.x[facets.after[f]], facets.y[facets.after[f]]
                if (ay > y[i]) != (by > y[i]) and x[i] < ax + (y[i] - ay) / (by - ay) * (bx - ax):
                    inside = not inside
                nearest2 = min(nearest2, distance2(facets, f, x[i], y[i]))
        depth = 1.0 + math.sqrt(nearest2) / radius[i]
        if inside and depth > worst:
            worst, at = depth, i
    return worst, at
