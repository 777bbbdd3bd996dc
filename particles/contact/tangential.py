"""Tangential contact: Coulomb friction regularised by a spring and a dashpot."""

from dataclasses import dataclass

from particles.errors import require
from particles.kernels import layout


@dataclass(frozen=True, kw_only=True)
class CoulombFriction:
    """Regularised Coulomb friction with a spring stored per contact.

    Trial ``f = f_old + k_t v_t dt``. If ``|f| <= mu |F_n|`` the contact sticks and
    ``F_t = f + c_t v_t``, cut at ``mu |F_n|``; else it slides, ``f = F_t = mu |F_n| sign(f)``.

    Parameters
    ----------
    stiffness : float
        k_t [N/m], > 0.
    friction : float
        mu [-], >= 0.
    damping : float
        c_t [N s/m], >= 0.

    Notes
    -----
    v_t [m/s] is the tangential velocity of j against i at mid-overlap along t = (-n_y, n_x);
    the force on i is ``F_t t``, its torque ``a_i F_t`` with the lever arm ``a_i = r_i - delta/2``,
    and likewise on j: angular momentum is kept exactly. A contact is born with a zero spring at
    the moment of touching, which is found inside the step from the overlap and v_n; it forgets
    the spring when it opens.
    Source: model 1.2; Gomes 2014, section 2.1.7 with the sign of 2.46 corrected.

    Raises
    ------
    ParticleError
        If a number is not finite or has the wrong sign.
    """

    stiffness: float
    friction: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        require("tangential stiffness", self.stiffness, above=0.0)
        require("friction", self.friction, at_least=0.0)
        require("tangential damping", self.damping, at_least=0.0)

    def numbers(self) -> layout.CoulombTangential:
        return layout.CoulombTangential(float(self.stiffness), float(self.damping), float(self.friction))
