"""How strong a load is at a time: a factor that multiplies what the load says."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from structure import checks
from structure.errors import StructureError


class Schedule(Protocol):
    """A factor against time.

    Attributes
    ----------
    constant_from : float
        Time [s] from which the factor no longer changes; infinite if it always does.
    largest : float
        Largest magnitude of the factor.
    """

    @property
    def constant_from(self) -> float: ...

    @property
    def largest(self) -> float: ...

    def factor(self, time: float) -> float:
        """Factor [-] at `time` [s], of at least 0."""


@dataclass(frozen=True, kw_only=True)
class Constant:
    """Full strength from the start: 1."""

    constant_from = 0.0
    largest = 1.0

    def factor(self, time: float) -> float:
        """1 at all times."""
        return 1.0


@dataclass(frozen=True, kw_only=True)
class Ramp:
    """From 0 at t = 0 linearly to 1 at t = `over` [s], then held."""

    over: float
    largest = 1.0

    def __post_init__(self) -> None:
        checks.positive("over", self.over, "s; for full strength from the start use Constant()")

    @property
    def constant_from(self) -> float:
        """Time [s] at which full strength is reached."""
        return self.over

    def factor(self, time: float) -> float:
        """``min(t/over, 1)`` at `time` [s]."""
        return 1.0 if time >= self.over else time / self.over


@dataclass(frozen=True, kw_only=True)
class Sine:
    """``offset + sin(2 pi frequency t + phase)``.

    frequency [Hz], phase [rad], offset [-].
    """

    frequency: float
    phase: float = 0.0
    offset: float = 0.0
    constant_from = math.inf

    def __post_init__(self) -> None:
        checks.positive("frequency", self.frequency, "Hz")
        checks.finite("phase", self.phase, "rad")
        checks.finite("offset", self.offset, "-")

    @property
    def largest(self) -> float:
        """``1 + |offset|``."""
        return 1.0 + abs(self.offset)

    def factor(self, time: float) -> float:
        """The sine at `time` [s]."""
        return self.offset + math.sin(2 * math.pi * self.frequency * time + self.phase)


@dataclass(frozen=True, kw_only=True)
class Table:
    """Linear between rows (time, factor), held before the first and after the last.

    times : (k,) [s], ascending; factors : (k,) [-]; k of at least 2.
    """

    times: tuple[float, ...]
    factors: tuple[float, ...]

    def __post_init__(self) -> None:
        times, factors = (np.asarray(column, dtype=float) for column in (self.times, self.factors))
        if times.ndim != 1 or times.shape != factors.shape or len(times) < 2:
            raise StructureError(
                f"times of shape {times.shape} and factors of shape {factors.shape} must be equally many, at least 2"
            )
        if not np.all(np.isfinite(times)) or not np.all(np.isfinite(factors)):
            raise StructureError("times and factors must be finite: mend or leave out the rows that are not")
        late = np.flatnonzero(np.diff(times) <= 0)
        if len(late):
            first, second = times[late[0] : late[0] + 2].tolist()
            raise StructureError(f"times has {second!r} s after {first!r} s: each must be later than the one before")
        object.__setattr__(self, "times", tuple(times.tolist()))
        object.__setattr__(self, "factors", tuple(factors.tolist()))

    @property
    def constant_from(self) -> float:
        """Time [s] of the last row."""
        return self.times[-1]

    @property
    def largest(self) -> float:
        """Largest magnitude of the rows."""
        return max(abs(factor) for factor in self.factors)

    def factor(self, time: float) -> float:
        """Linear interpolation at `time` [s]."""
        return float(np.interp(time, self.times, self.factors))
