"""How deep grains have been in each other and in walls during the last step, those included that passed through."""

import math

from particles.kernels.jit import inner_kernel, kernel
from particles.kernels.periodic import nearest


@inner_kernel
def deeper_on_way(grains, i, j, depth, dt):
    """Largest overlap of a pair over its smaller radius on its straight way of the last step, if above `depth`."""
    x = nearest(grains.period_x, grains.x[j] - grains.x[i])
    y = nearest(grains.period_y, grains.y[j] - grains.y[i])
    ux, uy = grains.vx[j] - grains.vx[i], grains.vy[j] - grains.vy[i]
    parting = x * ux + y * uy
    if parting > 0.0:
        back = min(parting / (ux * ux + uy * uy), dt)
        x, y = x - back * ux, y - back * uy
    reach, smaller = grains.radius[i] + grains.radius[j], min(grains.radius[i], grains.radius[j])
    far = reach - depth * smaller
    if far <= 0.0 or x * x + y * y >= far * far:
        return depth
    return (reach - math.hypot(x, y)) / smaller


@kernel
def deepest_listed(grains, pairs, walls, dt):
    """Depth, grain and partner of the deepest listed pair; then depth, grain and number of the wall. -1: none."""
    n_free = grains.block_start[grains.block_start.shape[0] - 2]
    depth, at, other = 0.0, -1, -1
    for k in range(pairs.start[n_free]):
        found = deeper_on_way(grains, pairs.owner[k], pairs.partner[k], depth, dt)
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
                found = deeper_on_way(grains, i, j, depth, dt)
                if found > depth:
                    depth, at, other = found, i, j
        if depth > enough:
            break
    return depth, at, other
