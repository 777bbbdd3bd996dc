"""Walls and prescribed grains that shake: where they are follows from the number of the step alone."""

import math

import numpy as np

from particles.kernels.jit import kernel


@kernel
def eased(share):
    """Cubic from 0 at 0 to 1 at 1 with level ends."""
    u = min(max(share, 0.0), 1.0)
    return u * u * (3.0 - 2.0 * u)


@kernel
def displacement(shaking, time):
    """Displacement [m] of the walls at a time [s]."""
    since = time - shaking.start
    if since <= 0.0 or (shaking.ramp == 0.0 and time >= shaking.stop):
        return 0.0
    turns = since / shaking.period
    turns -= math.floor(turns)
    if shaking.from_rest:
        half = math.sin(math.pi * turns)
        wave = 2.0 * half * half
    else:
        wave = math.sin(2.0 * math.pi * turns)
    if shaking.ramp > 0.0:
        wave *= eased(since / shaking.ramp) * (1.0 - eased((time - shaking.stop) / shaking.ramp))
    return shaking.amplitude * wave


@kernel
def motion(shaking, step, dt):
    """Displacement at a step, the velocity of the half step before, and what that gains until the present."""
    before, here = displacement(shaking, (step - 1) * dt), displacement(shaking, step * dt)
    speed, next_speed = (here - before) / dt, (displacement(shaking, (step + 1) * dt) - here) / dt
    return here, speed, 0.5 * (next_speed - speed)


@kernel
def displacements(shaking, times):
    """Displacements (n,) [m] at times (n,) [s]."""
    found = np.empty(times.shape[0])
    for k in range(times.shape[0]):
        found[k] = displacement(shaking, times[k])
    return found


@kernel
def shake(walls, shaking, step, dt):
    """Put the walls that shake where they are at a step, with the velocity that took them there in one step.

    The velocity of the half step is a difference of displacements, so that its work is that over the
    very path; what it gains until the present comes from the next one.
    """
    here, speed, gain = motion(shaking, step, dt)
    for w in range(walls.px.shape[0]):
        if shaking.moves[w]:
            walls.px[w] = shaking.home_x[w] + here * shaking.along_x
            walls.py[w] = shaking.home_y[w] + here * shaking.along_y
            walls.vx[w], walls.vy[w] = speed * shaking.along_x, speed * shaking.along_y
            walls.gain_x[w], walls.gain_y[w] = gain * shaking.along_x, gain * shaking.along_y


@kernel
def carry(carried, grains, shaking, lead, ledger, step, reach2, dt):
    """Put the prescribed grains that move along where they are at a step. True if one left its list, as in `drift`.

    The step before has drifted them and booked half a step of their work with the velocity it had; both are brought to
    the velocity that takes them here.
    """
    if carried is None:
        return False
    here, speed, gain = motion(shaking, step, dt)
    vx, vy = speed * shaking.along_x, speed * shaking.along_y
    first = grains.block_start[grains.block_start.shape[0] - 2]
    stale = False
    for k in range(carried.shape[0]):
        i = carried[k]
        if ledger is not None:
            gained = grains.fx[i] * (vx - grains.vx[i]) + grains.fy[i] * (vy - grains.vy[i])
            ledger.prescribed_work[i - first] -= 0.5 * dt * gained
        grains.x[i] = shaking.carried_x[k] + here * shaking.along_x
        grains.y[i] = shaking.carried_y[k] + here * shaking.along_y
        grains.vx[i], grains.vy[i] = vx, vy
        if lead is not None:
            lead.x[i], lead.y[i] = gain * shaking.along_x, gain * shaking.along_y
        dx, dy = grains.x[i] - grains.x_listed[i], grains.y[i] - grains.y_listed[i]
        stale |= not (dx * dx + dy * dy <= reach2)
    return stale
