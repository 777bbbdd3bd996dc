"""The Pareto front: settings that no other one beats in both time and error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from coupled.study.judging.errors import Judged

MARGIN = 0.05  # of the time: what differs by less is as fast


def pareto(points: Sequence[tuple[float, float]]) -> list[int]:
    """Indices of the points that no other one beats or equals in both numbers, by rising first number.

    Of equal points the first one stays.
    """
    order = sorted(range(len(points)), key=lambda k: (points[k], k))
    front: list[int] = []
    best = math.inf
    for k in order:
        if points[k][1] < best:
            front.append(k)
            best = points[k][1]
    return front


def front_of(judged: Sequence[Judged]) -> list[Judged]:
    """Settings of one quantity on the front of wall time and known error, by rising time."""
    return [judged[k] for k in pareto([(item.ran.wall_seconds, item.known) for item in judged])]


def beaten_by(item: Judged, others: Sequence[Judged]) -> Judged | None:
    """The setting that beats another clearly: faster by more than a margin, its known error no larger."""
    faster = [
        other
        for other in others
        if other.known <= item.known and other.ran.wall_seconds < (1.0 - MARGIN) * item.ran.wall_seconds
    ]
    return min(faster, key=lambda other: (other.known, other.ran.wall_seconds), default=None)


@dataclass(frozen=True, kw_only=True)
class Price:
    """What a knob asks for accuracy, from its own settings on the front of its own.

    Parameters
    ----------
    knob : str
    coarse, fine : Judged
        Cheapest and most accurate setting of the knob that count.
    seconds_per_decade : float
        Wall time for one digit [s]; infinite if the knob buys none.
    """

    knob: str
    coarse: Judged
    fine: Judged
    seconds_per_decade: float


def price(knob: str, items: Sequence[Judged]) -> Price:
    """Price of a digit between the ends of a knob's own front; `items` are its settings and the base."""
    front = front_of(items)
    coarse, fine = front[0], front[-1]
    decades = math.log10(coarse.known / fine.known)
    seconds = fine.ran.wall_seconds - coarse.ran.wall_seconds
    return Price(
        knob=knob, coarse=coarse, fine=fine, seconds_per_decade=seconds / decades if decades > 0.0 else math.inf
    )
