"""Tangential force: Coulomb's limit on a spring and dashpot."""

import math
from typing import NamedTuple

from particles.kernels.jit import by_law, inner_kernel, rarely


class CoulombTangential(NamedTuple):
    """One spring and one dashpot for all pairs."""

    k_t: float
    c_t: float
    mu: float


class MindlinTangential(NamedTuple):
    """A spring in proportion to the normal one, k_t = ratio dF_n/d delta, and c_t = 2 zeta sqrt(m_eff k_t)."""

    ratio: float
    zeta: float
    mu: float


@by_law
def present(law):
    """Whether a law is modelled."""


@by_law
def tangential_stiffness(law, k_n):
    """Slope of the spring, where the normal one has the slope `k_n`."""


@by_law
def tangential_dashpot(law, k_t, inverse_mass):
    """Coefficient of the dashpot."""


@by_law
def tangential_trial(law, f_old, path, k_t, k_before):
    """Spring force after a `path` without slip; `f_old` was stored with the stiffness `k_before`."""


@by_law
def slip_energy(law, f_old, f, cut, path, k_t, k_before):
    """Twice the energy that the spring lost in a step in which `cut` was cut off its trial force."""


@by_law
def tangential_force(law, trial, f_n, v_t, k_t, inverse_mass):
    """Spring and F_t under Coulomb's limit (model 1.2, G 2.1.7)."""


@inner_kernel
def limited(trial, dashpot, limit):
    """Spring and total of a slider that yields at `limit`; a spring at the limit has no dashpot."""
    if abs(trial) > limit:
        f = math.copysign(limit, trial)
        return f, f
    total = trial + dashpot
    if abs(total) > limit:
        total = math.copysign(limit, total)
    return trial, total


@present.of(None)
def _(law):
    return False


@tangential_stiffness.of(None)
def _(law, k_n):
    return 0.0


@tangential_trial.of(None)
def _(law, f_old, path, k_t, k_before):
    return 0.0


@slip_energy.of(None)
def _(law, f_old, f, cut, path, k_t, k_before):
    return 0.0


@tangential_force.of(None)
def _(law, trial, f_n, v_t, k_t, inverse_mass):
    return 0.0, 0.0


@present.of(CoulombTangential, MindlinTangential)
def _(law):
    return True


@tangential_force.of(CoulombTangential, MindlinTangential)
def _(law, trial, f_n, v_t, k_t, inverse_mass):
    return limited(trial, tangential_dashpot(law, k_t, inverse_mass) * v_t, law.mu * abs(f_n))


@tangential_stiffness.of(CoulombTangential)
def _(law, k_n):
    return law.k_t


@tangential_dashpot.of(CoulombTangential)
def _(law, k_t, inverse_mass):
    return law.c_t


@tangential_trial.of(CoulombTangential)
def _(law, f_old, path, k_t, k_before):
    return f_old + k_t * path


@slip_energy.of(CoulombTangential)
def _(law, f_old, f, cut, path, k_t, k_before):
    if cut == 0.0:
        return 0.0
    return rarely((f_old + f) * cut / k_t)  # mean force times the part of the path that did not stretch the spring


@tangential_stiffness.of(MindlinTangential)
def _(law, k_n):
    return law.ratio * k_n


@tangential_dashpot.of(MindlinTangential)
def _(law, k_t, inverse_mass):
    if inverse_mass == 0.0:
        return 0.0
    return 2.0 * law.zeta * math.sqrt(k_t / inverse_mass)


@tangential_trial.of(MindlinTangential)
def _(law, f_old, path, k_t, k_before):
    if k_t < k_before:  # unloaded, it lets go in proportion: it would give back more than it took
        return f_old * k_t / k_before + k_t * path
    return f_old + 0.5 * (k_before + k_t) * path


@inner_kernel
def stored_twice(f, k_t):
    return f * f / k_t if k_t > 0.0 else 0.0


@slip_energy.of(MindlinTangential)
def _(law, f_old, f, cut, path, k_t, k_before):
    return (f_old + f) * path + stored_twice(f_old, k_before) - stored_twice(f, k_t)
