"""Rolling moment."""

import math
from typing import NamedTuple

from particles.kernels.jit import by_law, rarely
from particles.kernels.laws.tangential import limited


class ElasticPlasticRolling(NamedTuple):
    """A spring with a limit."""

    mu_r: float
    k_r: float  # 0: k_t r_eff^2


class DampedRolling(NamedTuple):
    """The same with a dashpot, eta_r times the critical one."""

    mu_r: float
    k_r: float
    eta_r: float


class ConstantRolling(NamedTuple):
    """The limit moment against any rolling."""

    mu_r: float


@by_law
def turns_spring(law):
    """Whether a contact remembers a moment."""


@by_law
def turns_dashpot(law):
    """Whether a part of the moment is not stored."""


@by_law
def rolling_stiffness(law, k_t, r_eff):
    """Stiffness of the spring."""


@by_law
def rolling_dashpot(law, k_r, compliance):
    """Coefficient of the dashpot. `compliance` is 1/I_r, 0 between bodies that are not integrated."""


@by_law
def rolling_trial(law, m_old, angle, k_r):
    """Moment of the spring after the grain turned by `angle` without slip."""


@by_law
def rolling_slip_energy(law, m_old, m, cut, k_r):
    """Twice the energy that the spring lost in a step in which `cut` was cut off its trial moment."""


@by_law
def rolling_moment(law, trial, f_n, meeting, omega_r, k_r):
    """Spring and moment on i under the limit (model 1.2, G 2.1.8)."""


@turns_spring.of(None, ConstantRolling)
def _(law):
    return False


@turns_spring.of(ElasticPlasticRolling, DampedRolling)
def _(law):
    return True


@turns_dashpot.of(None, ElasticPlasticRolling)
def _(law):
    return False


@turns_dashpot.of(DampedRolling, ConstantRolling)
def _(law):
    return True


@rolling_stiffness.of(None, ConstantRolling)
def _(law, k_t, r_eff):
    return 0.0


@rolling_trial.of(None, ConstantRolling)
def _(law, m_old, angle, k_r):
    return 0.0


@rolling_slip_energy.of(None, ConstantRolling)
def _(law, m_old, m, cut, k_r):
    return 0.0


@rolling_dashpot.of(None, ConstantRolling, ElasticPlasticRolling)
def _(law, k_r, compliance):
    return 0.0


@rolling_moment.of(None)
def _(law, trial, f_n, meeting, omega_r, k_r):
    return 0.0, 0.0


@rolling_moment.of(ConstantRolling)
def _(law, trial, f_n, meeting, omega_r, k_r):
    if omega_r == 0.0:
        return 0.0, 0.0
    return 0.0, -math.copysign(law.mu_r * meeting.r_eff * abs(f_n), omega_r)


@rolling_stiffness.of(ElasticPlasticRolling, DampedRolling)
def _(law, k_t, r_eff):
    if law.k_r > 0.0:
        return law.k_r
    return k_t * r_eff * r_eff


@rolling_trial.of(ElasticPlasticRolling, DampedRolling)
def _(law, m_old, angle, k_r):
    return m_old - k_r * angle


@rolling_slip_energy.of(ElasticPlasticRolling, DampedRolling)
def _(law, m_old, m, cut, k_r):
    if cut == 0.0:
        return 0.0
    return rarely((m_old + m) * cut / k_r)


@rolling_dashpot.of(DampedRolling)
def _(law, k_r, compliance):
    if compliance == 0.0:  # two prescribed grains have no inertia to damp
        return 0.0
    return 2.0 * law.eta_r * math.sqrt(k_r / compliance)


@rolling_moment.of(ElasticPlasticRolling, DampedRolling)
def _(law, trial, f_n, meeting, omega_r, k_r):
    dashpot = -rolling_dashpot(law, k_r, meeting.compliance) * omega_r
    return limited(trial, dashpot, law.mu_r * meeting.r_eff * abs(f_n))
