"""The time loop: steps inside compiled code until the count is done or the contact list is stale."""

import numba
import numpy as np

from particles.kernels.forces import clear_forces, pair_forces, wall_forces
from particles.kernels.jit import kernel, threaded_kernel
from particles.kernels.motion import add_incoming, drift, kick, prescribed_work


@kernel
def block_forces(b, grains, pairs, walls, normal, tangential, rolling, ledger, dt):
    clear_forces(b, grains)
    pair_forces(b, grains, pairs, normal, tangential, rolling, ledger, dt)
    wall_forces(b, grains, walls, normal, tangential, rolling, ledger, dt)


@kernel
def prescribed_forces(grains, pairs, spins, ledger, dt):
    b = grains.block_start.shape[0] - 2
    add_incoming(b, grains, pairs, spins)
    first = grains.block_start[b]
    for i in range(first, grains.block_start[b + 1]):
        grains.impulse[i - first, 0] += dt * grains.fx[i]
        grains.impulse[i - first, 1] += dt * grains.fy[i]
    if ledger is not None:
        prescribed_work(b, grains, ledger, dt)


def _forces(grains, pairs, walls, normal, tangential, rolling, ledger, dt):
    """All contact forces at the present positions."""
    n_blocks = grains.block_start.shape[0] - 1
    for b in numba.prange(n_blocks):
        block_forces(b, grains, pairs, walls, normal, tangential, rolling, ledger, dt)
    for b in numba.prange(n_blocks):
        add_incoming(b, grains, pairs, tangential is not None)


@kernel
def move_walls(walls, reach2, dt):
    """Move the walls. True if one went farther than sqrt(reach2) since the list was made."""
    stale = False
    for w in range(walls.px.shape[0]):
        walls.px[w] += dt * walls.vx[w]
        walls.py[w] += dt * walls.vy[w]
        dx, dy = walls.px[w] - walls.px_listed[w], walls.py[w] - walls.py_listed[w]
        stale |= not (dx * dx + dy * dy <= reach2)
    return stale


def _advance(
    grains, pairs, walls, gravity, normal, tangential, rolling, damping, ledger, drifted, reach2, steps, dt
):
    """Up to `steps` leapfrog steps: drift, contact forces, kick.

    Returns the number of steps done, and 1 if the list went stale: then the grains have drifted
    into the next step and wait for a new list (`drifted` at the next call).
    """
    n_blocks = grains.block_start.shape[0] - 1
    gravity_x, gravity_y = gravity[0], gravity[1]
    spins = tangential is not None
    stale = np.zeros(n_blocks, np.int64)
    for step in range(steps):
        if step > 0 or not drifted:
            if ledger is not None:
                prescribed_work(n_blocks - 1, grains, ledger, dt)
            for b in numba.prange(n_blocks):
                stale[b] = drift(b, grains, spins, reach2, dt)
            if move_walls(walls, reach2, dt) or stale.any():
                return step, 1
        for b in numba.prange(n_blocks):
            block_forces(b, grains, pairs, walls, normal, tangential, rolling, ledger, dt)
        for b in numba.prange(n_blocks - 1):
            add_incoming(b, grains, pairs, spins)
            kick(b, grains, gravity_x, gravity_y, tangential, damping, ledger, dt)
        prescribed_forces(grains, pairs, spins, ledger, dt)
    return steps, 0


advance = kernel(_advance)
advance_threaded = threaded_kernel(_advance)
forces = kernel(_forces)
