"""Profiles over the height, and convection in cells, from the frames of a group of runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from coupled.campaign.statistics import Interval, confidence
from coupled.measuring.record import FREE, Floats, Frame, Record
from coupled.measuring.rises import Periods
from coupled.measuring.samples import Group, intervals
from coupled.output.frames import read_frame
from particles import ParticleError
from particles.measures import (
    Cells,
    Convection,
    MovingGrains,
    convection,
    coordination_in_strips,
    fraction_in_strips,
    granular_temperature,
)

STRIP, TEMPERATURE_CELL, CONVECTION_CELL = 1.0, 4.0, 2.5  # mean diameters
FEWEST_COLUMNS = 4  # two of them are the middle
LOOKED_AT = 10  # frames for the extent of the bed
SAME_PHASE = 0.01  # of a period, within which frames are of one phase
PROFILES = ("packing", "coordination", "temperature", "spin_temperature")


@dataclass(frozen=True, kw_only=True)
class Profiles:
    """Over the heights y (k,) of strips above the floor [m]: means and half widths (k,) by the names of `PROFILES`.

    Packing and coordination [-], of free grains alone: a structure leaves a hole. Temperatures over the mass of a mean
    grain [m2/s2].
    """

    y: Floats
    mean: dict[str, Floats]
    half_width: dict[str, Floats]
    frames: int


@dataclass(frozen=True, kw_only=True)
class Rolls:
    """Convection in cells, displacements per period, over all samples; the roll of each sample as an interval [m]."""

    cells: Cells
    field: Convection
    roll: Interval


def _own(record: Record, arrays: dict[str, np.ndarray]) -> np.ndarray:
    """Free grains that are no intruders."""
    own = arrays["body"] == FREE
    own[record.intruder_places(arrays["body"])] = False
    return own


def _in_box(record: Record, time: float, arrays: dict[str, np.ndarray]) -> Floats:
    """Places of the grains (n, 2) [m] as the shaken box sees them."""
    return np.asarray(arrays["points"] - record.box_moved(time), float)


def _counted(record: Record, periods: Periods) -> np.ndarray:
    """Numbers of the frames within the periods that count; of a run that is not shaken, of the last frame."""
    times, shaken = record.frame_times("grains"), record.shaken
    if shaken is None:
        return np.arange(len(times))[-1:]
    period = (times - shaken.start) / shaken.period
    last = periods.end(record)
    last = np.inf if last is None else last
    return np.nonzero((period > periods.first - SAME_PHASE) & (period < last + SAME_PHASE))[0]


def frames_of(record: Record, periods: Periods) -> Iterator[Frame]:
    """The frames that count, one at a time."""
    return _read(record, _counted(record, periods))


def _read(record: Record, numbers: np.ndarray) -> Iterator[Frame]:
    paths = record.frame_paths("grains")
    return (read_frame(paths[number]) for number in numbers)


def _of_one_phase(record: Record, periods: Periods) -> np.ndarray:
    """Those of the frames that count that share the phase of most, as far apart as most of these.

    A run may end between two of them, and be prolonged from there.
    """
    counted = _counted(record, periods)
    if len(counted) == 0:
        return counted
    turns = record.frame_times("grains")[counted] / record.shaken.period
    phase = turns % 1.0
    around = np.sort(np.concatenate([phase - 1.0, phase, phase + 1.0]))
    alike = np.searchsorted(around, phase + SAME_PHASE) - np.searchsorted(around, phase - SAME_PHASE)
    off = turns - phase[alike.argmax()]
    nearest = np.argsort(np.abs(off - np.round(off)), kind="stable")
    period, first = np.unique(np.round(off[nearest]).astype(np.int64), return_index=True)
    one_each = nearest[first]
    together = np.abs(off[one_each] - period) < SAME_PHASE
    period, one_each = period[together], one_each[together]
    if len(period) > 1:
        apart = np.diff(period)
        usual = int(np.bincount(apart).argmax())
        even = (period - period[(apart == usual).argmax()]) % usual == 0
        one_each = one_each[even]
    return counted[one_each]


def profiles_of(group: Group, periods: Periods) -> Profiles | None:
    """Means over the frames of each run, then over the runs. None without frames of grains."""
    sizes = [_extent(record, periods) for record in group.records]
    if not all(size is not None for size in sizes):
        return None
    diameter = float(np.mean([size[2] for size in sizes]))
    left, width = min(size[0] for size in sizes), max(size[1] for size in sizes)
    rows = max(1, int(np.ceil(max(size[3] for size in sizes) / (STRIP * diameter))))
    edges = STRIP * diameter * np.arange(rows + 1)
    values: dict[str, list[Floats]] = {name: [] for name in PROFILES}
    frames = 0
    for record in group.records:
        own, count = _profiles_of_run(record, periods, edges, left, width, diameter)
        frames += count
        for name, profile in own.items():
            values[name].append(profile)
    mean, half = {}, {}
    for name in PROFILES:
        mean[name], half[name], _ = intervals(values[name])
    return Profiles(y=0.5 * (edges[:-1] + edges[1:]), mean=mean, half_width=half, frames=frames)


def _extent(record: Record, periods: Periods) -> tuple[float, float, float, float] | None:
    """Left side, width, mean diameter and highest grain over the floor [m]."""
    left, right, top, diameter = np.inf, -np.inf, 0.0, None
    counted = _counted(record, periods)
    for time, arrays in _read(record, counted[:: max(1, len(counted) // LOOKED_AT)]):
        own = _own(record, arrays)
        if not own.any():
            return None
        x, y = _in_box(record, time, arrays)[own].T
        r = arrays["radius"][own]
        left, right = min(left, float((x - r).min())), max(right, float((x + r).max()))
        top, diameter = max(top, float(np.quantile(y + r, 0.995))), 2.0 * float(r.mean())
    if diameter is None:
        return None
    if record.box is not None:
        left, right = 0.0, float(record.box["width"])
    return left, right - left, diameter, top


def _profiles_of_run(
    record: Record, periods: Periods, edges: Floats, left: float, width: float, diameter: float
) -> tuple[dict[str, Floats], int]:
    rows, across = len(edges) - 1, max(1, round(width / (TEMPERATURE_CELL * diameter)))
    # cells of the local mean are as high as several strips: a strip has the temperature of the cell it lies in
    stack = max(1, round(TEMPERATURE_CELL / STRIP))
    layers = -(-rows // stack)
    cells = Cells(
        left=left, width=width, height=layers * stack * float(edges[1]), columns=across, rows=layers,
        period=(record.period[0], None),
    )  # fmt: skip
    packing, contacts, count = np.zeros(rows), np.zeros(rows), np.zeros(rows)
    energy, turning, freedoms, spins = (np.zeros(layers) for _ in range(4))
    frames = 0
    for time, arrays in frames_of(record, periods):
        free, own = arrays["body"] == FREE, _own(record, arrays)
        x, y = _in_box(record, time, arrays).T
        packing += fraction_in_strips(y[free], np.asarray(arrays["radius"], float)[free], edges, width)
        held = coordination_in_strips(arrays["contacts"][own], y[own], edges)
        contacts += np.nan_to_num(held.mean) * held.count
        count += held.count
        found = granular_temperature(_moving(x, y, arrays, own), cells)
        weight, spin_weight = np.maximum(found.count - 3.0, 0.0), np.maximum(found.count - 1.0, 0.0)
        energy += np.nansum(found.translational * weight, axis=1)
        turning += np.nansum(found.rotational * spin_weight, axis=1)
        freedoms, spins = freedoms + weight.sum(axis=1), spins + spin_weight.sum(axis=1)
        frames += 1
    with np.errstate(invalid="ignore", divide="ignore"):
        temperatures = [np.repeat(t / n, stack)[:rows] for t, n in ((energy, freedoms), (turning, spins))]
        values = (packing / frames, contacts / count, *temperatures)
    return dict(zip(PROFILES, values, strict=True)), frames


def _moving(x: Floats, y: Floats, arrays: dict[str, np.ndarray], own: np.ndarray) -> MovingGrains:
    """Grains with masses over the mean one: equal densities, so that areas will do."""
    vx, vy = np.asarray(arrays["velocity"][own][:, :2], float).T
    radius = np.asarray(arrays["radius"][own], float)
    mass = radius**2 / np.mean(radius**2)
    return MovingGrains(x[own], y[own], vx, vy, np.asarray(arrays["spin"][own], float), mass, 0.5 * mass * radius**2)


def rolls_of(group: Group, periods: Periods) -> Rolls:
    """Convection of all runs of a group.

    Raises
    ------
    ParticleError
        If the frames are not a whole number of periods apart, or fewer than two, or no grain is in the middle or none
        at the sides.
    """
    sizes = [_extent(record, periods) for record in group.records]
    if not all(size is not None for size in sizes):
        raise ParticleError("no convection is seen: there are no frames of grains in the periods that count")
    diameter = float(np.mean([size[2] for size in sizes]))
    left, width, top = (f(size[k] for size in sizes) for f, k in ((min, 0), (max, 1), (max, 3)))
    size = CONVECTION_CELL * diameter
    cells = Cells(
        left=left,
        width=width,
        height=top,
        columns=max(FEWEST_COLUMNS, round(width / size)),
        rows=max(1, round(top / size)),
        period=(group.records[0].period[0], None),
    )
    fields, rolls = [], []
    for record in group.records:
        apart = periods_between_frames(record, periods)
        found = convection(_places(record, periods), cells)
        fields.append(found._replace(displacement=found.displacement / apart, roll=found.roll / apart))
        known = np.isfinite(fields[-1].roll)
        if known.any():
            rolls.append(float(fields[-1].roll[known].mean()))
    if not rolls:
        raise ParticleError("no convection is seen: no period has grains both in the middle and at the sides")
    count = sum(found.count for found in fields)
    total = sum(np.nan_to_num(found.displacement) * found.count[..., None] for found in fields)
    with np.errstate(invalid="ignore"):
        mean = total / count[..., None]
    joined = Convection(mean, count, np.concatenate([found.roll for found in fields]))
    return Rolls(cells=cells, field=joined, roll=confidence(rolls))


def periods_between_frames(record: Record, periods: Periods) -> int:
    """Periods from one frame to the next.

    Raises
    ------
    ParticleError
        If there are fewer than two frames of one phase, or they are not evenly spaced.
    """
    times = record.frame_times("grains")
    apart = np.diff(times[_of_one_phase(record, periods)]) / record.shaken.period
    whole = round(float(apart.mean())) if len(apart) else 0
    if whole < 1 or np.abs(apart - whole).max() > SAME_PHASE:
        usual = np.diff(times) / record.shaken.period
        raise ParticleError(
            f"no convection is seen: of {len(_counted(record, periods))} frames of {record.folder} that count, "
            f"{usual.max(initial=0.0):.3g} periods apart at most, no two are of one phase and evenly spaced; set "
            "output.frames_per_second to 1/period or a whole part of it"
        )
    return whole


def _places(record: Record, periods: Periods) -> Iterator[Floats]:
    for time, arrays in _read(record, _of_one_phase(record, periods)):
        yield _in_box(record, time, arrays)[_own(record, arrays)]
