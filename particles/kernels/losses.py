"""What the dashpots and sliders of one contact take in one step.

All are trapezoidal works over the step that ends at the present position, with the half-step
velocity of the leapfrog: summed over contacts they are exactly what the integrator takes from
the kinetic energy m v(n-1/2) v(n+1/2) / 2 (up to the turn of the normal within one step).
"""

from particles.kernels.jit import kernel
from particles.kernels.laws import rolling_stiffness, time_in_contact
from particles.kernels.layout import (
    NORMAL_DASHPOT,
    ROLLING_DASHPOT,
    ROLLING_SLIP,
    SLIDING,
    TANGENTIAL_DASHPOT,
)


@kernel
def record(loss, dashpots, tangential, rolling, meeting, response, f_old, m_old, dt):
    """Add the losses of one contact to the row `loss`; `dashpots` keeps its forces for the next step.

    A spring loses its mean force times the slip, that is the part of the relative motion which
    did not stretch it; opening is a slip to zero force.
    """
    loss[NORMAL_DASHPOT] -= 0.5 * (dashpots[0] + response.dash_n) * meeting.v_n * dt
    dashpots[0] = response.dash_n
    if tangential is not None:
        held = time_in_contact(meeting.delta, meeting.v_n, dt) if meeting.delta > 0.0 else dt
        f = response.spring
        slip = meeting.v_t * held - (f - f_old) / tangential.k_t
        loss[SLIDING] += 0.5 * (f_old + f) * slip
        loss[TANGENTIAL_DASHPOT] += 0.5 * (dashpots[1] + response.dash_t) * meeting.v_t * dt
        dashpots[1] = response.dash_t
        if rolling is not None:
            k_r = rolling_stiffness(rolling, tangential.k_t, meeting.r_r)
            m = response.moment
            turn = meeting.omega_r * held + (m - m_old) / k_r
            loss[ROLLING_SLIP] -= 0.5 * (m_old + m) * turn
            loss[ROLLING_DASHPOT] -= 0.5 * (dashpots[2] + response.dash_r) * meeting.omega_r * dt
            dashpots[2] = response.dash_r
