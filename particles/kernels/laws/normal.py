"""Normal force: spring and dashpot."""

import math
from typing import NamedTuple

from particles.kernels.jit import by_law, inner_kernel


class LinearNormal(NamedTuple):
    """k_n delta and one dashpot for all pairs."""

    k_n: float
    c_n: float
    may_pull: bool


class LinearRestitution(NamedTuple):
    """k_n delta and a dashpot for each pair, c_n = 2 zeta sqrt(m_eff k_n)."""

    k_n: float
    zeta: float
    may_pull: bool


class HertzNormal(NamedTuple):
    """k_h delta^(3/2) and Tsuji's dashpot, c_n = sqrt(5) zeta sqrt(m_eff k_h) delta^(1/4)."""

    k_h: float  # 0: 4/3 e_star sqrt(r_eff)
    e_star: float
    zeta: float
    may_pull: bool


@by_law
def normal_spring(law, delta, r_eff):
    """Force of the spring."""


@by_law
def normal_stiffness(law, delta, r_eff):
    """Slope of the spring."""


@by_law
def normal_energy(law, delta, r_eff):
    """Energy stored in the spring."""


@by_law
def normal_dashpot(law, delta, r_eff, inverse_mass):
    """Coefficient of the dashpot. `inverse_mass` is 1/m_eff, 0 between bodies that are not integrated."""


@inner_kernel
def normal_force(law, meeting, v_n):
    """F_n, repulsive unless it may pull (model 1.2), and the dashpot's part of it."""
    spring = normal_spring(law, meeting.delta, meeting.r_eff)
    f_n = spring - normal_dashpot(law, meeting.delta, meeting.r_eff, meeting.inverse_mass) * v_n
    if f_n < 0.0 and not law.may_pull:
        f_n = 0.0
    return f_n, f_n - spring


@normal_spring.of(LinearNormal, LinearRestitution)
def _(law, delta, r_eff):
    return law.k_n * delta


@normal_stiffness.of(LinearNormal, LinearRestitution)
def _(law, delta, r_eff):
    return law.k_n


@normal_energy.of(LinearNormal, LinearRestitution)
def _(law, delta, r_eff):
    return 0.5 * law.k_n * delta * delta


@normal_dashpot.of(LinearNormal)
def _(law, delta, r_eff, inverse_mass):
    return law.c_n


@normal_dashpot.of(LinearRestitution)
def _(law, delta, r_eff, inverse_mass):
    if inverse_mass == 0.0:
        return 0.0
    return 2.0 * law.zeta * math.sqrt(law.k_n / inverse_mass)


@inner_kernel
def hertz(law, r_eff):
    if law.k_h > 0.0:
        return law.k_h
    return 4.0 / 3.0 * law.e_star * math.sqrt(r_eff)


@normal_spring.of(HertzNormal)
def _(law, delta, r_eff):
    return hertz(law, r_eff) * delta * math.sqrt(delta)


@normal_stiffness.of(HertzNormal)
def _(law, delta, r_eff):
    return 1.5 * hertz(law, r_eff) * math.sqrt(delta)


@normal_energy.of(HertzNormal)
def _(law, delta, r_eff):
    return 0.4 * hertz(law, r_eff) * delta * delta * math.sqrt(delta)


@normal_dashpot.of(HertzNormal)
def _(law, delta, r_eff, inverse_mass):
    if inverse_mass == 0.0:
        return 0.0
    return law.zeta * math.sqrt(5.0 * hertz(law, r_eff) * math.sqrt(delta) / inverse_mass)
