"""Leapfrog (model 1.4): kick by the forces at n, drift to n + 1."""

import numpy as np

from particles.kernels.jit import kernel
from particles.kernels.layout import DAMPING_AHEAD, GLOBAL_DAMPING


@kernel
def drift(b, grains, spins, reach2, dt):
    """Move block `b`. True if a grain went farther than sqrt(reach2) since it was listed, or is lost."""
    x, y, vx, vy = grains.x, grains.y, grains.vx, grains.vy
    x_listed, y_listed, theta, omega = grains.x_listed, grains.y_listed, grains.theta, grains.omega
    stale = 0
    for i in range(np.uint64(grains.block_start[b]), np.uint64(grains.block_start[b + 1])):
        x[i] += dt * vx[i]
        y[i] += dt * vy[i]
        dx, dy = x[i] - x_listed[i], y[i] - y_listed[i]
        stale |= not (dx * dx + dy * dy <= reach2)
    if spins:
        for i in range(np.uint64(grains.block_start[b]), np.uint64(grains.block_start[b + 1])):
            theta[i] += dt * omega[i]
    return stale


@kernel
def add_incoming(b, grains, pairs, spins):
    """Forces on the grains of block `b` from contacts that earlier blocks own."""
    fx, fy, torque = grains.fx, grains.fy, grains.torque
    crossing, incoming, incoming_start = pairs.crossing, pairs.incoming, pairs.incoming_start
    grain = pairs.incoming_grain
    for a in range(pairs.incoming_block[b], pairs.incoming_block[b + 1]):
        sx = sy = st = 0.0
        for c in range(incoming_start[a], incoming_start[a + 1]):
            sx += crossing[incoming[c], 0]
            sy += crossing[incoming[c], 1]
            if spins:
                st += crossing[incoming[c], 2]
        fx[grain[a]] += sx
        fy[grain[a]] += sy
        if spins:
            torque[grain[a]] += st


@kernel
def kick(b, grains, gravity_x, gravity_y, spins, damping, lead, ledger, dt):
    """Velocities of the free grains of block `b` from n - 1/2 to n + 1/2."""
    vx, vy, omega = grains.vx, grains.vy, grains.omega
    fx, fy, torque, mass, inertia = grains.fx, grains.fy, grains.torque, grains.mass, grains.inertia
    inverse_mass, inverse_inertia = grains.inverse_mass, grains.inverse_inertia
    first, last = grains.block_start[b], grains.block_start[b + 1]
    alpha_t = alpha_r = now = ahead = 0.0
    if damping is not None:
        alpha_t, alpha_r = damping.alpha_t, damping.alpha_r
    for i in range(np.uint64(first), np.uint64(last)):
        ax = fx[i] * inverse_mass[i] + gravity_x
        ay = fy[i] * inverse_mass[i] + gravity_y
        if damping is not None:
            wx, wy = vx[i], vy[i]
            if lead is not None:
                wx, wy = wx + lead.x[i], wy + lead.y[i]
            ax -= alpha_t * wx
            ay -= alpha_t * wy
        ux, uy = vx[i] + dt * ax, vy[i] + dt * ay
        if damping is not None and ledger is not None:
            now += mass[i] * (vx[i] * wx + vy[i] * wy)
            ahead += mass[i] * (wx * ux + wy * uy)
        if lead is not None:
            lead.x[i], lead.y[i] = 0.5 * dt * ax, 0.5 * dt * ay
        vx[i], vy[i] = ux, uy
    if damping is not None and ledger is not None:
        ledger.loss[b, GLOBAL_DAMPING] += ledger.loss[b, DAMPING_AHEAD] + 0.5 * dt * alpha_t * now
        ledger.loss[b, DAMPING_AHEAD] = 0.5 * dt * alpha_t * ahead
    if spins:
        now = ahead = 0.0
        for i in range(np.uint64(first), np.uint64(last)):
            a = torque[i] * inverse_inertia[i]
            if damping is not None:
                w = omega[i]
                if lead is not None:
                    w += lead.spin[i]
                a -= alpha_r * w
            u = omega[i] + dt * a
            if damping is not None and ledger is not None:
                now += inertia[i] * omega[i] * w
                ahead += inertia[i] * w * u
            if lead is not None:
                lead.spin[i] = 0.5 * dt * a
            omega[i] = u
        if damping is not None and ledger is not None:
            ledger.loss[b, GLOBAL_DAMPING] += 0.5 * dt * alpha_r * now
            ledger.loss[b, DAMPING_AHEAD] += 0.5 * dt * alpha_r * ahead


@kernel
def prescribed_work(b, grains, ledger, dt):
    """Half a step of the work done by the prescribed grains (block `b`) on the others."""
    first = grains.block_start[b]
    for i in range(first, grains.block_start[b + 1]):
        power = grains.fx[i] * grains.vx[i] + grains.fy[i] * grains.vy[i] + grains.torque[i] * grains.omega[i]
        ledger.prescribed_work[i - first] -= 0.5 * dt * power
