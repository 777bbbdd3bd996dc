"""Walls that shake: where they are follows from the number of the step alone."""

import math

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
def shake(walls, shaking, step, dt):
    """Put the walls that shake where they are at a step, with the velocity that took them there in one step.

    The velocity of the half step is a difference of displacements, so that its work is that over the
    very path; what it gains until the present comes from the next one.
    """
    before, here = displacement(shaking, (step - 1) * dt), displacement(shaking, step * dt)
    speed, next_speed = (here - before) / dt, (displacement(shaking, (step + 1) * dt) - here) / dt
    gain = 0.5 * (next_speed - speed)
    for w in range(walls.px.shape[0]):
        if shaking.moves[w]:
            walls.px[w] = shaking.home_x[w] + here * shaking.along_x
            walls.py[w] = shaking.home_y[w] + here * shaking.along_y
            walls.vx[w], walls.vy[w] = speed * shaking.along_x, speed * shaking.along_y
            walls.gain_x[w], walls.gain_y[w] = gain * shaking.along_x, gain * shaking.along_y
