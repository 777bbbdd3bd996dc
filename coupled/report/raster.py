"""Discs painted into an image of pixels: a million of them in a second, where a drawing program takes a minute."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FINE = 2  # pixels painted per pixel shown, in each direction
STAMPED = 8.0  # radius in pixels up to which all discs are painted at once


class Canvas:
    """A white image of a part of the plane.

    Parameters
    ----------
    low, high : (2,) of float
        Its corners [m].
    width : int
        In pixels; the height follows.
    """

    def __init__(self, low: NDArray[np.float64], high: NDArray[np.float64], width: int) -> None:
        self.low = np.asarray(low, float)
        self.scale = FINE * width / float(high[0] - low[0])  # fine pixels per length
        rows = max(1, round(float(high[1] - low[1]) * self.scale / FINE))
        self._fine = np.full((FINE * rows, FINE * width, 3), 255, np.uint8)

    def clear(self) -> None:
        """Make it white again."""
        self._fine[:] = 255

    def discs(self, points: NDArray[np.float64], radius: NDArray[np.float64], colours: NDArray[np.uint8]) -> None:
        """Paint discs at points (n, 2) of radius (n,) [m] in colours (n, 3), later ones over earlier ones."""
        place, size = (points - self.low) * self.scale, radius * self.scale
        small = size <= STAMPED
        self._paint_small(place[small], size[small], colours[small])
        for (x, y), r, colour in zip(place[~small], size[~small], colours[~small], strict=True):
            self._paint_large(x, y, r, colour)

    def image(self) -> NDArray[np.uint8]:
        """(rows, columns, 3), the lowest row first; fine pixels averaged."""
        rows, columns, _ = self._fine.shape
        blocks = self._fine.reshape(rows // FINE, FINE, columns // FINE, FINE, 3)
        return blocks.mean(axis=(1, 3)).round().astype(np.uint8)

    def _paint_small(self, place: NDArray[np.float64], size: NDArray[np.float64], colours: NDArray[np.uint8]) -> None:
        """One pass over all discs per pixel of the largest one's square."""
        if not len(place):
            return
        rows, columns, _ = self._fine.shape
        first = np.floor(place - size[:, None]).astype(np.int64)
        reach, limit = int(np.ceil(2.0 * size.max())) + 1, size**2
        for i in range(reach):
            for j in range(reach):
                px, py = first[:, 0] + i, first[:, 1] + j
                own = (px + 0.5 - place[:, 0]) ** 2 + (py + 0.5 - place[:, 1]) ** 2 < limit
                own &= (px >= 0) & (px < columns) & (py >= 0) & (py < rows)
                self._fine[py[own], px[own]] = colours[own]

    def _paint_large(self, x: float, y: float, r: float, colour: NDArray[np.uint8]) -> None:
        rows, columns, _ = self._fine.shape
        left, right = max(int(x - r), 0), min(int(x + r) + 2, columns)
        low, high = max(int(y - r), 0), min(int(y + r) + 2, rows)
        if left >= right or low >= high:
            return
        across, up = np.arange(left, right) + 0.5 - x, np.arange(low, high) + 0.5 - y
        self._fine[low:high, left:right][across**2 + up[:, None] ** 2 < r * r] = colour
