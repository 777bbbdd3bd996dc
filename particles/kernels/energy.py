"""A look at the contacts as they stand: stored energy, overlaps, counts. Changes nothing."""

import math

from particles.kernels.jit import kernel
from particles.kernels.laws import rolling_stiffness


@kernel
def stored(normal, tangential, rolling, delta, f, m, r_r):
    """Elastic energy of one contact in its normal, tangential and rolling springs."""
    normal_energy = 0.5 * normal.k_n * delta * delta
    tangential_energy = rolling_energy = 0.0
    if tangential is not None:
        tangential_energy = 0.5 * f * f / tangential.k_t
        if rolling is not None:
            rolling_energy = 0.5 * m * m / rolling_stiffness(rolling, tangential.k_t, r_r)
    return normal_energy, tangential_energy, rolling_energy


@kernel
def look_at_contacts(grains, pairs, walls, normal, tangential, rolling, overlap, contacts):
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
            delta = reach - math.hypot(grains.x[j] - grains.x[i], grains.y[j] - grains.y[i])
            if delta > 0.0:
                f = m = 0.0
                if tangential is not None:
                    f = pairs.spring[k]
                if rolling is not None:
                    m = pairs.moment[k]
                r_r = grains.radius[i] * grains.radius[j] / reach
                e_n, e_t, e_r = stored(normal, tangential, rolling, delta, f, m, r_r)
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
            if tangential is not None:
                f = walls.spring[k]
            if rolling is not None:
                m = walls.moment[k]
            e_n, e_t, e_r = stored(normal, tangential, rolling, delta, f, m, grains.radius[i])
            energy_n, energy_t, energy_r = energy_n + e_n, energy_t + e_t, energy_r + e_r
            overlap[i] += delta
            contacts[i] += 1
            count += 1
            if delta / grains.radius[i] > deepest:
                deepest, deepest_at = delta / grains.radius[i], i
    return energy_n, energy_t, energy_r, count, deepest, deepest_at


@kernel
def kinetic_energy(grains, n_free, gravity_x, gravity_y, tangential, damping, dt):
    """m v(n-1/2) v(n+1/2) / 2 of the free grains, translation and rotation, and their potential."""
    alpha_t = alpha_r = translation = rotation = potential = 0.0
    if damping is not None:
        alpha_t, alpha_r = damping.alpha_t, damping.alpha_r
    for i in range(n_free):
        m = grains.mass[i]
        before_x = (grains.vx[i] - dt * (grains.fx[i] / m + gravity_x)) / (1.0 - dt * alpha_t)
        before_y = (grains.vy[i] - dt * (grains.fy[i] / m + gravity_y)) / (1.0 - dt * alpha_t)
        translation += 0.5 * m * (before_x * grains.vx[i] + before_y * grains.vy[i])
        potential -= m * (gravity_x * grains.x[i] + gravity_y * grains.y[i])
        if tangential is not None:
            before = (grains.omega[i] - dt * grains.torque[i] / grains.inertia[i]) / (1.0 - dt * alpha_r)
            rotation += 0.5 * grains.inertia[i] * before * grains.omega[i]
    return translation, rotation, potential
