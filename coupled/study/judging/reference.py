"""What the settings of a study are measured against, and how well that is known itself."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

EXACT = "closed form"
REFINEMENT = 2.0  # of all continuous knobs together from one level to the next
LOWEST_ORDER, HIGHEST_ORDER = 0.5, 4.0  # taken for the order of what is left; see `own_error`


@dataclass(frozen=True, kw_only=True)
class Reference:
    """The value that counts as right for one quantity.

    Parameters
    ----------
    samples : tuple
        Its value, one per seed; a closed form has one.
    error : float
        Estimate of how far it is off itself, in the quantity's unit; nan if there is nothing to tell it from.
    source : str
        Where it comes from.
    order : float, optional
        Observed order of the levels, if it was seen.
    open : bool
        Whether chance hides what the level before it differs by: its error counts as none then, and its scatter
        is in the intervals of the differences from it.
    scale : float
        What errors are divided by, in the quantity's unit.
    """

    samples: tuple[float, ...]
    error: float
    source: str
    order: float | None = None
    open: bool = False
    scale: float

    @property
    def mean(self) -> float:
        """Mean over the seeds."""
        return sum(self.samples) / len(self.samples)

    @property
    def relative_error(self) -> float:
        """Its own error over the scale [-]; 0 where it is not known."""
        return 0.0 if math.isnan(self.error) else self.error / self.scale


def own_error(levels: Sequence[float]) -> tuple[float, float | None]:
    """Estimate the error of the last of some values, each of a level twice as fine as the one before.

    With ``d1``, ``d2`` the last two differences the order is ``p = log2(|d1/d2|)`` and what is left is the geometric
    series ``|d2|/(2^p - 1)`` (Roache 1994). An order outside 0.5 to 4 is not believed: differences that grow are taken
    as they are, luckily small ones not as a high order. Two levels are taken as if they were of order 1.

    Returns
    -------
    The error (nan for one level) and the order (None where two differences are missing or grow).
    """
    if len(levels) < 2:
        return math.nan, None
    last = abs(levels[-1] - levels[-2])
    if len(levels) == 2:
        return last, None
    before = abs(levels[-2] - levels[-3])
    if last == 0.0:
        return 0.0, None
    if last >= before:
        return last, None
    order = math.log(before / last, REFINEMENT)
    believed = min(max(order, LOWEST_ORDER), HIGHEST_ORDER)
    return last / (REFINEMENT**believed - 1.0), order


def scale_of(reference: float, others: Sequence[float]) -> float:
    """What errors of a quantity are divided by.

    That is the reference's magnitude; where it is next to nothing beside the values of the settings, their largest.
    """
    largest = max((abs(value) for value in others if math.isfinite(value)), default=0.0)
    if abs(reference) > 1e-6 * largest:
        return abs(reference)
    return largest or 1.0
