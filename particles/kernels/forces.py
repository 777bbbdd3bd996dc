"""Contact forces of one block of grains: its pairs, then its walls."""

import math

from particles.kernels.jit import kernel
from particles.kernels.laws import let_go, respond, rolling_stiffness
from particles.kernels.layout import (
    NORMAL_DASHPOT,
    ROLLING_DASHPOT,
    ROLLING_SLIP,
    SLIDING,
    TANGENTIAL_DASHPOT,
    WALL_WORK,
    Meeting,
)


@kernel
def clear_forces(b, grains):
    for i in range(grains.block_start[b], grains.block_start[b + 1]):
        grains.fx[i] = 0.0
        grains.fy[i] = 0.0
        grains.torque[i] = 0.0


@kernel
def remembers(k, spring, moment, tangential, dash_n, ledger):
    """Whether slot `k` touched one step ago, so that it has something to let go."""
    if ledger is not None:
        if dash_n[k] != 0.0:
            return True
    if tangential is not None:
        return spring[k] != 0.0 or moment[k] != 0.0
    return False


@kernel
def add_losses(b, tangential, ledger, lost_n, lost_t, lost_r, lost_s, lost_p, dt):
    """Enter one step's losses of block `b`.

    All are trapezoidal works over the step, with the half-step velocity of the leapfrog: exactly
    what the integrator takes from the kinetic energy m v(n-1/2) v(n+1/2) / 2, up to the turn of
    the normal within one step. A slider loses its mean force times the slip (cut / stiffness),
    the part of the motion that did not stretch its spring; opening is a slip to zero force.
    """
    if ledger is not None:
        ledger.loss[b, NORMAL_DASHPOT] += 0.5 * dt * lost_n
        ledger.loss[b, TANGENTIAL_DASHPOT] += 0.5 * dt * lost_t
        ledger.loss[b, ROLLING_DASHPOT] += 0.5 * dt * lost_r
        ledger.loss[b, ROLLING_SLIP] += 0.5 * lost_p
        if tangential is not None:
            ledger.loss[b, SLIDING] += 0.5 * lost_s / tangential.k_t


@kernel
def pair_forces(b, grains, pairs, normal, tangential, rolling, ledger, dt):
    """Forces of the pairs that block `b` owns (model 1.1, 1.2; lever arms to mid-overlap)."""
    first, last = grains.block_start[b], grains.block_start[b + 1]
    x, y, vx, vy, omega = grains.x, grains.y, grains.vx, grains.vy, grains.omega
    radius, compliance = grains.radius, grains.roll_compliance
    fx, fy, torque = grains.fx, grains.fy, grains.torque
    start, partner, spring, moment = pairs.start, pairs.partner, pairs.spring, pairs.moment
    crossing, cross = pairs.crossing, pairs.crossing_start[b]
    dash_n, dash_t, dash_r = pairs.dash_n, pairs.dash_t, pairs.dash_r
    lost_n = lost_t = lost_r = lost_s = lost_p = 0.0
    for i in range(first, last):
        xi, yi, ri = x[i], y[i], radius[i]
        fxi = fyi = ti = 0.0
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            dx, dy, reach = x[j] - xi, y[j] - yi, ri + radius[j]
            d2 = dx * dx + dy * dy
            touching = d2 < reach * reach
            px = py = tj = 0.0
            if touching or remembers(k, spring, moment, tangential, dash_n, ledger):
                d = math.sqrt(d2)
                nx, ny, delta = dx / d, dy / d, reach - d
                ux, uy = vx[j] - vx[i], vy[j] - vy[i]
                arm_i = arm_j = v_t = omega_r = 0.0
                if tangential is not None:
                    arm_i, arm_j = ri - 0.5 * delta, radius[j] - 0.5 * delta
                    v_t = uy * nx - ux * ny - (arm_i * omega[i] + arm_j * omega[j])
                    omega_r = omega[i] - omega[j]
                meeting = Meeting(
                    delta, ux * nx + uy * ny, v_t, omega_r, ri * radius[j] / reach, compliance[i] + compliance[j]
                )
                f_old = m_old = 0.0
                if tangential is not None:
                    f_old, m_old = spring[k], moment[k]
                if touching:
                    response = respond(normal, tangential, rolling, meeting, f_old, m_old, dt)
                else:
                    response = let_go(tangential, rolling, meeting, f_old, m_old, dt)
                if ledger is not None:
                    lost_n -= (dash_n[k] + response.dash_n) * meeting.v_n
                    dash_n[k] = response.dash_n
                    if tangential is not None:
                        lost_s += (f_old + response.spring) * response.cut_t
                        lost_t += (dash_t[k] + response.dash_t) * v_t
                        dash_t[k] = response.dash_t
                        if rolling is not None:
                            if response.cut_r != 0.0:
                                k_r = rolling_stiffness(rolling, tangential.k_t, meeting.r_r)
                                lost_p += (m_old + response.moment) * response.cut_r / k_r
                            if rolling.eta_r > 0.0:
                                lost_r -= (dash_r[k] + response.dash_r) * omega_r
                                dash_r[k] = response.dash_r
                if tangential is not None:
                    spring[k], moment[k] = response.spring, response.moment
                px = -response.f_n * nx - response.f_t * ny
                py = -response.f_n * ny + response.f_t * nx
                ti += arm_i * response.f_t + response.m_t
                tj = arm_j * response.f_t - response.m_t
            fxi += px
            fyi += py
            if j < last:
                fx[j] -= px
                fy[j] -= py
                torque[j] += tj
            else:
                crossing[cross, 0] = -px
                crossing[cross, 1] = -py
                crossing[cross, 2] = tj
                cross += 1
        fx[i] += fxi
        fy[i] += fyi
        torque[i] += ti
    add_losses(b, tangential, ledger, lost_n, lost_t, lost_r, lost_s, lost_p, dt)


@kernel
def wall_forces(b, grains, walls, normal, tangential, rolling, ledger, dt):
    """Forces of the walls on block `b`: the same laws, the wall as a body of infinite mass."""
    px, py, wnx, wny, wvx, wvy = walls.px, walls.py, walls.nx, walls.ny, walls.vx, walls.vy
    x, y, vx, vy, omega = grains.x, grains.y, grains.vx, grains.vy, grains.omega
    radius, compliance = grains.radius, grains.roll_compliance
    spring, moment, force = walls.spring, walls.moment, walls.force
    dash_n, dash_t, dash_r = walls.dash_n, walls.dash_t, walls.dash_r
    lost_n = lost_t = lost_r = lost_s = lost_p = 0.0
    wall_work(b, walls, ledger, dt)
    for w in range(px.shape[0]):
        force[b, w, 0] = force[b, w, 1] = 0.0
    for k in range(walls.block[b], walls.block[b + 1]):
        i, w = walls.grain[k], walls.wall[k]
        nx, ny, ri = -wnx[w], -wny[w], radius[i]
        delta = ri + (x[i] - px[w]) * nx + (y[i] - py[w]) * ny
        touching = delta > 0.0
        if not (touching or remembers(k, spring, moment, tangential, dash_n, ledger)):
            continue
        ux, uy = wvx[w] - vx[i], wvy[w] - vy[i]
        arm = v_t = omega_r = 0.0
        if tangential is not None:
            arm, omega_r = ri - 0.5 * delta, omega[i]
            v_t = uy * nx - ux * ny - arm * omega[i]
        meeting = Meeting(delta, ux * nx + uy * ny, v_t, omega_r, ri, compliance[i])
        f_old = m_old = 0.0
        if tangential is not None:
            f_old, m_old = spring[k], moment[k]
        if touching:
            response = respond(normal, tangential, rolling, meeting, f_old, m_old, dt)
        else:
            response = let_go(tangential, rolling, meeting, f_old, m_old, dt)
        if ledger is not None:
            lost_n -= (dash_n[k] + response.dash_n) * meeting.v_n
            dash_n[k] = response.dash_n
            if tangential is not None:
                lost_s += (f_old + response.spring) * response.cut_t
                lost_t += (dash_t[k] + response.dash_t) * v_t
                dash_t[k] = response.dash_t
                if rolling is not None:
                    if response.cut_r != 0.0:
                        k_r = rolling_stiffness(rolling, tangential.k_t, meeting.r_r)
                        lost_p += (m_old + response.moment) * response.cut_r / k_r
                    if rolling.eta_r > 0.0:
                        lost_r -= (dash_r[k] + response.dash_r) * omega_r
                        dash_r[k] = response.dash_r
        if tangential is not None:
            spring[k], moment[k] = response.spring, response.moment
        fx = -response.f_n * nx - response.f_t * ny
        fy = -response.f_n * ny + response.f_t * nx
        grains.fx[i] += fx
        grains.fy[i] += fy
        grains.torque[i] += arm * response.f_t + response.m_t
        force[b, w, 0] -= fx
        force[b, w, 1] -= fy
    wall_work(b, walls, ledger, dt)
    add_losses(b, tangential, ledger, lost_n, lost_t, lost_r, lost_s, lost_p, dt)


@kernel
def wall_work(b, walls, ledger, dt):
    """Half a step of the work done by moving walls on the grains of block `b`."""
    if ledger is not None:
        for w in range(walls.vx.shape[0]):
            power = walls.force[b, w, 0] * walls.vx[w] + walls.force[b, w, 1] * walls.vy[w]
            ledger.loss[b, WALL_WORK] -= 0.5 * dt * power
