"""Contact forces of one block of grains: its pairs, then its walls."""

import math

import numpy as np

from particles.kernels.jit import inner_kernel, kernel
from particles.kernels.laws.materials import of_pair
from particles.kernels.laws.response import Meeting, Now
from particles.kernels.laws.rolling import turns_dashpot, turns_spring
from particles.kernels.laws.tangential import present
from particles.kernels.layout import WALL_WORK
from particles.kernels.lead import now_at_wall, now_between
from particles.kernels.periodic import nearest
from particles.kernels.touch import NOTHING_LOST, Memory, add_losses, touch


@kernel
def clear_forces(b, grains, spins):
    fx, fy, torque = grains.fx, grains.fy, grains.torque
    for i in range(np.uint64(grains.block_start[b]), np.uint64(grains.block_start[b + 1])):
        fx[i] = 0.0
        fy[i] = 0.0
        if spins:
            torque[i] = 0.0


@inner_kernel
def push(response, nx, ny, spins):
    """Force on i. Without friction nothing is added: the compiler may not leave out a sum with a computed zero."""
    if spins:
        return -response.f_n * nx - response.f_t * ny, -response.f_n * ny + response.f_t * nx
    return -response.f_n * nx, -response.f_n * ny


@kernel
def pair_forces(b, grains, pairs, laws, lead, ledger, dt):
    """Forces of the pairs that block `b` owns (model 1.1, 1.2; lever arms to mid-overlap).

    One flat loop with unsigned indices: signed ones are wrapped around at every access.
    """
    last = grains.block_start[b + 1]
    x, y, vx, vy, omega = grains.x, grains.y, grains.vx, grains.vy, grains.omega
    radius, compliance, inverse_mass = grains.radius, grains.roll_compliance, grains.inverse_mass
    material, period_x, period_y = grains.material, grains.period_x, grains.period_y
    fx, fy, torque = grains.fx, grains.fy, grains.torque
    owner, partner, spring, moment = pairs.owner, pairs.partner, pairs.spring, pairs.moment
    crossing, cross = pairs.crossing, np.uint64(pairs.crossing_start[b])
    dash_n, dash_t, dash_r = pairs.dash_n, pairs.dash_t, pairs.dash_r
    spins, remembers = present(laws.tangential), turns_spring(laws.rolling)
    damps = ledger is not None and turns_dashpot(laws.rolling)
    lost = NOTHING_LOST
    for k in range(np.uint64(pairs.start[grains.block_start[b]]), np.uint64(pairs.start[last])):
        i, j = owner[k], partner[k]
        dx, dy = nearest(period_x, x[j] - x[i]), nearest(period_y, y[j] - y[i])
        reach = radius[i] + radius[j]
        d2 = dx * dx + dy * dy
        f_old = m_old = d_n = d_t = d_r = 0.0
        if spins:
            f_old = spring[k]
        if remembers:
            m_old = moment[k]
        if ledger is not None:
            d_n, d_t = dash_n[k], dash_t[k]
        if damps:
            d_r = dash_r[k]
        touching = d2 < reach * reach
        if not (touching or f_old != 0.0 or m_old != 0.0 or d_n != 0.0 or d_r != 0.0):
            if j >= last:
                crossing[cross, 0] = crossing[cross, 1] = crossing[cross, 2] = 0.0
                cross += np.uint64(1)
            continue
        d = math.sqrt(d2)
        inverse = 1.0 / d
        nx, ny, delta = dx * inverse, dy * inverse, reach - d
        ux, uy = vx[j] - vx[i], vy[j] - vy[i]
        arm_i = arm_j = v_t = omega_r = 0.0
        if spins:
            arm_i, arm_j = radius[i] - 0.5 * delta, radius[j] - 0.5 * delta
            v_t = uy * nx - ux * ny - (arm_i * omega[i] + arm_j * omega[j])
            omega_r = omega[i] - omega[j]
        before = reach - math.sqrt((dx - dt * ux) * (dx - dt * ux) + (dy - dt * uy) * (dy - dt * uy))
        meeting = Meeting(
            delta, before, ux * nx + uy * ny, v_t, omega_r, radius[i] * radius[j] / reach,
            inverse_mass[i] + inverse_mass[j], compliance[i] + compliance[j],
        )  # fmt: skip
        now = Now(meeting.v_n, meeting.v_t, meeting.omega_r)
        if lead is not None:
            now = now_between(lead, i, j, nx, ny, arm_i, arm_j, meeting)
        pair_laws = of_pair(laws, material[i], material[j])
        memory = Memory(f_old, m_old, d_n, d_t, d_r)
        response, lost = touch(touching, pair_laws, ledger, meeting, now, memory, lost, dt)
        if spins:
            spring[k] = response.spring
        if remembers:
            moment[k] = response.moment
        if ledger is not None:
            dash_n[k], dash_t[k] = response.dash_n, response.dash_t
        if damps:
            dash_r[k] = response.dash_r
        px, py = push(response, nx, ny, spins)
        tj = arm_j * response.f_t - response.m_t
        fx[i] += px
        fy[i] += py
        if spins:
            torque[i] += arm_i * response.f_t + response.m_t
        if j < last:
            fx[j] -= px
            fy[j] -= py
            if spins:
                torque[j] += tj
        else:
            crossing[cross, 0], crossing[cross, 1], crossing[cross, 2] = -px, -py, tj
            cross += np.uint64(1)
    add_losses(b, ledger, lost, dt)


@kernel
def wall_forces(b, grains, walls, laws, lead, ledger, dt):
    """Forces of the walls on block `b`: the same laws, the wall as a body of infinite mass."""
    px, py, wnx, wny, wvx, wvy = walls.px, walls.py, walls.nx, walls.ny, walls.vx, walls.vy
    x, y, vx, vy, omega = grains.x, grains.y, grains.vx, grains.vy, grains.omega
    radius, compliance, inverse_mass = grains.radius, grains.roll_compliance, grains.inverse_mass
    material = grains.material
    spring, moment, force = walls.spring, walls.moment, walls.force
    dash_n, dash_t, dash_r = walls.dash_n, walls.dash_t, walls.dash_r
    spins, remembers = present(laws.tangential), turns_spring(laws.rolling)
    damps = ledger is not None and turns_dashpot(laws.rolling)
    lost = NOTHING_LOST
    wall_work(b, walls, ledger, dt)
    for w in range(px.shape[0]):
        force[b, w, 0] = force[b, w, 1] = 0.0
    for k in range(np.uint64(walls.block[b]), np.uint64(walls.block[b + 1])):
        i, w = walls.grain[k], walls.wall[k]
        nx, ny, ri = -wnx[w], -wny[w], radius[i]
        delta = ri + (x[i] - px[w]) * nx + (y[i] - py[w]) * ny
        touching = delta > 0.0
        f_old = m_old = d_n = d_t = d_r = 0.0
        if spins:
            f_old = spring[k]
        if remembers:
            m_old = moment[k]
        if ledger is not None:
            d_n, d_t = dash_n[k], dash_t[k]
        if damps:
            d_r = dash_r[k]
        if not (touching or f_old != 0.0 or m_old != 0.0 or d_n != 0.0 or d_r != 0.0):
            continue
        ux, uy = wvx[w] - vx[i], wvy[w] - vy[i]
        arm = v_t = omega_r = 0.0
        if spins:
            arm, omega_r = ri - 0.5 * delta, omega[i]
            v_t = uy * nx - ux * ny - arm * omega[i]
        v_n = ux * nx + uy * ny
        meeting = Meeting(delta, delta + v_n * dt, v_n, v_t, omega_r, ri, inverse_mass[i], compliance[i])
        now = Now(meeting.v_n, meeting.v_t, meeting.omega_r)
        if lead is not None:
            now = now_at_wall(lead, i, walls.gain_x[w], walls.gain_y[w], nx, ny, arm, meeting)
        pair_laws = of_pair(laws, material[i], walls.material[w])
        memory = Memory(f_old, m_old, d_n, d_t, d_r)
        response, lost = touch(touching, pair_laws, ledger, meeting, now, memory, lost, dt)
        if spins:
            spring[k] = response.spring
        if remembers:
            moment[k] = response.moment
        if ledger is not None:
            dash_n[k], dash_t[k] = response.dash_n, response.dash_t
        if damps:
            dash_r[k] = response.dash_r
        fx, fy = push(response, nx, ny, spins)
        grains.fx[i] += fx
        grains.fy[i] += fy
        if spins:
            grains.torque[i] += arm * response.f_t + response.m_t
        force[b, w, 0] -= fx
        force[b, w, 1] -= fy
    wall_work(b, walls, ledger, dt)
    add_losses(b, ledger, lost, dt)


@kernel
def wall_work(b, walls, ledger, dt):
    """Half a step of the work done by moving walls on the grains of block `b`."""
    if ledger is not None:
        for w in range(walls.vx.shape[0]):
            power = walls.force[b, w, 0] * walls.vx[w] + walls.force[b, w, 1] * walls.vy[w]
            ledger.loss[b, WALL_WORK] -= 0.5 * dt * power
