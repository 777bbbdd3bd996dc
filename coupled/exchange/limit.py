"""The stiffness ratio up to which the predicted exchange is stable, by scheme of time integration."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from structure import Scheme

# Measured on the real code (docs/validation/stability.md, tests/coupled/test_stability_limits.py): with fixed partners
# the predicted exchange is stable up to r = 2, with sub-cycling up to 1.0 to 2.9, by the dashpots and the substeps.
CONSERVING, CONSERVING_SUBCYCLED = 2.0, 1.0
ITERATED = 100.0  # up to where the iterated exchange was measured; it is stable beyond
OWN_STIFFNESS = np.concatenate([[0.0], np.logspace(-2.0, 6.0, 81)])  # omega^2 dt^2 of a mode of the structure
ROUND_OFF = 1e-7  # of a spectral radius whose eigenvalues may coincide
HALVINGS = 20


@cache
def exchange_limit(scheme: Scheme, substeps: int = 1) -> float:
    """The limit of r on fixed partners.

    One mode of the structure (unit mass and step, own stiffness K) on an interface spring r whose force is taken at
    the predicted place, ``F1 = -r (u + v + a/2)``: the largest r, at most 2, at which no eigenvalue of a step leaves
    the unit circle, the smallest of that over all K. With Newmark's (1/4, 1/2) and the midpoint rule it is 2 for every
    K; schemes that damp little lose stability at large K, where they lag behind the predicted place. Dashpots allow
    more. With sub-cycling the limit falls in the same proportion as for schemes that conserve.
    """
    limit = CONSERVING
    if not scheme.conserves:
        high = np.full(len(OWN_STIFFNESS), CONSERVING)
        low = np.where(_spectral_radius(scheme, high) <= 1.0 + ROUND_OFF, high, 0.0)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            stable = _spectral_radius(scheme, middle) <= 1.0 + ROUND_OFF
            low, high = np.where(stable, middle, low), np.where(stable, high, middle)
        limit = float(low.min())
    return limit if substeps == 1 else limit * CONSERVING_SUBCYCLED / CONSERVING


def _spectral_radius(scheme: Scheme, r: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of the map from (u, v, a, F) to the same a step later, one per own stiffness."""
    a_m, a_f, beta, gamma = scheme.alpha_m, scheme.alpha_f, scheme.beta, scheme.gamma
    new, old = np.zeros((2, len(r), 4, 4))
    new[:, 0], old[:, 0] = [1.0, 0.0, -beta, 0.0], [1.0, 1.0, 0.5 - beta, 0.0]
    new[:, 1], old[:, 1] = [0.0, 1.0, -gamma, 0.0], [0.0, 1.0, 1.0 - gamma, 0.0]
    new[:, 2], old[:, 2] = [0.0, 0.0, 1.0 - a_m, a_f - 1.0], [0.0, 0.0, -a_m, a_f]
    new[:, 2, 0], old[:, 2, 0] = OWN_STIFFNESS * (1.0 - a_f), -OWN_STIFFNESS * a_f
    new[:, 3, 3] = 1.0
    old[:, 3, :3] = -r[:, None] * [1.0, 1.0, 0.5]
    return np.abs(np.linalg.eigvals(np.linalg.solve(new, old))).max(axis=1)
