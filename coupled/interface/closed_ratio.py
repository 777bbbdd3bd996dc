"""The stiffness ratio of the contacts that are closed now: what the exchange has to bear at this moment."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh_tridiagonal
from scipy.sparse import csr_matrix

from coupled.interface.door import Interface
from particles import ContactLook, ParticleSystem
from structure import Structure

Floats = NDArray[np.float64]
STEPS = 12  # of Lanczos: the largest eigenvalue to a per cent or two, from below


class ClosedRatio:
    """``r = (H^2 k + 2 H c) lambda``, lambda the largest eigenvalue of ``P M^-1 P^T`` over the closed contacts.

    k is the slope of the stiffest law at the deepest of their overlaps, c its dashpot. What all contacts that are
    possible would have together, each on one fixed partner, is `stiffness_ratio`; this one is smaller while few
    are closed, and larger where glued grains have several partners or Hertz's contacts are pressed deeper than 5 %
    of a radius.

    Parameters
    ----------
    interface, structure
    spring : callable
        k [N/m] and c [N s/m] at an overlap [m]. Asked on rank 0.
    window : float
        H [s].
    limit : float
        Up to where the exchange is stable on fixed partners [-].
    """

    def __init__(
        self,
        interface: Interface,
        structure: Structure,
        *,
        spring: Callable[[float], tuple[float, float]],
        window: float,
        limit: float,
    ) -> None:
        self.limit = limit
        self._interface, self._structure = interface, structure
        self._spring, self._window = spring, window

    def now(self, particles: ParticleSystem | None, look: ContactLook | None) -> float:
        """r [-] at the present moment, 0 without contacts. Collective; rank 0's counts."""
        factor, operator = 0.0, None
        if particles is not None:
            operator, overlap = self._interface.closed(particles, look)
            if operator.shape[0]:
                k, c = self._spring(overlap)
                factor = self._window * (self._window * k + 2.0 * c)
        factor = self._structure.comm.bcast(factor, root=0)
        return factor * self._largest(operator) if factor else 0.0

    def _largest(self, operator: csr_matrix | None) -> float:
        """Largest eigenvalue [1/kg m] by Lanczos; without an operator, on other ranks, only the structure's part."""
        idle = np.zeros_like(self._structure.polyline.points)
        if operator is None:
            for _ in range(STEPS):
                self._structure.acceleration_by(idle)
            return 0.0
        back = operator.T.tocsr()
        last, now = np.zeros((operator.shape[0], 2)), np.random.default_rng(0).normal(size=(operator.shape[0], 2))
        now /= np.linalg.norm(now)
        diagonal, beside = np.zeros(STEPS), np.zeros(STEPS)
        for step in range(STEPS):
            ahead = operator @ self._structure.acceleration_by(back @ now) - (beside[step - 1] * last if step else 0.0)
            diagonal[step] = float(np.vdot(ahead, now))
            ahead -= diagonal[step] * now
            beside[step] = float(np.linalg.norm(ahead))
            last, now = now, ahead / max(beside[step], np.finfo(float).tiny)
        return float(eigh_tridiagonal(diagonal, beside[:-1], select="i", select_range=(STEPS - 1, STEPS - 1))[0][0])
