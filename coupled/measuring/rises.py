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
    WindowMoments,
    checked_sequences,
    cumulants,
    extrapolated,
    limit_of_slope,
    quietest_phase,
    rate_function,
    strobe,
    symmetry,
    usual_edges,
    window_moments,
)

ENOUGH_BLOCKS = 20  # for the longest windows, where the record allows; of as many samples whole ones are drawn
PHASES = 10  # among which the quietest is sought
TILTS = 25


@dataclass(frozen=True, kw_only=True)
class Periods:
    """Which periods of the shaking count, from 0 on; `last` None: to the end of the shaking or of the record.

    Heights are read at the `phase` of each, 0 to below 1; None: at that of `PHASES` at which single rises spread least.
    """

    first: int = 0
    last: int | None = None
    phase: float | None = 0.0

    def end(self, record: Record, phase: float = 0.0) -> int | None:
        """The last period of a shaken record that counts, seen at a phase; None: the last one there is."""
        shaken = record.shaken.periods
        return self.last if self.last is not None or shaken is None else math.floor(shaken - phase)


@dataclass(frozen=True, kw_only=True)
class LargeDeviations:
    """What the windows of the rises say; `lacks` is a sentence where they say nothing.

    `whole` tells whether error bars come from whole samples drawn again or from blocks within them.
    """

    lengths: tuple[int, ...] = ()
    whole: bool = False
    moments: tuple[WindowMoments, ...] = ()
    curves: tuple[RateFunction, ...] = ()
    limit: Extrapolated | None = None
    tilted: dict[int, Cumulants] = field(default_factory=dict)
    settled: int | None = None
    symmetries: tuple[Symmetry, ...] = ()
    slope: tuple[float, float] | None = None
    lacks: str = ""

    @property
    def slopes(self) -> list[tuple[str, str]]:
        """The slope of the symmetry in words: of the longest windows with a left tail, and of the line to endless ones.

        Where the line leaves the bar of those windows, the slope has not settled.
        """
        seen = [each for each in self.symmetries if each.slope is not None]
        if not seen:
            return []
        last = seen[-1]
        told = [(f"windows of {last.periods}", f"{last.slope:.4g} +- {last.half_width:.2g}")]
        if self.slope is not None:
            slope, half = self.slope
            settled = abs(slope - last.slope) <= last.half_width
            told.append(("by a line over 1/n", f"{slope:.4g} +- {half:.2g}{'' if settled else ', not settled'}"))
        return told


@dataclass(frozen=True, kw_only=True)
class Rise:
    """One intruder in all samples of a group.

    Attributes
    ----------
    name : str
        Of its columns in the history.
    phase : float
        Of the period, at which heights are read.
    samples : tuple of Strobe
        Height over the moving floor at that phase of each period [m].
    time, mean, half_width : (k,)
        Of the heights over the samples, with the 95 % interval.
    count : (k,)
        Samples that have reached the period.
    rate : Interval
        Mean rise per period of each sample [m], over the samples.
    deviations : LargeDeviations
    """

    name: str
    phase: float
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
    return np.asarray(columns[f"{name}_y"] - record.box_moved(columns["time"])[:, 1])


def speed_over_floor(record: Record, name: str) -> Floats:
    """Rate at which that height grows [m/s] in the half step after each row, whose velocity the history has."""
    columns, step = record.history, float(record.scene["time"]["step"])
    floor = [record.box_moved(time)[:, 1] for time in (columns["time"], columns["time"] + step)]
    return np.asarray(columns[f"{name}_vy"] - (floor[1] - floor[0]) / step)


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
    phase = periods.phase
    if phase is None:
        phases = [k / PHASES for k in range(PHASES)]
        looks = [[_looks(record, name, periods, at).rise for record in group.records] for at in phases]
        phase = phases[quietest_phase(looks)]
    samples = [_looks(record, name, periods, phase) for record in group.records]
    longest = max(len(seen.time) for seen in samples)
    heights = [np.append(seen.value, np.full(longest - len(seen.value), np.nan)) for seen in samples]
    mean, half, count = intervals(heights)
    time = max((seen.time for seen in samples), key=len)
    return Rise(
        name=name, phase=phase, samples=tuple(samples), time=time, mean=mean, half_width=half, count=count,
        rate=confidence([float(seen.rise.mean()) for seen in samples]),
        deviations=large_deviations([seen.rise for seen in samples]),
    )  # fmt: skip


def _looks(record: Record, name: str, periods: Periods, phase: float) -> Strobe:
    """Heights of one intruder at a phase of the periods that count."""
    shaken, time = record.shaken, record.history["time"]
    seen = strobe(time, height_over_floor(record, name), period=shaken.period, start=shaken.start, phase=phase)
    end = periods.end(record, phase)
    last = None if end is None else end + 1
    kept = Strobe(seen.time[periods.first : last], seen.value[periods.first : last], seen.rise[periods.first : end])
    if not len(kept.rise):
        raise ParticleError(
            f"{record.folder} holds {len(seen.rise)} periods, none of them from {periods.first} to "
            f"{'the end' if end is None else end}: choose others"
        )
    return kept


def large_deviations(rises: list[Floats]) -> LargeDeviations:
    """Windows of 1, 2, 4 ... periods, as long as the records allow, and their limits.

    From `ENOUGH_BLOCKS` samples on error bars come from whole samples drawn again: windows of one are not independent.
    """
    try:
        sequences = checked_sequences(rises)
        whole = len(sequences) >= ENOUGH_BLOCKS
        lengths = window_lengths(sequences, whole=whole)
        sampling = Resampling(sequences=sequences, longest=lengths[-1], whole=whole)
        edges = usual_edges(sampling)
        moments = tuple(window_moments(sampling, n) for n in lengths)
        curves = _curves(sampling, lengths, edges)
        limit = extrapolated(sampling, curves)
    except ParticleError as error:
        return LargeDeviations(lacks=str(error))
    tilted = {n: cumulants(sampling, n, _tilts(sampling, n)) for n in lengths}
    symmetries = tuple(symmetry(sampling, n) for n in lengths)
    return LargeDeviations(
        lengths=lengths, whole=whole, moments=moments, curves=curves, limit=limit, tilted=tilted,
        settled=_settled(tilted), symmetries=symmetries, slope=limit_of_slope(sampling, symmetries),
    )  # fmt: skip


def _curves(sampling: Resampling, lengths: tuple[int, ...], edges: Floats) -> tuple[RateFunction, ...]:
    """Histograms of the lengths at which windows lie about the mean: single periods of a bed that swings may have none.

    Raises
    ------
    ParticleError
        If there is no such length.
    """
    curves = []
    for n in lengths:
        try:
            curves.append(rate_function(sampling, n, edges))
        except ParticleError:
            if n == lengths[-1] and not curves:
                raise
    return tuple(curves)


def window_lengths(sequences: tuple[Floats, ...], *, whole: bool = False) -> tuple[int, ...]:
    """Powers of two up to the longest that leaves `ENOUGH_BLOCKS` blocks; at least 1, 2 and 4 where ten are left.

    Of samples drawn `whole`, up to the longest of which as many samples hold two side by side.

    Raises
    ------
    ParticleError
        If the records are too short for error bars even of single periods.
    """
    lengths = [1]
    while True:
        try:
            blocks = Resampling(sequences=sequences, longest=2 * lengths[-1], whole=whole).blocks
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
