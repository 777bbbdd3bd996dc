"""Anderson's acceleration of a fixed-point iteration, shared by the ranks."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Mixing:
    """``x <- x + c - sum_i g_i (dx_i + dc_i)``, g the least squares of ``c - sum_i g_i dc_i``.

    c(x) is the correction that the iteration asks for at x, dx_i and dc_i are the changes between the
    last tries. What a correction misses in a few directions is found after as many tries.

    Source: Anderson (1965); type II of Fang and Saad (2009).

    Parameters
    ----------
    depth : int
        Number of changes that are kept.
    totals : callable
        Sums an array over the ranks.
    """

    def __init__(self, depth: int, totals: Callable[[Floats], Floats]) -> None:
        self._depth, self._totals = depth, totals
        self.forget()

    def forget(self) -> None:
        """Begin a new iteration."""
        self._places: list[Floats] = []
        self._corrections: list[Floats] = []

    def step(self, place: Floats, correction: Floats) -> Floats:
        """What is to be added to `place`, where the iteration asks for `correction`; collective."""
        self._places.append(place.copy())
        self._corrections.append(correction.copy())
        if len(self._places) == 1:
            return correction
        del self._places[: -self._depth - 1], self._corrections[: -self._depth - 1]
        moved, changed = np.diff(self._places, axis=0), np.diff(self._corrections, axis=0)
        count = len(changed)
        products = self._totals(np.concatenate([(changed @ changed.T).ravel(), changed @ correction]))
        weights = np.linalg.lstsq(products[: count**2].reshape(count, count), products[count**2 :], rcond=1e-12)[0]
        return correction - weights @ (moved + changed)
