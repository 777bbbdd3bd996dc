"""Normal contact: linear and Hertzian springs with their dashpots."""

import math
from dataclasses import dataclass

from particles.contact.material import Material, effective_modulus
from particles.contact.recipe import damping_ratio
from particles.errors import ParticleError, require
from particles.kernels.laws.normal import HertzNormal, LinearNormal, LinearRestitution


@dataclass(frozen=True, kw_only=True)
class LinearSpringDashpot:
    """Normal force of a spring and a dashpot in parallel.

    ``F_n = max(0, k_n delta - c_n v_n)``; without the maximum if the contact `may_pull`.

    Parameters
    ----------
    stiffness : float
        k_n [N/m per unit thickness], > 0.
    damping : float
        c_n [N s/m], >= 0; one value for all contacts.
    restitution : float, optional
        e [-], from 1e-12 to 1, instead of `damping`: every pair gets the dashpot
        ``2 zeta sqrt(m_eff k_n)`` that makes it rebound with e (`recipe.damping_ratio`). m_eff is
        ``m_i m_j / (m_i + m_j)``, at a wall or a prescribed grain the mass of the free one.
    may_pull : bool
        Keep the force when it is an attraction (ends the contact at zero overlap instead of
        zero force).

    Notes
    -----
    overlap: delta [m] > 0 in contact. v_n [m/s] is the normal velocity of j against i, negative
    on approach. F_n > 0 pushes the grains apart. Valid for overlaps small against the radii.
    Source: model 1.2; Gomes 2014, section 2.1.6 and figure 2.6.

    Raises
    ------
    ParticleError
        If a number is not finite or has the wrong sign.
    """

    stiffness: float
    damping: float = 0.0
    restitution: float | None = None
    may_pull: bool = False

    def __post_init__(self) -> None:
        require("normal stiffness", self.stiffness, above=0.0)
        require("normal damping", self.damping, at_least=0.0)
        if self.restitution is not None:
            damping_ratio(self.restitution, may_pull=self.may_pull)
            if self.damping > 0.0:
                raise ParticleError("normal damping and restitution say the same thing twice: give one of them")

    def stiffness_at(self, overlap: float, effective_radius: float) -> float:
        """Slope of the spring [N/m]: the same everywhere."""
        return self.stiffness

    def numbers(self) -> LinearNormal | LinearRestitution:
        if self.restitution is None:
            return LinearNormal(float(self.stiffness), float(self.damping), bool(self.may_pull))
        zeta = damping_ratio(self.restitution, may_pull=self.may_pull)
        return LinearRestitution(float(self.stiffness), zeta, bool(self.may_pull))


@dataclass(frozen=True, kw_only=True)
class HertzSpringDashpot:
    """Hertz's spring with a dashpot whose restitution does not depend on the speed (Tsuji).

    ``F_n = max(0, k_h delta^(3/2) - c(delta) v_n)`` with
    ``c = sqrt(5) zeta sqrt(m_eff k_h) delta^(1/4)``; without the maximum if the contact `may_pull`.

    Parameters
    ----------
    stiffness : float, optional
        k_h [N/m^(3/2)], > 0, the same for all pairs; or
    modulus : float, optional
        E* [N/m2 per unit thickness], > 0: then ``k_h = 4/3 E* sqrt(R_eff)`` with
        ``R_eff = r_i r_j / (r_i + r_j)``, at a wall r_i. `of_materials` computes it.
    restitution : float
        e [-], from 1e-12 to 1, kept exactly by every pair, with `may_pull` or without.
    may_pull : bool
        As for `LinearSpringDashpot`.

    Notes
    -----
    Hertz's law is that of spheres: the discs stand for spheres in a layer of unit thickness.
    With y proportional to delta^(5/4) the motion in (y, v) is that of a linear spring and dashpot
    with the damping ratio zeta, and zero force is the same state of it: the relation between e and
    zeta is the linear one. Source: model 1.2.

    Raises
    ------
    ParticleError
        If a number is not finite or has the wrong sign, or both stiffness and modulus are given.
    """

    stiffness: float | None = None
    modulus: float | None = None
    restitution: float = 1.0
    may_pull: bool = False

    def __post_init__(self) -> None:
        if (self.stiffness is None) == (self.modulus is None):
            raise ParticleError("Hertz's spring needs its stiffness or the modulus of its material: give one of them")
        require("Hertz stiffness", self.stiffness if self.modulus is None else self.modulus, above=0.0)
        damping_ratio(self.restitution, may_pull=self.may_pull)

    @classmethod
    def of_materials(
        cls, first: Material, second: Material | None = None, *, restitution: float = 1.0, may_pull: bool = False
    ) -> "HertzSpringDashpot":
        """Contact of two materials, or of one with itself: ``1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2``."""
        return cls(modulus=effective_modulus(first, second or first), restitution=restitution, may_pull=may_pull)

    def stiffness_at(self, overlap: float, effective_radius: float) -> float:
        """Slope of the spring [N/m] at an overlap [m] between grains of an effective radius [m]."""
        k_h = self.stiffness or 4.0 / 3.0 * self.modulus * math.sqrt(effective_radius)
        return 1.5 * k_h * math.sqrt(overlap)

    def numbers(self) -> HertzNormal:
        zeta = damping_ratio(self.restitution, may_pull=self.may_pull)
        return HertzNormal(float(self.stiffness or 0.0), float(self.modulus or 0.0), zeta, bool(self.may_pull))
