"""Rolling contact: elastic-plastic spring and dashpot, or a constant torque."""

from dataclasses import dataclass

from particles.errors import require
from particles.kernels.laws import rolling as laws
from particles.kernels.laws.rolling import ConstantRolling, DampedRolling


@dataclass(frozen=True, kw_only=True)
class ElasticPlasticRolling:
    """Rolling resistance by a moment spring with a limit.

    Trial ``M = M_old - k_r omega_r dt`` on i, ``-M`` on j. Below the limit ``mu_r R_r |F_n|`` the
    dashpot ``- c_r omega_r`` is added (the total cut at the limit); at the limit the spring is
    cut and the dashpot is off.

    Parameters
    ----------
    friction : float
        mu_r [-], >= 0.
    damping_ratio : float
        eta_r [-], >= 0: ``c_r = eta_r 2 sqrt(I_r k_r)``, ``1/I_r = 1/(I_i + m_i r_i^2) + (j)``;
        a wall or a prescribed grain has no j term.
    stiffness : float or None
        k_r [N m/rad]; None: ``k_t R_r^2`` with ``R_r = r_i r_j / (r_i + r_j)`` (a wall: r_i).

    Notes
    -----
    ``omega_r = omega_i - omega_j`` [rad/s], counter-clockwise positive. Needs friction: it is the
    tangential spring that gives k_r and keeps the grain from slipping.
    Source: model 1.2; Gomes 2014, section 2.1.8, corrected in model 7.

    Raises
    ------
    ParticleError
        If a number is not finite or has the wrong sign.
    """

    friction: float
    damping_ratio: float = 0.0
    stiffness: float | None = None

    def __post_init__(self) -> None:
        require("rolling friction", self.friction, at_least=0.0)
        require("rolling damping ratio", self.damping_ratio, at_least=0.0)
        if self.stiffness is not None:
            require("rolling stiffness", self.stiffness, above=0.0)

    def numbers(self) -> laws.ElasticPlasticRolling | DampedRolling:
        spring = (float(self.friction), float(self.stiffness or 0.0))
        if self.damping_ratio > 0.0:
            return DampedRolling(*spring, float(self.damping_ratio))
        return laws.ElasticPlasticRolling(*spring)


@dataclass(frozen=True, kw_only=True)
class ConstantTorqueRolling:
    """Rolling resistance by the limit moment against any rolling (type A).

    ``M = - mu_r R_r |F_n| sign(omega_r)`` on i, ``-M`` on j, zero when nothing rolls. It stops
    rolling grains but holds none: at rest the moment changes its sign from step to step, and on a
    slope grains creep. For quasi-static beds take `ElasticPlasticRolling`.

    Parameters
    ----------
    friction : float
        mu_r [-], >= 0.

    Notes
    -----
    ``omega_r = omega_i - omega_j`` [rad/s], ``R_r = r_i r_j / (r_i + r_j)`` (a wall: r_i).

    Raises
    ------
    ParticleError
        If the number is not finite or negative.
    """

    friction: float

    def __post_init__(self) -> None:
        require("rolling friction", self.friction, at_least=0.0)

    def numbers(self) -> ConstantRolling:
        return ConstantRolling(float(self.friction))
