"""A column against time: its value, its numbers over a window, the moment it reaches a value.

Between rows a column is linear.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from coupled.errors import QuantityError

Floats = NDArray[np.float64]
LATE = 0.5  # of the distance of two rows: a run ends at the whole step nearest to its duration, and rows are no closer


@dataclass(frozen=True, kw_only=True)
class Curve:
    """A column against time.

    Attributes
    ----------
    name : str
        Of the column.
    time, value : (n,)
        Ascending times [s], and the column at them.
    """

    name: str
    time: Floats
    value: Floats

    def at(self, time: float) -> float:
        """Value at a time [s].

        Raises
        ------
        QuantityError
            Outside the rows.
        """
        self._require_inside(time)
        return float(np.interp(time, self.time, self.value))

    def between(self, start: float, end: float | None) -> Curve:
        """The part of a window of times [s], its ends included; no end is that of the rows.

        Raises
        ------
        QuantityError
            If the window reaches outside the rows.
        """
        last = float(self.time[-1])
        end = last if end is None else end
        self._require_inside(start)
        self._require_inside(end)
        start, end = max(start, float(self.time[0])), min(end, last)
        if start >= end:
            raise QuantityError(f"the window from {start:g} s has no rows after it: the run ends at {last:g} s")
        inside = (self.time > start) & (self.time < end)
        time = np.concatenate([[start], self.time[inside], [end]])
        value = np.concatenate([[self.at(start)], self.value[inside], [self.at(end)]])
        return Curve(name=self.name, time=time, value=value)

    def first(self, over: float) -> Curve:
        """The part of a length [s] from the first row on."""
        return self.between(float(self.time[0]), float(self.time[0]) + over)

    def last(self, over: float) -> Curve:
        """The part of a length [s] up to the last row."""
        return self.between(float(self.time[-1]) - over, None)

    def require_length(self, least: float) -> None:
        """Demand that the rows are at least so long [s].

        Raises
        ------
        QuantityError
            If they are shorter.
        """
        first, last = float(self.time[0]), float(self.time[-1])
        if last - first < least - self._late:
            raise QuantityError(f"the window from {first:g} to {last:g} s is shorter than {least:g} s: run it longer")

    def mean(self) -> float:
        """Mean over time, by the trapezoidal rule."""
        return float(trapezoid(self.value, self.time) / (self.time[-1] - self.time[0]))

    def first_time_at(self, target: float) -> float:
        """The first time [s] at which the column is or passes `target`.

        Raises
        ------
        QuantityError
            If it never does.
        """
        beyond = self.value - target
        hit = np.flatnonzero((beyond[:-1] * beyond[1:] <= 0.0) | (beyond[:-1] == 0.0))
        if len(hit) == 0:
            low, high = float(self.value.min()), float(self.value.max())
            raise QuantityError(f"{self.name} never reaches {target:g}: it stays between {low:g} and {high:g}")
        k = int(hit[0])
        step = self.value[k + 1] - self.value[k]
        share = 0.0 if step == 0.0 else -beyond[k] / step
        return float(self.time[k] + share * (self.time[k + 1] - self.time[k]))

    @property
    def _late(self) -> float:
        """How far [s] a time may lie outside the rows."""
        return LATE * float(np.median(np.diff(self.time))) if len(self.time) > 1 else 0.0

    def _require_inside(self, time: float) -> None:
        first, last = float(self.time[0]), float(self.time[-1])
        if not first - self._late <= time <= last + self._late:
            raise QuantityError(f"t = {time:g} s is outside the run, whose rows go from {first:g} to {last:g} s")
