"""One contact in one step: its laws, its memory, its losses. Grain pairs and walls alike."""

from typing import NamedTuple

from particles.kernels.jit import inner_kernel, kernel
from particles.kernels.laws.response import let_go, respond, slip_energies
from particles.kernels.laws.rolling import turns_dashpot, turns_spring
from particles.kernels.laws.tangential import present
from particles.kernels.layout import NORMAL_DASHPOT, ROLLING_DASHPOT, ROLLING_SLIP, SLIDING, TANGENTIAL_DASHPOT


class Memory(NamedTuple):
    """What a contact knows of the step before: its springs, and its dashpots for the ledger."""

    spring: float
    moment: float
    dash_n: float
    dash_t: float
    dash_r: float


class Lost(NamedTuple):
    """Sums over the contacts of one block in one step, to be scaled by `add_losses`."""

    n: float  # powers of the dashpots, at both ends of the step
    t: float
    r: float
    s: float  # twice the energies that the springs lost by slip
    p: float


NOTHING_LOST = Lost(0.0, 0.0, 0.0, 0.0, 0.0)


@inner_kernel
def touch(touching, laws, ledger, meeting, now, memory, lost, dt):
    """Response of one contact to its `memory` of the step before, and `lost` with its losses added.

    Numbers only: an array handed to a function of the inner loop may cost a count of references.
    """
    if touching:
        response = respond(laws, meeting, now, memory.spring, memory.moment, dt)
    else:
        response = let_go(laws, meeting, memory.spring, memory.moment, dt)
    if ledger is None:
        return response, lost
    lost_t, lost_r, lost_s, lost_p = lost.t, lost.r, lost.s, lost.p
    slip_t, slip_r = slip_energies(laws, meeting, memory.spring, memory.moment, response, dt)
    lost_n = lost.n - (memory.dash_n + response.dash_n) * meeting.v_n
    if present(laws.tangential):
        lost_t += (memory.dash_t + response.dash_t) * meeting.v_t
        lost_s += slip_t
    if turns_spring(laws.rolling):
        lost_p += slip_r
    if turns_dashpot(laws.rolling):
        lost_r -= (memory.dash_r + response.dash_r) * meeting.omega_r
    return response, Lost(lost_n, lost_t, lost_r, lost_s, lost_p)


@kernel
def add_losses(b, ledger, lost, dt):
    """Enter one step's losses of block `b`.

    All are trapezoidal works over the step, with the half-step velocity of the leapfrog: exactly
    what the integrator takes from the kinetic energy m v(n-1/2) v(n+1/2) / 2, up to the turn of
    the normal within one step. A slider loses its mean force times the slip, the part of the
    motion that did not stretch its spring; opening is a slip to zero force.
    """
    if ledger is not None:
        ledger.loss[b, NORMAL_DASHPOT] += 0.5 * dt * lost.n
        ledger.loss[b, TANGENTIAL_DASHPOT] += 0.5 * dt * lost.t
        ledger.loss[b, ROLLING_DASHPOT] += 0.5 * dt * lost.r
        ledger.loss[b, SLIDING] += 0.5 * lost.s
        ledger.loss[b, ROLLING_SLIP] += 0.5 * lost.p
