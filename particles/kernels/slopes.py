"""Slopes of the springs and coefficients of the dashpots of many contacts, from the laws themselves."""

from typing import NamedTuple

from particles.kernels.jit import inner_kernel, kernel
from particles.kernels.laws.materials import of_pair
from particles.kernels.laws.normal import normal_dashpot, normal_stiffness
from particles.kernels.laws.rolling import rolling_dashpot, rolling_stiffness
from particles.kernels.laws.tangential import tangential_dashpot, tangential_stiffness
from particles.kernels.layout import Array


class Touching(NamedTuple):
    """What the laws ask of n contacts."""

    delta: Array  # (n,) overlap
    r_eff: Array  # r_i r_j / (r_i + r_j), at a wall r_i
    inverse_mass: Array  # 1/m_i + 1/m_j
    compliance: Array  # 1/(I_i + m_i r_i^2) + (j)
    material_i: Array
    material_j: Array


@inner_kernel
def shear_slopes(law, k_n, inverse_mass):
    """k_t, c_t, and whether the contact can stick at all."""
    if law is None:
        return 0.0, 0.0, False
    k_t = tangential_stiffness(law, k_n)
    return k_t, tangential_dashpot(law, k_t, inverse_mass), law.mu > 0.0


@inner_kernel
def rolling_slopes(law, k_t, r_eff, compliance):
    """k_r, c_r, and whether the contact can hold a moment."""
    if law is None:
        return 0.0, 0.0, False
    k_r = rolling_stiffness(law, k_t, r_eff)
    return k_r, rolling_dashpot(law, k_r, compliance), law.mu_r > 0.0


@kernel
def slopes(laws, contacts, k, c):
    """Fill `k` and `c` (n, 3) with springs and dashpots that hold: normal, tangential, rolling."""
    k[:] = 0.0
    c[:] = 0.0
    for a in range(contacts.delta.shape[0]):
        pair = of_pair(laws, contacts.material_i[a], contacts.material_j[a])
        delta, r_eff, inverse_mass = contacts.delta[a], contacts.r_eff[a], contacts.inverse_mass[a]
        k_n = normal_stiffness(pair.normal, delta, r_eff)
        k[a, 0], c[a, 0] = k_n, normal_dashpot(pair.normal, delta, r_eff, inverse_mass)
        k_t, c_t, sticks = shear_slopes(pair.tangential, k_n, inverse_mass)
        k_r, c_r, holds = rolling_slopes(pair.rolling, k_t, r_eff, contacts.compliance[a])
        if sticks:
            k[a, 1], c[a, 1] = k_t, c_t
        if holds:
            k[a, 2], c[a, 2] = k_r, c_r
