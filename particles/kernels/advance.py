"""The time loop: steps inside compiled code until the count is done or the contact list is stale."""

import numba
import numpy as np

from particles.kernels.facets import facet_forces, move_nodes, receive_pushes
from particles.kernels.forces import clear_forces, pair_forces, wall_forces
from particles.kernels.jit import kernel, threaded_kernel
from particles.kernels.laws.response import Laws
from particles.kernels.laws.tangential import present
from particles.kernels.motion import add_incoming, drift, kick, prescribed_work
from particles.kernels.shaking import carry, shake


@kernel
def block_forces(b, grains, pairs, walls, facets, normal, tangential, rolling, lead, ledger, dt):
    laws = Laws(normal, tangential, rolling)  # numba's threads take tuples, but no tuples of tuples
    clear_forces(b, grains, present(tangential))
    pair_forces(b, grains, pairs, laws, lead, ledger, dt)
    wall_forces(b, grains, walls, laws, lead, ledger, dt)
    facet_forces(b, grains, facets, laws, lead, ledger, dt)


@kernel
def receive(b, grains, ledger, dt):
    """Impulse on the prescribed grains (block `b`), and their work over the half step that ends now."""
    first = grains.block_start[b]
    for i in range(first, grains.block_start[b + 1]):
        grains.impulse[i - first, 0] += dt * grains.fx[i]
        grains.impulse[i - first, 1] += dt * grains.fy[i]
        grains.impulse[i - first, 2] += dt * grains.torque[i]
    if ledger is not None:
        prescribed_work(b, grains, ledger, dt)


@kernel
def block_motion(b, grains, pairs, gravity_x, gravity_y, tangential, damping, lead, ledger, reach2, drifts, dt):
    """Kick block `b` (the prescribed one receives instead) and drift it into the next step if there is one."""
    add_incoming(b, grains, pairs, present(tangential))
    if b == grains.block_start.shape[0] - 2:
        receive(b, grains, ledger, dt)
    else:
        kick(b, grains, gravity_x, gravity_y, present(tangential), damping, lead, ledger, dt)
    if drifts:
        return block_drift(b, grains, tangential, ledger, reach2, dt)
    return 0


@kernel
def block_drift(b, grains, tangential, ledger, reach2, dt):
    if ledger is not None and b == grains.block_start.shape[0] - 2:
        prescribed_work(b, grains, ledger, dt)
    return drift(b, grains, present(tangential), reach2, dt)


@kernel
def move_walls(walls, shaking, step, reach2, dt):
    """Move the walls to a step. True if one went farther along its normal than sqrt(reach2) since the list was made."""
    stale = False
    if shaking is not None:
        shake(walls, shaking, step, dt)
    for w in range(walls.px.shape[0]):
        if shaking is None or not shaking.moves[w]:
            walls.px[w] += dt * walls.vx[w]
            walls.py[w] += dt * walls.vy[w]
        dx, dy = walls.px[w] - walls.px_listed[w], walls.py[w] - walls.py_listed[w]
        towards = dx * walls.nx[w] + dy * walls.ny[w]
        stale |= not (towards * towards <= reach2)
    return stale


@kernel
def move_rows(grains, shaking, lead, ledger, step, reach2, dt):
    """Move the prescribed grains that shake with the walls to a step. True if one went too far for the list."""
    if shaking is None:
        return False
    return carry(shaking.carried, grains, shaking, lead, ledger, step, reach2, dt)


def _forces(grains, pairs, walls, facets, normal, tangential, rolling, lead, ledger, dt):
    """All contact forces at the present positions."""
    n_blocks = grains.block_start.shape[0] - 1
    for b in numba.prange(n_blocks):
        block_forces(b, grains, pairs, walls, facets, normal, tangential, rolling, lead, ledger, dt)
    for b in numba.prange(n_blocks):
        add_incoming(b, grains, pairs, present(tangential))
    receive_pushes(facets, ledger, dt)


def _advance(
    grains, pairs, walls, shaking, facets, gravity, normal, tangential, rolling, damping, lead, ledger,
    done, drifted, reach2, steps, dt, teams,
):  # fmt: skip
    """Up to `steps` leapfrog steps after the `done` ones: drift, contact forces, kick.

    Returns the number of steps done, and 1 if the list went stale: then the grains have drifted
    into the next step and wait for a new list (`drifted` at the next call). The kick of a step and
    the drift of the next follow the forces of the same block while it is in the cache: contacts
    with earlier blocks are done by then, and no later block looks back. Only a block that gets
    forces from the blocks of another team waits for the second loop.
    """
    n_blocks = grains.block_start.shape[0] - 1
    if grains.block_start[n_blocks] == grains.block_start[n_blocks - 1]:
        n_blocks -= 1  # nothing is prescribed
    source = pairs.first_source
    gravity_x, gravity_y = gravity[0], gravity[1]
    stale = np.zeros(n_blocks, np.int64)
    if steps > 0 and not drifted:
        for b in numba.prange(n_blocks):
            stale[b] = block_drift(b, grains, tangential, ledger, reach2, dt)
        moved = move_walls(walls, shaking, done + 1, reach2, dt)
        moved |= move_rows(grains, shaking, lead, ledger, done + 1, reach2, dt)
        if moved | move_nodes(facets, ledger, reach2, dt) | stale.any():
            return 0, 1
    for step in range(steps):
        drifts = step + 1 < steps
        for team in numba.prange(teams):
            first = team * n_blocks // teams
            for b in range(first, (team + 1) * n_blocks // teams):
                block_forces(b, grains, pairs, walls, facets, normal, tangential, rolling, lead, ledger, dt)
                if source[b] >= first:
                    stale[b] = block_motion(
                        b, grains, pairs, gravity_x, gravity_y, tangential, damping, lead, ledger, reach2, drifts, dt
                    )
        for team in numba.prange(teams):
            first = team * n_blocks // teams
            for b in range(first, (team + 1) * n_blocks // teams):
                if source[b] < first:
                    stale[b] = block_motion(
                        b, grains, pairs, gravity_x, gravity_y, tangential, damping, lead, ledger, reach2, drifts, dt
                    )
        receive_pushes(facets, ledger, dt)
        if not drifts:
            break
        moved = move_walls(walls, shaking, done + step + 2, reach2, dt)
        moved |= move_rows(grains, shaking, lead, ledger, done + step + 2, reach2, dt)
        if moved | move_nodes(facets, ledger, reach2, dt) | stale.any():
            return step + 1, 1
    return steps, 0


advance = kernel(_advance)
advance_threaded = threaded_kernel(_advance)
forces = kernel(_forces)
