"""Discs with a normal spring and dashpot, walls and gravity in 60 lines of numba: nothing else can exist here.

Beside `particles` this shows what a scene pays for features that it does not have. It walks over the
same contact list with the same unsigned indices, in one block, and makes no list of its own.
"""

import math

import numba
import numpy as np

from particles import ParticleSystem


@numba.njit(error_model="numpy", cache=True)
def _steps(
    x, y, vx, vy, fx, fy, x_listed, y_listed, radius, inverse_mass, pairs, walls, gravity, k_n, c_n, reach2, steps, dt
):
    n, near, wall_pairs = np.uint64(len(x)), np.uint64(len(pairs[0])), np.uint64(len(walls[0]))
    owner, partner = pairs
    grain, wall, px, py, wx, wy = walls
    for step in range(steps):
        stale = False
        for i in range(n):
            x[i] += dt * vx[i]
            y[i] += dt * vy[i]
            fx[i] = fy[i] = 0.0
            dx, dy = x[i] - x_listed[i], y[i] - y_listed[i]
            stale |= not (dx * dx + dy * dy <= reach2)
        if stale:
            return step
        for k in range(near):
            i, j = owner[k], partner[k]
            dx, dy = x[j] - x[i], y[j] - y[i]
            reach, d2 = radius[i] + radius[j], dx * dx + dy * dy
            if d2 < reach * reach:
                d = math.sqrt(d2)
                nx, ny = dx / d, dy / d
                v_n = (vx[j] - vx[i]) * nx + (vy[j] - vy[i]) * ny
                f = max(k_n * (reach - d) - c_n * v_n, 0.0)
                fx[i] -= f * nx
                fy[i] -= f * ny
                fx[j] += f * nx
                fy[j] += f * ny
        for k in range(wall_pairs):
            i, w = grain[k], wall[k]
            delta = radius[i] - (x[i] - px[w]) * wx[w] - (y[i] - py[w]) * wy[w]
            if delta > 0.0:
                f = max(k_n * delta - c_n * (vx[i] * wx[w] + vy[i] * wy[w]), 0.0)
                fx[i] += f * wx[w]
                fy[i] += f * wy[w]
        for i in range(n):
            vx[i] += dt * (fx[i] * inverse_mass[i] + gravity[0])
            vy[i] += dt * (fy[i] * inverse_mass[i] + gravity[1])
    return steps


class BareGrains:
    """The discs of a system that has a normal law alone, as they are now, on its present list.

    Parameters
    ----------
    system : ParticleSystem
        With fixed walls; it stays as it is.
    """

    def __init__(self, system: ParticleSystem) -> None:
        g, pairs, walls = system.grains, system.list.pairs, system.list.walls
        copies = (g.x, g.y, g.vx, g.vy, g.fx, g.fy, g.x_listed, g.y_listed, g.radius, g.inverse_mass)
        self._arrays = tuple(array.copy() for array in copies)
        self.x, self.y = self._arrays[:2]
        self._lists = (pairs.owner, pairs.partner), (walls.grain, walls.wall, walls.px, walls.py, walls.nx, walls.ny)
        law = system.contact.normal
        self._numbers = (tuple(system.gravity), law.stiffness, law.damping, system.list.reach2)
        self._dt = system.time_step

    def advance(self, steps: int) -> None:
        """Take steps; the list must hold."""
        if _steps(*self._arrays, *self._lists, *self._numbers, steps, self._dt) < steps:
            raise RuntimeError("a grain has left the contact list: take fewer steps")
