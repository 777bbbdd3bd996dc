"""Linear elasticity in plane strain and Rayleigh damping: the parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from structure import checks
from structure.errors import StructureError


@dataclass(frozen=True, kw_only=True)
class PlaneStrain:
    """Isotropic linear elasticity, small strain, plane strain.

    ``sigma = lam tr(eps) 1 + 2 mu eps``, ``sigma_zz = nu (sigma_xx + sigma_yy)``; tension positive.

    Parameters
    ----------
    youngs_modulus : E [Pa], > 0
    poissons_ratio : nu [-], -1 < nu < 0.5; near 0.5 (tested to 0.4999) enhanced quadrilaterals give
        displacement and stress, standard elements lock and give no stress to rely on
    density : rho [kg/m^3], > 0

    Source: G 2.2, with the plane strain matrix in place of G 2.137.
    """

    youngs_modulus: float
    poissons_ratio: float
    density: float

    def __post_init__(self) -> None:
        checks.positive("youngs_modulus", self.youngs_modulus, "Pa")
        checks.positive("density", self.density, "kg/m^3")
        if not -1.0 < self.poissons_ratio < 0.5:
            raise StructureError(
                f"poissons_ratio = {self.poissons_ratio!r} must lie above -1 and below 0.5: "
                "an incompressible solid (0.5) cannot be modelled by displacements alone"
            )

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's ``lam = E nu/((1+nu)(1-2nu))`` and ``mu = E/(2(1+nu))`` [Pa]."""
        e, nu = self.youngs_modulus, self.poissons_ratio
        return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))

    @property
    def elasticity(self) -> NDArray[np.float64]:
        """Matrix (3, 3) [Pa] from (eps_xx, eps_yy, gamma_xy) to (sigma_xx, sigma_yy, sigma_xy)."""
        lam, mu = self.lame
        return np.array([[lam + 2 * mu, lam, 0.0], [lam, lam + 2 * mu, 0.0], [0.0, 0.0, mu]])

    def stress(self, strain: NDArray[np.float64]) -> NDArray[np.float64]:
        """Stress [Pa] (..., 4) as xx, yy, xy, zz of the strain (..., 3) as xx, yy, xy (tensor)."""
        lam, mu = self.lame
        trace = strain[..., 0] + strain[..., 1]
        xx, yy = (lam * trace + 2 * mu * strain[..., k] for k in (0, 1))
        xy = 2 * mu * strain[..., 2]
        return np.stack([xx, yy, xy, self.poissons_ratio * (xx + yy)], axis=-1)


def von_mises(stress: NDArray[np.float64]) -> NDArray[np.float64]:
    """Von Mises stress [Pa] (...) of (..., 4) as xx, yy, xy, zz."""
    xx, yy, xy, zz = np.moveaxis(stress, -1, 0)
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xy**2)


def largest_principal_strain(strain: NDArray[np.float64]) -> NDArray[np.float64]:
    """Principal strain of largest magnitude, as magnitude, (...) of (..., 3) as xx, yy, xy."""
    xx, yy, xy = np.moveaxis(strain, -1, 0)
    return np.abs(xx + yy) / 2 + np.hypot((xx - yy) / 2, xy)


@dataclass(frozen=True, kw_only=True)
class Rayleigh:
    """Damping ``C = c_a M + c_b K``; a mode omega has the ratio ``(c_a/omega + c_b omega)/2``.

    Parameters
    ----------
    mass_factor : c_a [1/s], >= 0
    stiffness_factor : c_b [s], >= 0

    Source: G 2.2 (c_a = 0.005 1/s, c_b = 0.003 s). The mass factor also brakes rigid motion.
    """

    mass_factor: float = 0.0
    stiffness_factor: float = 0.0

    def __post_init__(self) -> None:
        checks.not_negative("mass_factor", self.mass_factor, "1/s")
        checks.not_negative("stiffness_factor", self.stiffness_factor, "s")

    @property
    def overdamped_above(self) -> float:
        """Angular frequency [rad/s] above which no mode swings: ``2/c_b`` (c_a neglected)."""
        return 2 / self.stiffness_factor if self.stiffness_factor > 0 else math.inf
