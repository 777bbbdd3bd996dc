"""What the source says of its shaken boxes, held against our samples."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from shaken_cases import LONG_CASE, Ascent, paired

from coupled.campaign.statistics import confidence

STILL = 2.5  # the intruder's radius: a change of height below it is none
DEEP = 10.0  # about as far below the surface as the middle of the rolls, round which it is to go
WHOLE, LONGEST = 200.0, 1000.0  # periods
SLOWEST = 5.0 * WHOLE  # of a fall that is told
UP, NONE, DOWN, NOT_UP, MORE = (
    (STILL, math.inf),
    (-STILL, STILL),
    (-math.inf, -STILL),
    (-math.inf, STILL),
    (0.0, math.inf),
)
Found = Mapping[str, Mapping[str, list[Ascent]]]


@dataclass(frozen=True, kw_only=True)
class Statement:
    """One statement of the source, our numbers (n,), one of each sample, and where they must lie to agree."""

    case: str
    source: str
    what: str
    values: tuple[float, ...]
    allowed: tuple[float, float]

    @property
    def verdict(self) -> str:
        """By the 95 % interval of the mean; by the number itself where there is one sample."""
        found = confidence(self.values)
        low, high = (found.low, found.high) if found.count > 1 else (found.mean, found.mean)
        if self.allowed[0] < low and high < self.allowed[1]:
            return "yes"
        return "no" if high <= self.allowed[0] or low >= self.allowed[1] else "open"


def interval(values: Sequence[float]) -> str:
    """Mean, half width of the 95 % interval, samples."""
    found = confidence(values)
    return f"{found.mean:+.1f}" + (f" +- {found.half_width:.1f} ({found.count})" if found.count > 1 else " (1)")


def statements(found: Found) -> list[Statement]:
    """All of them for which there are samples."""
    every = [*_ways(found), *_sinkings(found), *_orders(found), *_ends(found)]
    return [statement for statement in every if statement.values]


def _ways(found: Found) -> Iterator[Statement]:
    """Who rises and who sinks, from the first ten periods to the last ten."""
    said = {
        "walls": ("rises for Gamma above about 1", NONE, UP),
        "smooth_walls": ("nothing below Gamma = 1", NONE, None),
        "no_friction": ("sinks at any Gamma", DOWN, DOWN),
        "periodic_25000": ("no rise", NOT_UP, NOT_UP),
        "periodic_30000": ("rises for Gamma > 1", NONE, UP),
    }
    for case, (source, below, above) in said.items():
        for gamma, ascents in found.get(case, {}).items():
            allowed = below if float(gamma) < 1.0 else above
            if allowed is not None:
                values = tuple(ascent.climbed(WHOLE) for ascent in ascents)
                yield Statement(
                    case=case,
                    source=source,
                    what=f"rise in 200 periods, Gamma = {gamma}",
                    values=values,
                    allowed=allowed,
                )


def _sinkings(found: Found) -> Iterator[Statement]:
    """The source does not say for how long it shook without friction."""
    for gamma, ascents in found.get(LONG_CASE, {}).items():
        yield Statement(
            case=LONG_CASE,
            source="sinks at any Gamma",
            what=f"rise in 1000 periods, Gamma = {gamma}",
            values=tuple(ascent.climbed(LONGEST) for ascent in ascents),
            allowed=DOWN,
        )


def _orders(found: Found) -> Iterator[Statement]:
    """Differences between samples of one seed, of the mean height until the first of the two is at the top."""
    said = (
        ("walls_light", "walls", "light ones faster than equal ones"),
        ("walls", "walls_heavy", "equal ones faster than heavy ones"),
        ("walls", "smooth_walls", "slower with smooth walls"),
    )
    for fast, slow, source in said:
        for gamma in found.get(fast, {}):
            if float(gamma) > 1.0:
                pairs = paired(found[fast][gamma], found.get(slow, {}).get(gamma, []))
                values = tuple(a.mean_rise(until) - b.mean_rise(until) for a, b, until in map(_race, pairs))
                what = f"mean height on the way over that of {slow.replace('_', ' ')}, Gamma = {gamma}"
                yield Statement(case=fast, source=source, what=what, values=values, allowed=MORE)


def _race(pair: tuple[Ascent, Ascent]) -> tuple[Ascent, Ascent, float]:
    """A pair, and the period at which the first of the two comes to the top, or the end."""
    tops = [top for ascent in pair if (top := at_top(ascent)) is not None]
    return *pair, min([*tops, WHOLE])


def _ends(found: Found) -> Iterator[Statement]:
    """What those that have come to the top do there."""
    for case, source, allowed in (
        ("walls", "then circulates with the rolls", (DEEP, math.inf)),
        ("periodic_30000", "stays at the top", (-math.inf, 2.0 * STILL)),
    ):
        for gamma, ascents in found.get(case, {}).items():
            values = tuple(fall_from_top(ascent) for ascent in ascents if at_top(ascent) is not None)
            what = f"comes down again from the top, Gamma = {gamma}"
            yield Statement(case=case, source=source, what=what, values=values, allowed=allowed)


def at_top(ascent: Ascent) -> float | None:
    """The first period near which the intruder's upper edge is within its radius of the surface of the bed at rest."""
    there = np.nonzero(ascent.height + STILL > ascent.surface - STILL)[0]
    return float(ascent.periods[there[0]]) if len(there) else None


def fall_from_top(ascent: Ascent) -> float:
    """How far it comes down from its highest place."""
    highest = int(np.argmax(ascent.height))
    return float(ascent.height[highest] - ascent.height[highest:].min())


def risen_by_ten(ascent: Ascent) -> float | None:
    """Periods until it is ten diameters above the mean of the first ten periods."""
    there = np.nonzero(ascent.height > ascent.near(10.0) + 10.0)[0]
    return float(ascent.periods[there[0]]) if len(there) else None


def fall_time(ascent: Ascent) -> float | None:
    """Periods in which the height over the place at the bottom falls to 1/e, by a line through its logarithm.

    None if it hardly falls.
    """
    above = ascent.height - STILL
    falling = np.logical_and.accumulate(above > 1.0)
    if falling.sum() < 5:
        return None
    slope = np.polynomial.polynomial.polyfit(ascent.periods[falling], np.log(above[falling]), 1)[1]
    return float(-1.0 / slope) if slope < -1.0 / SLOWEST else None
