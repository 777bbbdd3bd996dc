"""Contact numbers from physical wishes (model 1.3; Gomes 2014, section 2.1.10, corrected)."""

import math

from scipy.optimize import brentq

from particles.errors import ParticleError, require

LEAST_RESTITUTION = 1e-12  # of a dashpot 5e5 times critical


def stiffness_from_drop_height(*, mass: float, gravity: float, drop_height: float, largest_overlap: float) -> float:
    """Normal stiffness at which a fall from `drop_height` [m] overlaps by `largest_overlap` [m].

    ``k_n = 2 m g h_0 / delta_max^2`` [N/m]; mass [kg/m], gravity [m/s2].
    """
    speed = math.sqrt(2.0 * gravity * drop_height)
    return stiffness_from_impact_speed(mass=mass, speed=speed, largest_overlap=largest_overlap)


def stiffness_from_impact_speed(*, mass: float, speed: float, largest_overlap: float) -> float:
    """Normal stiffness at which an impact at `speed` [m/s] overlaps by `largest_overlap` [m].

    ``k_n = m v_0^2 / delta_max^2`` [N/m].
    """
    for name, value in (("mass", mass), ("speed", speed), ("largest overlap", largest_overlap)):
        require(name, value, above=0.0)
    return mass * (speed / largest_overlap) ** 2


def damping_from_restitution(*, restitution: float, effective_mass: float, stiffness: float, may_pull: bool) -> float:
    """Dashpot [N s/m] at which a contact rebounds with `restitution`.

    With tension allowed, ``c = -2 ln(e) sqrt(m k) / sqrt(ln(e)^2 + pi^2)``. Without (the default of
    the contact laws) the contact ends at zero force, and the damping ratio is the root of
    `restitution_without_tension`. effective_mass [kg/m]: ``m_i m_j / (m_i + m_j)``, or m at a wall.
    """
    require("effective mass", effective_mass, above=0.0)
    require("stiffness", stiffness, above=0.0)
    return 2.0 * damping_ratio(restitution, may_pull=may_pull) * math.sqrt(effective_mass * stiffness)


def damping_ratio(restitution: float, *, may_pull: bool) -> float:
    """Dashpot over critical dashpot at which a contact rebounds with `restitution`, from 1e-12 to 1."""
    if not LEAST_RESTITUTION <= restitution <= 1.0:
        raise ParticleError(f"restitution = {restitution:g} must lie between {LEAST_RESTITUTION:g} and 1")
    if restitution == 1.0:
        return 0.0
    if may_pull:
        return -math.log(restitution) / math.hypot(math.log(restitution), math.pi)
    return _ratio_without_tension(restitution)


def restitution_with_tension(damping_ratio: float) -> float:
    """Rebound speed over impact speed of a spring and dashpot released at zero overlap."""
    if damping_ratio >= 1.0:
        return 0.0
    return math.exp(-math.pi * damping_ratio / math.sqrt(1.0 - damping_ratio**2))


def restitution_without_tension(damping_ratio: float) -> float:
    """Rebound speed over impact speed when the contact ends at zero force.

    ``e = exp(-z t)``, where t is the first time, in units of 1/omega_0, at which spring and dashpot
    cancel: ``t = atan2(2 z w, 2 z^2 - 1) / w`` with ``w = sqrt(1 - z^2)`` below critical damping
    z = 1, 2 at it, ``2 arccosh(z) / sqrt(z^2 - 1)`` above.
    """
    z = damping_ratio
    if abs(z - 1.0) < 1e-9:
        return math.exp(-2.0)
    if z < 1.0:
        w = math.sqrt(1.0 - z * z)
        return math.exp(-z * math.atan2(2.0 * z * w, 2.0 * z * z - 1.0) / w)
    return math.exp(-z * 2.0 * math.acosh(z) / math.sqrt(z * z - 1.0))


def _ratio_without_tension(restitution: float) -> float:
    return brentq(lambda z: restitution_without_tension(z) - restitution, 0.0, 1e6, xtol=1e-14, rtol=1e-14)
