"""Means of few random numbers, and how sure they are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from coupled.errors import LeitoError


@dataclass(frozen=True, kw_only=True)
class Interval:
    """A mean of `count` values and half the width of its confidence interval, infinite for a single value."""

    mean: float
    half_width: float
    count: int

    @property
    def low(self) -> float:
        """Lower end."""
        return self.mean - self.half_width

    @property
    def high(self) -> float:
        """Upper end."""
        return self.mean + self.half_width


def confidence(values: Sequence[float], level: float = 0.95) -> Interval:
    """The interval that holds the true mean in a share `level` of all cases, by Student's t.

    ``mean +- t s / sqrt(n)``, s the standard deviation with n - 1 and t the quantile ``(1 + level)/2`` of
    Student's distribution with n - 1 degrees of freedom. Exact for independent values of one normal distribution;
    for others it becomes right as n grows.

    Parameters
    ----------
    values : sequence of float
        Independent, e.g. one of each seed.
    level : float
        Between 0 and 1.

    Raises
    ------
    LeitoError
        Without values, with one that is not finite, or another level.
    """
    sample = np.asarray(values, dtype=float)
    if sample.size == 0 or not np.isfinite(sample).all():
        raise LeitoError(f"a mean needs at least one value and finite ones, not {list(map(float, sample))}")
    if not 0.0 < level < 1.0:
        raise LeitoError(f"level = {level:g} must lie between 0 and 1: 0.95 is usual")
    count, mean = sample.size, float(sample.mean())
    if count == 1:
        return Interval(mean=mean, half_width=math.inf, count=1)
    quantile = float(stdtrit(count - 1, 0.5 * (1.0 + level)))
    return Interval(mean=mean, half_width=quantile * float(sample.std(ddof=1)) / math.sqrt(count), count=count)
