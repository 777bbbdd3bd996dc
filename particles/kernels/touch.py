"""One contact in one step: its laws, its memory, its losses. Grain pairs and walls alike."""

from particles.kernels.jit import inner_kernel, kernel
from particles.kernels.laws import let_go, respond, rolling_stiffness
from particles.kernels.layout import (
    NORMAL_DASHPOT,
    ROLLING_DASHPOT,
    ROLLING_SLIP,
    SLIDING,
    TANGENTIAL_DASHPOT,
    Lost,
)


@inner_kernel
def touch(touching, normal, tangential, rolling, ledger, meeting, memory, lost, dt):
    """Response of one contact to its `memory` of the step before, and `lost` with its losses added.

    Numbers only: an array handed to a function of the inner loop may cost a count of references.
    """
    if touching:
        response = respond(normal, tangential, rolling, meeting, memory.spring, memory.moment, dt)
    else:
        response = let_go(tangential, rolling, meeting, memory.spring, memory.moment, dt)
    if ledger is None:
        return response, lost
    lost_s, lost_t, lost_p, lost_r = lost.s, lost.t, lost.p, lost.r
    lost_n = lost.n - (memory.dash_n + response.dash_n) * meeting.v_n
    if tangential is not None:
        lost_s += (memory.spring + response.spring) * response.cut_t
        lost_t += (memory.dash_t + response.dash_t) * meeting.v_t
        if rolling is not None:
            if response.cut_r != 0.0:
                k_r = rolling_stiffness(rolling, tangential.k_t, meeting.r_r)
                lost_p += (memory.moment + response.moment) * response.cut_r / k_r
            lost_r -= (memory.dash_r + response.dash_r) * meeting.omega_r
    return response, Lost(lost_n, lost_t, lost_r, lost_s, lost_p)


@kernel
def add_losses(b, tangential, ledger, lost, dt):
    """Enter one step's losses of block `b`.

    All are trapezoidal works over the step, with the half-step velocity of the leapfrog: exactly
    what the integrator takes from the kinetic energy m v(n-1/2) v(n+1/2) / 2, up to the turn of
    the normal within one step. A slider loses its mean force times the slip (cut / stiffness),
    the part of the motion that did not stretch its spring; opening is a slip to zero force.
    """
    if ledger is not None:
        ledger.loss[b, NORMAL_DASHPOT] += 0.5 * dt * lost.n
        ledger.loss[b, TANGENTIAL_DASHPOT] += 0.5 * dt * lost.t
        ledger.loss[b, ROLLING_DASHPOT] += 0.5 * dt * lost.r
        ledger.loss[b, ROLLING_SLIP] += 0.5 * lost.p
        if tangential is not None:
            ledger.loss[b, SLIDING] += 0.5 * lost.s / tangential.k_t
