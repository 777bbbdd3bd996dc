"""Tangential contact: Coulomb friction regularised by a spring and a dashpot, constant or Mindlin's."""

from dataclasses import dataclass

from particles.contact.material import Material, effective_modulus, effective_shear_modulus
from particles.errors import require
from particles.kernels.laws.tangential import CoulombTangential, MindlinTangential


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

    def stiffness_at(self, normal_stiffness: float) -> float:
        """k_t [N/m]: the same everywhere."""
        return self.stiffness

    def numbers(self) -> CoulombTangential:
        return CoulombTangential(float(self.stiffness), float(self.damping), float(self.friction))


@dataclass(frozen=True, kw_only=True)
class MindlinFriction:
    """Coulomb friction whose spring is in proportion to the slope of the normal one.

    ``k_t = ratio dF_n/d delta``; trial ``f = f_old + k_t v_t dt`` with the mean stiffness of the
    step, or, while the contact is being unloaded, ``f = (f_old/k_t_old + v_t dt) k_t``. Limit and dashpot as for
    `CoulombFriction`, with ``c_t = 2 zeta sqrt(m_eff k_t)`` for every pair.

    Parameters
    ----------
    stiffness_ratio : float
        Tangential over normal stiffness [-], > 0. `of_materials` gives Mindlin's.
    friction : float
        mu [-], >= 0.
    damping_ratio : float
        zeta [-], >= 0.

    Notes
    -----
    With Hertz's spring k_t grows with the overlap. Without the letting go, a contact that is
    sheared under load and opened before it is sheared back would give more energy than it took;
    the energy given up is entered as sliding. The steps of partial slip inside Mindlin and
    Deresiewicz's theory are not resolved. Source: model 1.2.

    Raises
    ------
    ParticleError
        If a number is not finite or has the wrong sign.
    """

    stiffness_ratio: float
    friction: float
    damping_ratio: float = 0.0

    def __post_init__(self) -> None:
        require("tangential stiffness ratio", self.stiffness_ratio, above=0.0)
        require("friction", self.friction, at_least=0.0)
        require("tangential damping ratio", self.damping_ratio, at_least=0.0)

    @classmethod
    def of_materials(
        cls, first: Material, second: Material | None = None, *, friction: float, damping_ratio: float = 0.0
    ) -> "MindlinFriction":
        """Mindlin's no-slip stiffness ``8 G* sqrt(R_eff delta)`` over Hertz's: ``4 G* / E*``."""
        pair = (first, second or first)
        ratio = 4.0 * effective_shear_modulus(*pair) / effective_modulus(*pair)
        return cls(stiffness_ratio=ratio, friction=friction, damping_ratio=damping_ratio)

    def stiffness_at(self, normal_stiffness: float) -> float:
        """k_t [N/m] where the normal spring has the slope `normal_stiffness` [N/m]."""
        return self.stiffness_ratio * normal_stiffness

    def numbers(self) -> MindlinTangential:
        return MindlinTangential(float(self.stiffness_ratio), float(self.damping_ratio), float(self.friction))
