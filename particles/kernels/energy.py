"""A look at the contacts as they stand: stored energy, overlaps, counts. Changes nothing."""

import math

from particles.kernels.facet_cells import deepest_inside
from particles.kernels.features import INSIDE, charge_of, foot_on, side_of
from particles.kernels.jit import kernel
from particles.kernels.laws.materials import of_pair
from particles.kernels.laws.normal import normal_energy, normal_stiffness
from particles.kernels.laws.rolling import rolling_stiffness, turns_spring
from particles.kernels.laws.tangential import present, tangential_stiffness
from particles.kernels.periodic import nearest


@kernel
def stored(laws, delta, f, m, r_eff):
    """Elastic energy of one contact in its normal, tangential and rolling springs."""
    k_t = tangential_stiffness(laws.tangential, normal_stiffness(laws.normal, delta, r_eff))
    energy_t = energy_r = 0.0
    if f != 0.0:
        energy_t = 0.5 * f * f / k_t
    if m != 0.0:
        energy_r = 0.5 * m * m / rolling_stiffness(laws.rolling, k_t, r_eff)
    return normal_energy(laws.normal, delta, r_eff), energy_t, energy_r


@kernel
def look_at_contacts(grains, pairs, walls, facets, laws, overlap, contacts):
    """Fill `overlap` (sum per grain [m]) and `contacts` (count per grain).

    Returns the energies of the three springs, the number of contacts, the largest overlap over
    the smaller radius, and the grain where it is.
    """
    energy_n = energy_t = energy_r = deepest = 0.0
    count, deepest_at = 0, -1
    overlap[:] = 0.0
    contacts[:] = 0
    for i in range(grains.x.shape[0]):
        for k in range(pairs.start[i], pairs.start[i + 1]):
            j = pairs.partner[k]
            reach = grains.radius[i] + grains.radius[j]
            dx, dy = (
                nearest(grains.period_x, grains.x[j] - grains.x[i]),
                nearest(grains.period_y, grains.y[j] - grains.y[i]),
            )
            delta = reach - math.hypot(dx, dy)
            if delta > 0.0:
                f = m = 0.0
                if present(laws.tangential):
                    f = pairs.spring[k]
                if turns_spring(laws.rolling):
                    m = pairs.moment[k]
                r_r = grains.radius[i] * grains.radius[j] / reach
                e_n, e_t, e_r = stored(of_pair(laws, grains.material[i], grains.material[j]), delta, f, m, r_r)
                energy_n, energy_t, energy_r = energy_n + e_n, energy_t + e_t, energy_r + e_r
                overlap[i] += delta
                overlap[j] += delta
                contacts[i] += 1
                contacts[j] += 1
                count += 1
                depth = delta / min(grains.radius[i], grains.radius[j])
                if depth > deepest:
                    deepest, deepest_at = depth, i
    for k in range(walls.grain.shape[0]):
        i, w = walls.grain[k], walls.wall[k]
        gap = (grains.x[i] - walls.px[w]) * walls.nx[w] + (grains.y[i] - walls.py[w]) * walls.ny[w]
        delta = grains.radius[i] - gap
        if delta > 0.0:
            f = m = 0.0
            if present(laws.tangential):
                f = walls.spring[k]
            if turns_spring(laws.rolling):
                m = walls.moment[k]
            e_n, e_t, e_r = stored(of_pair(laws, grains.material[i], walls.material[w]), delta, f, m, grains.radius[i])
            energy_n, energy_t, energy_r = energy_n + e_n, energy_t + e_t, energy_r + e_r
            overlap[i] += delta
            contacts[i] += 1
            count += 1
            if delta / grains.radius[i] > deepest:
                deepest, deepest_at = delta / grains.radius[i], i
    if facets is not None:
        e_n, e_t, e_r, more, depth, at = look_at_facets(grains, facets, laws, overlap, contacts)
        energy_n, energy_t, energy_r, count = energy_n + e_n, energy_t + e_t, energy_r + e_r, count + more
        if depth > deepest:
            deepest, deepest_at = depth, at
    return energy_n, energy_t, energy_r, count, deepest, deepest_at


@kernel
def look_at_facets(grains, facets, laws, overlap, contacts):
    """The same for facets. What their charges cancel counts once; a grain lost inside counts as the deepest."""
    energy_n = energy_t = energy_r = 0.0
    count = 0
    deepest, deepest_at = deepest_inside(grains, facets)
    for k in range(facets.grain.shape[0]):
        i = facets.grain[k]
        charge = charge_of(side_of(facets, facets.feature[k], grains.x[i], grains.y[i]))
        if charge == 0:
            continue
        distance = foot_on(facets, facets.feature[k], grains.x[i], grains.y[i]).distance
        delta = grains.radius[i] - distance
        if delta > 0.0 and distance > -INSIDE * grains.radius[i]:
            f = m = 0.0
            if present(laws.tangential):
                f = facets.spring[k]
            if turns_spring(laws.rolling):
                m = facets.moment[k]
            pair = of_pair(laws, grains.material[i], facets.material[0])
            e_n, e_t, e_r = stored(pair, delta, f, m, grains.radius[i])
            energy_n, energy_t, energy_r = energy_n + charge * e_n, energy_t + charge * e_t, energy_r + charge * e_r
            overlap[i] += charge * delta
            contacts[i] += charge
            count += charge
            if delta / grains.radius[i] > deepest:
                deepest, deepest_at = delta / grains.radius[i], i
    return energy_n, energy_t, energy_r, count, deepest, deepest_at


@kernel
def kinetic_energy(grains, n_free, gravity_x, gravity_y, spins, damping, lead, dt):
    """m v(n-1/2) v(n+1/2) / 2 of the free grains, translation and rotation, and their potential."""
    alpha_t = alpha_r = translation = rotation = potential = 0.0
    if damping is not None:
        alpha_t, alpha_r = damping.alpha_t, damping.alpha_r
    for i in range(n_free):
        m = grains.mass[i]
        if lead is None:
            before_x = (grains.vx[i] - dt * (grains.fx[i] / m + gravity_x)) / (1.0 - dt * alpha_t)
            before_y = (grains.vy[i] - dt * (grains.fy[i] / m + gravity_y)) / (1.0 - dt * alpha_t)
        else:
            before_x, before_y = grains.vx[i] - 2.0 * lead.x[i], grains.vy[i] - 2.0 * lead.y[i]
        translation += 0.5 * m * (before_x * grains.vx[i] + before_y * grains.vy[i])
        potential -= m * (gravity_x * grains.x[i] + gravity_y * grains.y[i])
        if spins:
            if lead is None:
                before = (grains.omega[i] - dt * grains.torque[i] / grains.inertia[i]) / (1.0 - dt * alpha_r)
            else:
                before = grains.omega[i] - 2.0 * lead.spin[i]
            rotation += 0.5 * grains.inertia[i] * before * grains.omega[i]
    return translation, rotation, potential
