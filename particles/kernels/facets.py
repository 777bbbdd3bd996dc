"""Contact forces of discs with the facets and nodes of a moving polyline."""

import numpy as np

from particles.kernels.features import INSIDE, along, charge_of, foot_on, note_sides
from particles.kernels.jit import inner_kernel, kernel
from particles.kernels.laws.materials import of_pair
from particles.kernels.laws.response import Meeting, Now
from particles.kernels.laws.rolling import turns_dashpot, turns_spring
from particles.kernels.laws.tangential import present
from particles.kernels.lead import now_at_wall
from particles.kernels.touch import NOTHING_LOST, Lost, Memory, add_losses, touch


@kernel
def facet_forces(b, grains, facets, laws, lead, ledger, dt):
    """Forces of the polyline on block `b`: a body of prescribed motion, met at the foot of each disc's centre.

    The lever arm of the disc is its distance r - delta to the foot, where the force acts on both.
    """
    if facets is None:
        return
    spins, remembers = present(laws.tangential), turns_spring(laws.rolling)
    damps = ledger is not None and turns_dashpot(laws.rolling)
    first, last = facets.block[b], facets.block[b + 1]
    note_sides(first, last, grains.x, grains.y, facets)
    lost = NOTHING_LOST
    for k in range(np.uint64(first), np.uint64(last)):
        facets.pushes[k] = False
        charge = charge_of(facets.side[k])
        if charge == 0:
            continue
        i = facets.grain[k]
        foot = foot_on(facets, facets.feature[k], grains.x[i], grains.y[i])
        nx, ny, ri = foot.nx, foot.ny, grains.radius[i]
        delta = ri - foot.distance
        touching = delta > 0.0 and foot.distance > -INSIDE * ri
        f_old = m_old = d_n = d_t = d_r = 0.0
        if spins:
            f_old = facets.spring[k]
        if remembers:
            m_old = facets.moment[k]
        if ledger is not None:
            d_n, d_t = facets.dash_n[k], facets.dash_t[k]
        if damps:
            d_r = facets.dash_r[k]
        if not (touching or f_old != 0.0 or m_old != 0.0 or d_n != 0.0 or d_r != 0.0):
            continue
        ux, uy = foot.vx - grains.vx[i], foot.vy - grains.vy[i]
        arm = v_t = omega_r = 0.0
        if spins:
            arm, omega_r = foot.distance, grains.omega[i] - foot.spin
            v_t = uy * nx - ux * ny - arm * grains.omega[i]
        v_n = ux * nx + uy * ny
        meeting = Meeting(
            delta, delta + v_n * dt, v_n, v_t, omega_r, ri, grains.inverse_mass[i], grains.roll_compliance[i]
        )
        now = Now(v_n, v_t, omega_r)
        if lead is not None:
            now = now_at_wall(lead, i, 0.0, 0.0, nx, ny, arm, meeting)
        pair_laws = of_pair(laws, grains.material[i], facets.material[0])
        memory = Memory(f_old, m_old, d_n, d_t, d_r)
        response, own = touch(touching, pair_laws, ledger, meeting, now, memory, NOTHING_LOST, dt)
        lost = charged(lost, charge, own)
        if spins:
            facets.spring[k] = response.spring
        if remembers:
            facets.moment[k] = response.moment
        if ledger is not None:
            facets.dash_n[k], facets.dash_t[k] = response.dash_n, response.dash_t
        if damps:
            facets.dash_r[k] = response.dash_r
        fx = charge * (-response.f_n * nx - response.f_t * ny)
        fy = charge * (-response.f_n * ny + response.f_t * nx)
        grains.fx[i] += fx
        grains.fy[i] += fy
        grains.torque[i] += charge * (arm * response.f_t + response.m_t)
        share_out(facets, k, foot, fx, fy, charge * response.m_t)
    add_losses(b, ledger, lost, dt)


@inner_kernel
def charged(lost, charge, own):
    return Lost(
        lost.n + charge * own.n,
        lost.t + charge * own.t,
        lost.r + charge * own.r,
        lost.s + charge * own.s,
        lost.p + charge * own.p,
    )


@inner_kernel
def share_out(facets, k, foot, fx, fy, moment):
    """Give the force (fx, fy) and the moment on a grain, both reversed, to the nodes of its feature.

    The force acts at the foot. The moment turns a facet of length L by a couple of forces M/L
    normal to it; at a node the two facets have a share of it each.
    """
    a, c, b = facets.before[facets.feature[k]], facets.at[facets.feature[k]], facets.after[facets.feature[k]]
    push = facets.push
    facets.pushes[k] = True
    for place in range(3):
        push[k, place, 0] = push[k, place, 1] = 0.0
    if c < 0:
        push[k, 0, 0], push[k, 0, 1] = -(1.0 - foot.share) * fx, -(1.0 - foot.share) * fy
        push[k, 2, 0], push[k, 2, 1] = -foot.share * fx, -foot.share * fy
        if moment != 0.0:
            add_couple(facets, k, 0, 2, a, b, moment)
        return
    push[k, 1, 0], push[k, 1, 1] = -fx, -fy
    if moment != 0.0:
        if a >= 0:
            add_couple(facets, k, 0, 1, a, c, (1.0 - foot.share) * moment)
        if b >= 0:
            add_couple(facets, k, 1, 2, c, b, foot.share * moment)


@inner_kernel
def add_couple(facets, k, place, other, a, b, moment):
    """Add the couple of the moment -`moment` on the facet a-b."""
    tx, ty = along(facets, a, b)
    length = (facets.x[b] - facets.x[a]) * tx + (facets.y[b] - facets.y[a]) * ty
    qx, qy = ty * moment / length, -tx * moment / length
    facets.push[k, place, 0] -= qx
    facets.push[k, place, 1] -= qy
    facets.push[k, other, 0] += qx
    facets.push[k, other, 1] += qy


@kernel
def receive_pushes(facets, ledger, dt):
    """Forces on the nodes out of all contacts, their impulse, and the work of the half step that ends now."""
    if facets is None:
        return
    fx, fy = facets.fx, facets.fy
    fx[:] = 0.0
    fy[:] = 0.0
    for k in range(facets.grain.shape[0]):
        if facets.pushes[k]:
            f = facets.feature[k]
            a, c, b = facets.before[f], facets.at[f], facets.after[f]
            if a >= 0:
                fx[a] += facets.push[k, 0, 0]
                fy[a] += facets.push[k, 0, 1]
            if c >= 0:
                fx[c] += facets.push[k, 1, 0]
                fy[c] += facets.push[k, 1, 1]
            if b >= 0:
                fx[b] += facets.push[k, 2, 0]
                fy[b] += facets.push[k, 2, 1]
    for p in range(fx.shape[0]):
        facets.impulse[p, 0] += dt * fx[p]
        facets.impulse[p, 1] += dt * fy[p]
    node_work(facets, ledger, dt)


@kernel
def node_work(facets, ledger, dt):
    """Half a step of the work done by the nodes on the grains."""
    if ledger is not None:
        for p in range(facets.x.shape[0]):
            facets.work[p] -= 0.5 * dt * (facets.fx[p] * facets.vx[p] + facets.fy[p] * facets.vy[p])


@kernel
def move_nodes(facets, ledger, reach2, dt):
    """Move the nodes. True if one went farther than sqrt(reach2) since the list was made."""
    stale = False
    if facets is not None:
        node_work(facets, ledger, dt)
        for p in range(facets.x.shape[0]):
            facets.x[p] += dt * facets.vx[p]
            facets.y[p] += dt * facets.vy[p]
            dx, dy = facets.x[p] - facets.x_listed[p], facets.y[p] - facets.y_listed[p]
            stale |= not (dx * dx + dy * dy <= reach2)
    return stale
