"""All laws of one contact together."""

from typing import Any, NamedTuple

from particles.kernels.jit import inner_kernel, rarely
from particles.kernels.laws.normal import normal_force, normal_stiffness
from particles.kernels.laws.rolling import rolling_moment, rolling_slip_energy, rolling_stiffness, rolling_trial
from particles.kernels.laws.tangential import (
    present,
    slip_energy,
    tangential_force,
    tangential_stiffness,
    tangential_trial,
)


class Laws(NamedTuple):
    """The contact law of a scene. What is None is not modelled."""

    normal: Any
    tangential: Any
    rolling: Any


class Meeting(NamedTuple):
    """Kinematics of one contact of i with j (model 1.1), its radius and inertias."""

    delta: float
    delta_before: float  # at the step before
    v_n: float
    v_t: float
    omega_r: float
    r_eff: float  # r_i r_j / (r_i + r_j), at a wall r_i
    inverse_mass: float  # 1/m_i + 1/m_j
    compliance: float  # 1/(I_i + m_i r_i^2) + (j)


class Now(NamedTuple):
    """The velocities that dashpots see, at the present as far as the scheme knows; springs follow the step's motion."""

    v_n: float
    v_t: float
    omega_r: float


class Response(NamedTuple):
    """What a contact does: totals, spring parts, the dashpots' share, and what the limits cut off the trials."""

    f_n: float
    f_t: float
    m_t: float
    spring: float
    moment: float
    dash_n: float
    dash_t: float
    dash_r: float
    cut_t: float
    cut_r: float


@inner_kernel
def time_in_contact(delta, v_n, dt):
    """Part of the step spent in contact: a contact born within it starts with zero springs."""
    if delta < -v_n * dt:
        return rarely(-delta / v_n)
    return dt


@inner_kernel
def shear_stiffnesses(laws, meeting):
    """k_t and k_r now, and k_t at the step before."""
    now, before = max(meeting.delta, 0.0), max(meeting.delta_before, 0.0)
    k_t = tangential_stiffness(laws.tangential, normal_stiffness(laws.normal, now, meeting.r_eff))
    k_before = tangential_stiffness(laws.tangential, normal_stiffness(laws.normal, before, meeting.r_eff))
    return k_t, rolling_stiffness(laws.rolling, k_t, meeting.r_eff), k_before


@inner_kernel
def respond(laws, meeting, now, f_old, m_old, dt):
    """A touching pair."""
    f_n, dash_n = normal_force(laws.normal, meeting, now.v_n)
    k_t, k_r, k_before = shear_stiffnesses(laws, meeting)
    held = dt
    if present(laws.tangential):  # nothing is stored without: spares a call that the compiler may not leave out
        held = time_in_contact(meeting.delta, meeting.v_n, dt)
    trial_t = tangential_trial(laws.tangential, f_old, meeting.v_t * held, k_t, k_before)
    trial_r = rolling_trial(laws.rolling, m_old, meeting.omega_r * held, k_r)
    f, f_t = tangential_force(laws.tangential, trial_t, f_n, now.v_t, k_t, meeting.inverse_mass)
    m, m_t = rolling_moment(laws.rolling, trial_r, f_n, meeting, now.omega_r, k_r)
    return Response(f_n, f_t, m_t, f, m, dash_n, f_t - f, m_t - m, trial_t - f, trial_r - m)


@inner_kernel
def let_go(laws, meeting, f_old, m_old, dt):
    """A contact that opened in this step: no force, all that its springs held is cut."""
    k_t, k_r, k_before = shear_stiffnesses(laws, meeting)
    cut_t = tangential_trial(laws.tangential, f_old, meeting.v_t * dt, k_t, k_before)
    cut_r = rolling_trial(laws.rolling, m_old, meeting.omega_r * dt, k_r)
    return Response(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, cut_t, cut_r)


@inner_kernel
def slip_energies(laws, meeting, f_old, m_old, response, dt):
    """Twice the energies that the tangential and the rolling spring lost by slip in this step."""
    k_t, k_r, k_before = shear_stiffnesses(laws, meeting)
    path = meeting.v_t * dt
    return (
        slip_energy(laws.tangential, f_old, response.spring, response.cut_t, path, k_t, k_before),
        rolling_slip_energy(laws.rolling, m_old, response.moment, response.cut_r, k_r),
    )
