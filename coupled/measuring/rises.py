"""The intruder's height once a period, its rise, and the large-deviation function of the latter."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from coupled.campaign.statistics import Interval, confidence
from coupled.measuring.record import Floats, Record
from coupled.measuring.samples import Group, intervals
from particles import ParticleError
from particles.measures import (
    Cumulants,
    Extrapolated,
    RateFunction,
    Resampling,
    Strobe,
    Symmetry,
    checked_sequences,
    cumulants,
    extrapolated,
    limit_of_slope,
    rate_function,
    strobe,
    symmetry,
    usual_edges,
)

ENOUGH_BLOCKS = 20  # for the longest windows, where the record allows
TILTS = 25


@dataclass(frozen=True, kw_only=True)
class Periods:
    """Which periods of the shaking count, from 0 on; `last` None: to the end of the record."""

    first: int = 0
    last: int | None = None


@dataclass(frozen=True, kw_only=True)
class LargeDeviations:
    """What the windows of the rises say; `lacks` is a sentence where they say nothing."""

    lengths: tuple[int, ...] = ()
    curves: tuple[RateFunction, ...] = ()
    limit: Extrapolated | None = None
    tilted: dict[int, Cumulants] = field(default_factory=dict)
    settled: int | None = None
    symmetries: tuple[Symmetry, ...] = ()
    slope: tuple[float, float] | None = None
    lacks: str = ""


@dataclass(frozen=True, kw_only=True)
class Rise:
    """One intruder in all samples of a group.

    Attributes
    ----------
    name : str
        Of its columns in the history.
    samples : tuple of Strobe
        Height over the moving floor at phase 0 of each period [m].
    time, mean, half_width : (k,)
        Of the heights over the samples, with the 95 % interval.
    count : (k,)
        Samples that have reached the period.
    rate : Interval
        Mean rise per period of each sample [m], over the samples.
    deviations : LargeDeviations
    """

    name: str
    samples: tuple[Strobe, ...]
    time: Floats
    mean: Floats
    half_width: Floats
    count: np.ndarray
    rate: Interval
    deviations: LargeDeviations


def height_over_floor(record: Record, name: str) -> Floats:
    """Height of an intruder over the floor at each row of the history [m]."""
    columns = record.history
    return np.asarray(columns[f"{name}_y"] - columns.get("floor_y", 0.0))


def intruder_names(record: Record) -> list[str]:
    """Intruders that the history follows."""
    names = ["intruder" if k == 0 else f"intruder_{k + 1}" for k in range(record.intruders)]
    return [name for name in names if f"{name}_y" in record.history]


def rise_of(group: Group, name: str, periods: Periods) -> Rise:
    """Heights and rises of one intruder.

    Raises
    ------
    ParticleError
        If a record holds less than one period of the shaking.
    """
    samples = []
    for record in group.records:
        shaken = record.shaken
        seen = strobe(record.history["time"], height_over_floor(record, name), period=shaken.period, start=shaken.start)
        last = None if periods.last is None else periods.last + 1
        samples.append(Strobe(seen.time[periods.first : last], seen.value[periods.first : last],
                              seen.rise[periods.first : periods.last]))  # fmt: skip
        if not len(samples[-1].rise):
            raise ParticleError(
                f"{record.folder} holds {len(seen.rise)} periods, none of them from {periods.first} to "
                f"{'the end' if periods.last is None else periods.last}: choose others"
            )
    longest = max(len(seen.time) for seen in samples)
    heights = [np.append(seen.value, np.full(longest - len(seen.value), np.nan)) for seen in samples]
    mean, half, count = intervals(heights)
    time = max((seen.time for seen in samples), key=len)
    return Rise(
        name=name, samples=tuple(samples), time=time, mean=mean, half_width=half, count=count,
        rate=confidence([float(seen.rise.mean()) for seen in samples]),
        deviations=large_deviations([seen.rise for seen in samples]),
    )  # fmt: skip


def large_deviations(rises: list[Floats]) -> LargeDeviations:
    """Windows of 1, 2, 4 ... periods, as long as the records allow, and their limits."""
    try:
        sequences = checked_sequences(rises)
        lengths = window_lengths(sequences)
        sampling = Resampling(sequences=sequences, longest=lengths[-1])
        edges = usual_edges(sampling)
        curves = tuple(rate_function(sampling, n, edges) for n in lengths)
        limit = extrapolated(sampling, curves)
    except ParticleError as error:
        return LargeDeviations(lacks=str(error))
    tilted = {n: cumulants(sampling, n, _tilts(sampling, n)) for n in lengths}
    symmetries = tuple(symmetry(sampling, n) for n in lengths)
    return LargeDeviations(
        lengths=lengths, curves=curves, limit=limit, tilted=tilted, settled=_settled(tilted),
        symmetries=symmetries, slope=limit_of_slope(sampling, symmetries),
    )  # fmt: skip


def window_lengths(sequences: tuple[Floats, ...]) -> tuple[int, ...]:
    """Powers of two up to the longest that leaves `ENOUGH_BLOCKS` blocks; at least 1, 2 and 4 where ten are left.

    Raises
    ------
    ParticleError
        If the records are too short for error bars even of single periods.
    """
    lengths = [1]
    while True:
        try:
            blocks = Resampling(sequences=sequences, longest=2 * lengths[-1]).blocks
        except ParticleError:
            break
        if blocks < ENOUGH_BLOCKS and len(lengths) > 2:
            break
        lengths.append(2 * lengths[-1])
    return tuple(lengths)


def _tilts(sampling: Resampling, periods: int) -> Floats:
    """k [1/m] as far as Gaussian sums of these windows would allow."""
    sums = np.concatenate(sampling.sums(periods))
    reach = math.sqrt(max(math.log(len(sums) / (40.0 * periods)), 0.25)) if len(sums) > 40 * periods else 0.5
    return np.asarray(reach / float(sums.std()) * np.linspace(-1.2, 1.2, TILTS))


def _settled(tilted: dict[int, Cumulants]) -> int | None:
    """The shortest windows whose function agrees with that of windows twice as long, within the error bars."""
    lengths = sorted(tilted)
    for n, double in zip(lengths, lengths[1:], strict=False):
        short, long = tilted[n], tilted[double]
        known, there = np.isfinite(short.value), np.isfinite(long.value)
        if known.sum() < 2 or there.sum() < 2:
            continue
        within = (long.k[there] >= short.k[known].min()) & (long.k[there] <= short.k[known].max())
        at = long.k[there][within]
        gap = np.abs(np.interp(at, short.k[known], short.value[known]) - long.value[there][within])
        if np.all(gap <= long.half_width[there][within] + 1e-12):
            return n
    return None
