"""Elastic constants of the grains' material, and what two of them are together."""

from dataclasses import dataclass

from particles.errors import ParticleError, require


@dataclass(frozen=True, kw_only=True)
class Material:
    """Isotropic elastic material.

    Parameters
    ----------
    youngs_modulus : float
        E [Pa], > 0.
    poissons_ratio : float
        nu [-], above -1 and not above 0.5.

    Raises
    ------
    ParticleError
        If a number is not finite or out of its range.
    """

    youngs_modulus: float
    poissons_ratio: float

    def __post_init__(self) -> None:
        require("Young's modulus", self.youngs_modulus, above=0.0)
        require("Poisson's ratio", self.poissons_ratio, above=-1.0)
        if self.poissons_ratio > 0.5:
            raise ParticleError(f"Poisson's ratio = {self.poissons_ratio:g} must be at most 0.5")

    @property
    def shear_modulus(self) -> float:
        """G [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))


def effective_modulus(first: Material, second: Material) -> float:
    """E* of Hertz [Pa]: ``1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2``."""
    return 1.0 / sum((1.0 - m.poissons_ratio**2) / m.youngs_modulus for m in (first, second))


def effective_shear_modulus(first: Material, second: Material) -> float:
    """G* of Mindlin [Pa]: ``1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2``."""
    return 1.0 / sum((2.0 - m.poissons_ratio) / m.shear_modulus for m in (first, second))
