"""Errors of the settings against the reference, with what chaos leaves open."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from coupled.campaign.statistics import Interval, confidence
from coupled.study.judging.reference import Reference
from coupled.study.settings.setting import Ran, Setting

Verdict = Literal["resolved", "not resolved", "below the reference's own error", "one sample", "reference"]


@dataclass(frozen=True, kw_only=True)
class Judged:
    """One quantity of one setting.

    Parameters
    ----------
    ran : Ran
    quantity : str
    value, half_width : float
        Mean over the seeds and its confidence interval, in the quantity's unit.
    error : float
        Mean difference from the reference over the scale, with its sign [-].
    error_half_width : float
        Its confidence interval [-]; 0 for a scene without chance.
    floor : float
        The reference's own error over the scale [-].
    verdict : str
    """

    ran: Ran
    quantity: str
    value: float
    half_width: float
    error: float
    error_half_width: float
    floor: float
    verdict: Verdict

    @property
    def setting(self) -> Setting:
        return self.ran.setting

    @property
    def known(self) -> float:
        """The smallest error that can be claimed: luck within the interval counts for nothing [-]."""
        return max(abs(self.error), self.error_half_width, self.floor, sys.float_info.epsilon)


def judge(ran: Ran, quantity: str, reference: Reference, *, chance: bool) -> Judged:
    """Compare a setting that is done with the reference.

    Grain trajectories are chaotic, so that a difference in one run means nothing. Settings share their seeds, and with
    them their packings: the differences seed by seed are independent of each other whatever setting and reference
    have in common, and Student's interval of their mean says whether it is resolved.

    Parameters
    ----------
    chance : bool
        Whether samples differ by chance; if not, one sample is the value itself.
    """
    values = ran.values[quantity]
    against = reference.samples * len(values) if len(reference.samples) == 1 else reference.samples
    own = _interval(values)
    difference = _interval([value - right for value, right in zip(values, against, strict=False)])
    error, half_width = difference.mean / reference.scale, difference.half_width / reference.scale
    floor = reference.relative_error
    is_reference = ran.setting.name == reference.source
    verdict = "reference" if is_reference else _verdict(abs(error), half_width, floor, chance and len(values) < 2)
    return Judged(
        ran=ran, quantity=quantity, value=own.mean, half_width=own.half_width, error=error,
        error_half_width=half_width, floor=floor, verdict=verdict,
    )  # fmt: skip


def _interval(values: Sequence[float]) -> Interval:
    if len(values) == 1:
        return Interval(mean=values[0], half_width=0.0, count=1)
    return confidence(values)


def _verdict(error: float, half_width: float, floor: float, lonely: bool) -> Verdict:
    if lonely:
        return "one sample"
    if error <= half_width and half_width > 0.0:
        return "not resolved"
    if error <= floor and floor > 0.0:
        return "below the reference's own error"
    return "resolved"


def observed_order(values: Sequence[tuple[float, float]]) -> float | None:
    """Order of a quantity in a knob, from settings where nothing else is turned.

    With the three finest values of the knob in a constant ratio q it is ``p = log|d1/d2|/log q``. The error that other
    knobs leave drops out of the differences.

    Parameters
    ----------
    values : sequence
        Pairs of the knob's value (small is fine) and the quantity.

    Returns
    -------
    None if there are no such three, or the differences do not fall.
    """
    finest = sorted(values)[:3]
    if len(finest) < 3 or finest[0][0] <= 0.0:
        return None
    (fine, a), (middle, b), (coarse, c) = finest
    near, far = abs(b - a), abs(c - b)
    if not math.isclose(middle / fine, coarse / middle, rel_tol=1e-3) or near == 0.0 or far <= near:
        return None
    return math.log(far / near) / math.log(middle / fine)
