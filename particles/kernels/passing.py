"""How deep grains have been in each other and in walls during the last step, those included that passed through."""

import math

from particles.kernels.jit import inner_kernel, kernel
from particles.kernels.periodic import nearest


@inner_kernel
def depth_on_way(x, y, ux, uy, reach, smaller, dt):
    """Largest overlap over the smaller radius, along a straight way that ended `dt` later at (x, y) with velocity u."""
    speed2, back = ux * ux + uy * uy, 0.0
    if speed2 > 0.0:
        back = min(max((x * ux + y * uy) / speed2, 0.0), dt)
    return (reach - math.hypot(x - back * ux, y - back * uy)) / smaller


@inner_kernel
def depth_of_pair(grains, i, j, dt):
    dx = nearest(grains.period_x, grains.x[j] - grains.x[i])
    dy = nearest(grains.period_y, grains.y[j] - grains.y[i])
    ux, uy = grains.vx[j] - grains.vx[i], grains.vy[j] - grains.vy[i]
    r_i, r_j = grains.radius[i], grains.radius[j]
    return depth_on_way(dx, dy, ux, uy, r_i + r_j, min(r_i, r_j), dt)


@kernel
def deepest_listed(grains, pairs, walls, dt):
    """Depth, grain and partner of the deepest listed pair; then depth, grain and number of the wall. -1: none."""
    n_free = grains.block_start[grains.block_start.shape[0] - 2]
    depth, at, other = 0.0, -1, -1
    for k in range(pairs.start[n_free]):
        found = depth_of_pair(grains, pairs.owner[k], pairs.partner[k], dt)
        if found > depth:
            depth, at, other = found, pairs.owner[k], pairs.partner[k]
    in_wall, grain, wall = 0.0, -1, -1
    for k in range(walls.grain.shape[0]):
        i, w = walls.grain[k], walls.wall[k]
        gap = (grains.x[i] - walls.px[w]) * walls.nx[w] + (grains.y[i] - walls.py[w]) * walls.ny[w]
        found = 1.0 - gap / grains.radius[i]
        if found > in_wall:
            in_wall, grain, wall = found, i, w
    return depth, at, other, in_wall, grain, wall


@kernel
def deepest_of(fast, grains, body, enough, dt):
    """Depth and places of the pairs of `fast` grains with any other; the search ends at a depth above `enough`."""
    n_free = grains.block_start[grains.block_start.shape[0] - 2]
    depth, at, other = 0.0, -1, -1
    for i in fast:
        for j in range(grains.x.shape[0]):
            if i != j and (i < n_free or j < n_free) and (body[i] != body[j] or body[i] < 0):
                found = depth_of_pair(grains, i, j, dt)
                if found > depth:
                    depth, at, other = found, i, j
        if depth > enough:
            break
    return depth, at, other
