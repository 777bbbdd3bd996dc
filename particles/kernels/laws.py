"""Contact laws of one pair: pure functions of numbers. Signs and sources: `particles.contact`."""

import math

from particles.kernels.jit import inner_kernel, kernel
from particles.kernels.layout import Response


@kernel
def linear_normal(law, delta, v_n):
    """Spring-dashpot, repulsive unless it may pull (model 1.2). Returns F_n and the dashpot's part."""
    spring = law.k_n * delta
    f_n = spring - law.c_n * v_n
    if f_n < 0.0 and not law.may_pull:
        f_n = 0.0
    return f_n, f_n - spring


@kernel
def coulomb_tangential(law, f_old, v_t, f_n, dt):
    """Regularised Coulomb friction (model 1.2, G 2.1.7). Returns the spring, F_t and the cut."""
    limit = law.mu * abs(f_n)
    trial = f_old + law.k_t * v_t * dt
    f = trial
    if abs(f) > limit:
        f = math.copysign(limit, f)
        return f, f, trial - f
    f_t = f + law.c_t * v_t
    if abs(f_t) > limit:
        f_t = math.copysign(limit, f_t)
    return f, f_t, 0.0


@kernel
def rolling_stiffness(law, k_t, r_r):
    if law.k_r > 0.0:
        return law.k_r
    return k_t * r_r * r_r


@kernel
def elastic_plastic_rolling(law, k_r, compliance, m_old, omega_r, limit, dt):
    """Elastic-plastic rolling resistance (model 1.2, G 2.1.8). Returns the spring, M on i and the cut."""
    trial = m_old - k_r * omega_r * dt
    m = trial
    if abs(m) > limit:
        m = math.copysign(limit, m)
        return m, m, trial - m
    m_t = m
    if law.eta_r > 0.0 and compliance > 0.0:  # two prescribed grains have no inertia to damp
        m_t -= 2.0 * law.eta_r * math.sqrt(k_r / compliance) * omega_r
        if abs(m_t) > limit:
            m_t = math.copysign(limit, m_t)
    return m, m_t, 0.0


@kernel
def time_in_contact(delta, v_n, dt):
    """Part of the step spent in contact: a contact born within it starts with zero springs.

    The call of hypot, which changes nothing, keeps the compiler from dividing at every contact
    for the sake of the rare birth: 10 % of the whole step.
    """
    if delta < -v_n * dt:
        return math.hypot(delta / v_n, 0.0)
    return dt


@inner_kernel
def respond(normal, tangential, rolling, meeting, f_old, m_old, dt):
    """All laws of one touching pair. A law that is `None` is not compiled."""
    f_n, dash_n = linear_normal(normal, meeting.delta, meeting.v_n)
    f = f_t = m = m_t = cut_t = cut_r = 0.0
    if tangential is not None:
        held = time_in_contact(meeting.delta, meeting.v_n, dt)
        f, f_t, cut_t = coulomb_tangential(tangential, f_old, meeting.v_t, f_n, held)
        if rolling is not None:
            k_r = rolling_stiffness(rolling, tangential.k_t, meeting.r_r)
            limit = rolling.mu_r * meeting.r_r * abs(f_n)
            m, m_t, cut_r = elastic_plastic_rolling(
                rolling, k_r, meeting.compliance, m_old, meeting.omega_r, limit, held
            )
    return Response(f_n, f_t, m_t, f, m, dash_n, f_t - f, m_t - m, cut_t, cut_r)


@inner_kernel
def let_go(tangential, rolling, meeting, f_old, m_old, dt):
    """A contact that opened in this step: no force, all that its springs held is cut."""
    cut_t = cut_r = 0.0
    if tangential is not None:
        cut_t = f_old + tangential.k_t * meeting.v_t * dt
        if rolling is not None:
            cut_r = m_old - rolling_stiffness(rolling, tangential.k_t, meeting.r_r) * meeting.omega_r * dt
    return Response(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, cut_t, cut_r)
