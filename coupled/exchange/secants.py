"""A quasi-Newton iteration for a fixed point, which remembers what it has seen of the map."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
KEPT = 8  # secants: of 8, 20 and 40 none was better
SMALLEST = 1e-8  # singular value, over the largest, of secants that still count


class Secants:
    """``x <- x + c - (dX + dC) g``, g the least squares of ``c - dC g``: the inverse of the map's slope by secants.

    c(x) is the correction that the iteration asks for at x, the columns of dX and dC are the changes of
    x and c between tries, those of earlier problems included. From one window to the next the slope
    hardly changes, so that most windows are solved by the first corrected guess.

    Source: the interface quasi-Newton method with an inverse Jacobian from least squares, IQN-ILS, of Degroote,
    Bathe and Vierendeels (2009), with reuse.

    Parameters
    ----------
    size : int
        Of x.
    noise : float
        Changes of c up to this are round-off and tell no slope.
    """

    def __init__(self, size: int, noise: float) -> None:
        self._noise = noise
        self._moved, self._changed = np.zeros((0, size)), np.zeros((0, size))
        self.begin()

    def begin(self) -> None:
        """Begin a new problem; the secants stay."""
        self._last: tuple[Floats, Floats] | None = None

    def step(self, place: Floats, correction: Floats) -> Floats:
        """What is to be added to `place` (size,), where the iteration asks for `correction` (size,)."""
        if self._last is not None and np.abs(correction - self._last[1]).max() > self._noise:
            self._moved = np.vstack([place - self._last[0], self._moved[: KEPT - 1]])
            self._changed = np.vstack([correction - self._last[1], self._changed[: KEPT - 1]])
        self._last = (place, correction)
        size = float(np.linalg.norm(self._changed))
        if size == 0.0:
            return correction
        weights = np.linalg.lstsq(self._changed.T, correction, rcond=max(SMALLEST, self._noise / size))[0]
        return correction - weights @ (self._moved + self._changed)

    def state(self) -> dict[str, Floats]:
        """The secants; nothing writes into these arrays."""
        return {"moved": self._moved, "changed": self._changed}

    def restore(self, saved: Mapping[str, Floats]) -> None:
        """Take up the secants of a `state`."""
        self._moved, self._changed = saved["moved"], saved["changed"]
        self.begin()
