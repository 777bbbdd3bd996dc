"""The velocities that dashpots see: those of the present, under the velocity Verlet scheme.

The leapfrog has no leads (None): its dashpots see the velocity of the half step before.
"""

from particles.kernels.jit import inner_kernel
from particles.kernels.laws.response import Now


@inner_kernel
def now_between(lead, i, j, nx, ny, arm_i, arm_j, meeting):
    """Of a pair."""
    gx, gy = lead.x[j] - lead.x[i], lead.y[j] - lead.y[i]
    turn_i, turn_j = lead.spin[i], lead.spin[j]
    along = gy * nx - gx * ny - (arm_i * turn_i + arm_j * turn_j)
    return Now(meeting.v_n + gx * nx + gy * ny, meeting.v_t + along, meeting.omega_r + turn_i - turn_j)


@inner_kernel
def now_at_wall(lead, i, wall_x, wall_y, nx, ny, arm, meeting):
    """Of a grain and a wall, whose velocity gains `wall_x`, `wall_y` until the present."""
    gx, gy, turn = lead.x[i] - wall_x, lead.y[i] - wall_y, lead.spin[i]
    along = gy * nx - gx * ny + arm * turn
    return Now(meeting.v_n - gx * nx - gy * ny, meeting.v_t - along, meeting.omega_r + turn)
