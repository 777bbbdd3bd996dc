"""Schemes of time integration of one family: Newmark, Hilber, Hughes and Taylor, generalised alpha."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from structure.checks import positive
from structure.errors import StructureError


class _Scheme:
    """Four numbers: ``M a_m + C v_f + K u_f = f_f`` between the ends of a step, Newmark's increments over it.

    ``x_f = (1 - alpha_f) x1 + alpha_f x``, ``a_m = (1 - alpha_m) a1 + alpha_m a``,
    ``u1 = u + dt v + dt^2 ((1/2 - beta) a + beta a1)``, ``v1 = v + dt ((1 - gamma) a + gamma a1)``.
    """

    beta: float
    gamma: float

    @property
    def alpha_m(self) -> float:
        """Weight of the old acceleration in the inertia."""
        return 0.0

    @property
    def alpha_f(self) -> float:
        """Weight of the old time in all other forces."""
        return 0.0

    @property
    def conserves(self) -> bool:
        """Whether free vibration without damping keeps kinetic plus strain energy to round-off."""
        middle = (self.alpha_m, self.alpha_f) in ((0.0, 0.0), (0.5, 0.5))
        return middle and (self.beta, self.gamma) == (0.25, 0.5)


@dataclass(frozen=True, kw_only=True)
class Newmark(_Scheme):
    """Newmark's parameters (G's alpha is `beta`, G's delta is `gamma`); alpha_m = alpha_f = 0.

    Stable for every step if ``gamma >= 1/2`` and ``beta >= (1/2 + gamma)^2/4`` (G 2.141
    corrected). (1/4, 1/2), average acceleration, is; (1/6, 1/2), linear acceleration, is stable
    for omega dt < 3.46 only and needs ``allow_conditional=True``. beta > 0: the step is implicit.
    """

    beta: float = 0.25
    gamma: float = 0.5
    allow_conditional: bool = False

    def __post_init__(self) -> None:
        positive("beta", self.beta, "Newmark")
        if not np.isfinite(self.gamma) or self.gamma < 0.5:
            raise StructureError(f"gamma = {self.gamma!r} feeds energy at every step: use gamma of at least 0.5")
        least = (0.5 + self.gamma) ** 2 / 4
        if self.beta < least * (1 - 1e-12) and not self.allow_conditional:
            raise StructureError(
                f"beta = {self.beta!r} with gamma = {self.gamma!r} is stable for small steps only: "
                f"use beta of at least {least:g} or allow_conditional=True"
            )


@dataclass(frozen=True, kw_only=True)
class HilberHughesTaylor(_Scheme):
    """The alpha method: order 2, stable for every step, damps high frequencies.

    ``alpha_m = 0``, ``alpha_f = -alpha``, ``gamma = 1/2 - alpha``, ``beta = (1 - alpha)^2/4``. Each step
    multiplies the stiffest modes by ``(1 + alpha)/(1 - alpha)`` at most (in the limit of stiffness, down to
    alpha = -0.3); alpha = 0 is Newmark's (1/4, 1/2).

    alpha [-] lies from -1/3 to 0. Source: Hilber, Hughes and Taylor (1977).
    """

    alpha: float = -0.05

    def __post_init__(self) -> None:
        if not -1.0 / 3.0 <= self.alpha <= 0.0:
            raise StructureError(f"alpha = {self.alpha!r} must lie from -1/3 to 0, where the alpha method is stable")

    @property
    def alpha_f(self) -> float:
        """See the base class."""
        return -self.alpha

    @property
    def gamma(self) -> float:  # type: ignore[override]
        """See the base class."""
        return 0.5 - self.alpha

    @property
    def beta(self) -> float:  # type: ignore[override]
        """See the base class."""
        return (1.0 - self.alpha) ** 2 / 4


@dataclass(frozen=True, kw_only=True)
class GeneralizedAlpha(_Scheme):
    """Order 2, stable for every step, with the least damping of low modes for a chosen one of the stiffest.

    ``alpha_m = (2 r - 1)/(r + 1)``, ``alpha_f = r/(r + 1)``, ``gamma = 1/2 - alpha_m + alpha_f``,
    ``beta = (1 - alpha_m + alpha_f)^2/4``, r the spectral radius: what a step multiplies a mode by
    whose omega dt is infinite. r = 1 is the midpoint rule, which keeps the energy; r = 0 removes such a mode at once.

    spectral_radius [-] lies from 0 to 1. Source: Chung and Hulbert (1993), equations 17 and 25.
    """

    spectral_radius: float = 0.8

    def __post_init__(self) -> None:
        if not 0.0 <= self.spectral_radius <= 1.0:
            raise StructureError(
                f"spectral_radius = {self.spectral_radius!r} must lie from 0 (the stiffest modes vanish at once) to "
                "1 (nothing is damped)"
            )

    @property
    def alpha_m(self) -> float:
        """See the base class."""
        return (2.0 * self.spectral_radius - 1.0) / (self.spectral_radius + 1.0)

    @property
    def alpha_f(self) -> float:
        """See the base class."""
        return self.spectral_radius / (self.spectral_radius + 1.0)

    @property
    def gamma(self) -> float:  # type: ignore[override]
        """See the base class."""
        return 0.5 - self.alpha_m + self.alpha_f

    @property
    def beta(self) -> float:  # type: ignore[override]
        """See the base class."""
        return (1.0 - self.alpha_m + self.alpha_f) ** 2 / 4


Scheme = Newmark | HilberHughesTaylor | GeneralizedAlpha
