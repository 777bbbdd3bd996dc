"""Uniform cells over a part of the plane, periodic sides included."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from particles.errors import ParticleError, require
from particles.periodic import Period, folded
from particles.state import Floats


@dataclass(frozen=True, kw_only=True)
class Cells:
    """Rows and columns of equal cells; flat numbers run along the rows, lowest row first.

    Parameters
    ----------
    left, bottom : float
        Lower left corner [m].
    width, height : float
        Of all cells together [m].
    columns, rows : int
    period : (2,) of float or None
        After which x and y repeat [m]. Cells that span a whole period hold every grain, wherever its image lies.

    Raises
    ------
    ParticleError
        If a number is not finite, an extent is not positive, or there is no cell.
    """

    left: float = 0.0
    bottom: float = 0.0
    width: float
    height: float
    columns: int
    rows: int
    period: Period = (None, None)

    def __post_init__(self) -> None:
        for name in ("left", "bottom"):
            require(f"{name} of the cells", getattr(self, name))
        for name in ("width", "height"):
            require(f"{name} of the cells", getattr(self, name), above=0.0)
        for name in ("columns", "rows"):
            require(f"{name} of the cells", getattr(self, name), at_least=1)
        for extent, length in zip((self.width, self.height), self.period, strict=True):
            if length is not None and extent > length * (1.0 + 1e-12):
                raise ParticleError(f"cells over {extent:g} m would hold a grain twice: the period is {length:g} m")

    @property
    def count(self) -> int:
        return self.columns * self.rows

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of one cell [m]."""
        return self.width / self.columns, self.height / self.rows

    @property
    def x(self) -> Floats:
        """Middles of the columns (columns,) [m]."""
        return self.left + self.size[0] * (np.arange(self.columns) + 0.5)

    @property
    def y(self) -> Floats:
        """Middles of the rows (rows,) [m]."""
        return self.bottom + self.size[1] * (np.arange(self.rows) + 0.5)

    def local(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Coordinates [m] from the lower left corner, folded where a side is periodic."""
        return folded(x - self.left, self.period[0]), folded(y - self.bottom, self.period[1])

    def number(self, x: Floats, y: Floats) -> np.ndarray:
        """Flat number (n,) of the cell that holds each point; -1 outside."""
        across, up = self.local(x, y)
        column, row = (
            np.floor(place / size).astype(np.int64) for place, size in zip((across, up), self.size, strict=True)
        )
        inside = (column >= 0) & (column < self.columns) & (row >= 0) & (row < self.rows)
        return np.where(inside, row * self.columns + column, -1)

    def shaped(self, values: Floats) -> Floats:
        """Flat values (count, ...) as (rows, columns, ...)."""
        return values.reshape(self.rows, self.columns, *values.shape[1:])

    def images(self, x: Floats, y: Floats, radius: Floats) -> Iterator[tuple[Floats, Floats, np.ndarray]]:
        """Local places [m] of all discs that reach into the cells, images across periodic sides included.

        Yields places across and up, and the number of the disc that each of them is, one shift at a time.
        """
        across, up = self.local(x, y)
        shifts = [(0.0,) if length is None else (-length, 0.0, length) for length in self.period]
        for shift_x in shifts[0]:
            for shift_y in shifts[1]:
                a, b = across + shift_x, up + shift_y
                reaches = (a > -radius) & (a < self.width + radius) & (b > -radius) & (b < self.height + radius)
                which = np.nonzero(reaches)[0]
                yield a[which], b[which], which
