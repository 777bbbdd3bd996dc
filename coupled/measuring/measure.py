"""Measures of runs, written as tables and pictures."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from coupled.errors import LeitoError
from coupled.measuring.findings import Findings, find
from coupled.measuring.pictures import draw_all
from coupled.measuring.rises import LargeDeviations, Periods, Rise
from coupled.measuring.samples import told
from coupled.measuring.states import PROFILES

FOLDER = "measures"
MOMENTS = ("mean", "variance", "skewness", "excess")


def measure(folders: Sequence[Path], *, out: Path | None = None, periods: Periods) -> tuple[list[Findings], list[Path]]:
    """Measure the runs in folders and write tables and pictures.

    Parameters
    ----------
    folders : sequence of Path
        Runs, or folders that hold runs; those that differ in their seeds alone are samples of one case.
    out : Path, optional
        Where to write; absent: ``measures`` in the first folder.
    periods : Periods
        Of the shaking that count.

    Raises
    ------
    LeitoError
        If there is nothing to measure, or the folder cannot be written to.
    """
    found = find(folders, periods)
    target = out if out is not None else folders[0] / FOLDER
    try:
        target.mkdir(parents=True, exist_ok=True)
        written = _write_tables(found, target)
    except OSError as error:
        raise LeitoError(
            f"{target} cannot be written to ({error.strerror or error}); choose another with --out"
        ) from None
    return found, written + draw_all(found, target)


def draw_run(folder: Path, target: Path) -> list[Path]:
    """The pictures of one shaken run alone."""
    try:
        return draw_all(find([folder], Periods()), target)
    except LeitoError:
        return []  # too short for any measure


def rows_told(found: Sequence[Findings]) -> list[tuple[str, ...]]:
    """What the terminal tells: case, quantity, value with its 95 % interval."""
    rows = []
    for one in found:
        for rise in one.rises:
            shown = rise.mean[np.isfinite(rise.mean)]
            rows.append((one.group.label, f"{rise.name}: height at first, at last", f"{shown[0]:.4g}, {shown[-1]:.4g}"))
            rows.append((one.group.label, f"{rise.name}: rise per period", _interval(told(rise.rate))))
            if rise.deviations.moments:
                longest = rise.deviations.moments[-1]
                spread, half = longest.variance
                what = f"{rise.name}: variance per period, windows of {longest.periods}"
                rows.append((one.group.label, what, f"{spread:.4g} +- {half:.2g}"))
            rows += [(one.group.label, f"{rise.name}: slope of the symmetry, {what}", value)
                     for what, value in rise.deviations.slopes]  # fmt: skip
        if one.rolls is not None:
            rows.append((one.group.label, "convection, middle over sides per period", _interval(told(one.rolls.roll))))
        if one.profiles is not None:
            lower = one.profiles.mean["packing"][: max(1, len(one.profiles.y) // 2)]
            rows.append((one.group.label, "packing fraction of the lower half", f"{np.nanmean(lower):.4g}"))
    return rows


def _interval(found: dict[str, Any]) -> str:
    if found["half_width"] is None:
        return f"{found['mean']:.4g}, one sample"
    return f"{found['mean']:.4g} +- {found['half_width']:.2g}, {found['samples']} samples"


def _with_bars(names: Iterable[str]) -> Iterator[str]:
    """Columns of values, each with its half width."""
    return (f"{name}{more}" for name in names for more in ("", "_half_width"))


def _write_tables(found: Sequence[Findings], target: Path) -> list[Path]:
    tables: dict[str, tuple[tuple[str, ...], Iterable[Sequence[Any]]]] = {
        "rises": (("case", "sample", "intruder", "time", "height", "rise"), _rises(found)),
        "height": (("case", "intruder", "time", "mean", "half_width", "samples"), _heights(found)),
        "profiles": (("case", "height", *_with_bars(PROFILES)), _profiles(found)),
        "convection": (("case", "x", "height", "along", "up", "count"), _convection(found)),
        "windows": (("case", "intruder", "periods", *_with_bars(MOMENTS)), _moments(found)),
        "large_deviation": (("case", "intruder", "road", "periods", "v", "rate", "half_width"), _deviations(found)),
    }  # fmt: skip
    written = []
    for name, (header, rows) in tables.items():
        table = list(rows)
        if table:
            written.append(target / f"{name}.csv")
            with open(written[-1], "w", newline="") as file:
                csv.writer(file).writerows([header, *table])
    written.append(target / "measures.json")
    written[-1].write_text(json.dumps([_numbers(one) for one in found], indent=2) + "\n")
    return written


def _rises(found: Sequence[Findings]) -> Iterator[Sequence[Any]]:
    for one in found:
        for rise in one.rises:
            for record, sample in zip(one.group.records, rise.samples, strict=True):
                change = np.append(sample.rise, np.nan)  # from this look to the next
                for row in zip(sample.time, sample.value, change, strict=True):
                    yield one.group.label, record.folder.name, rise.name, *map(_short, row)


def _heights(found: Sequence[Findings]) -> Iterator[Sequence[Any]]:
    for one in found:
        for rise in one.rises:
            for time, mean, half, count in zip(rise.time, rise.mean, rise.half_width, rise.count, strict=True):
                yield one.group.label, rise.name, _short(time), _short(mean), _short(half), int(count)


def _profiles(found: Sequence[Findings]) -> Iterator[Sequence[Any]]:
    for one in found:
        if one.profiles is not None:
            columns = [part[name] for name in PROFILES for part in (one.profiles.mean, one.profiles.half_width)]
            for row in zip(one.profiles.y, *columns, strict=True):
                yield one.group.label, *map(_short, row)


def _convection(found: Sequence[Findings]) -> Iterator[Sequence[Any]]:
    for one in found:
        if one.rolls is not None:
            cells, field = one.rolls.cells, one.rolls.field
            for row, y in enumerate(cells.y):
                for column, x in enumerate(cells.x):
                    along, up = field.displacement[row, column]
                    count = int(field.count[row, column])
                    yield one.group.label, _short(x), _short(y), _short(along), _short(up), count


def _moments(found: Sequence[Findings]) -> Iterator[Sequence[Any]]:
    for one in found:
        for rise in one.rises:
            for moments in rise.deviations.moments:
                numbers = [_short(number) for name in MOMENTS for number in getattr(moments, name)]
                yield one.group.label, rise.name, moments.periods, *numbers


def _deviations(found: Sequence[Findings]) -> Iterator[Sequence[Any]]:
    for one in found:
        for rise in one.rises:
            for road, periods, curve in _roads(rise.deviations):
                for v, rate, half in zip(*curve, strict=True):
                    if np.isfinite(rate):
                        yield one.group.label, rise.name, road, periods, _short(v), _short(rate), _short(half)


def _roads(found: LargeDeviations) -> Iterator[tuple[str, int | str, tuple[Any, ...]]]:
    for curve in found.curves:
        yield "histogram", curve.periods, (curve.v, curve.rate, curve.half_width)
    if found.limit is not None:
        yield "limit", "", (found.limit.v, found.limit.rate, found.limit.half_width)
    for periods, curve in found.tilted.items():
        yield "transform", periods, (curve.v, curve.rate, curve.half_width)


def _numbers(one: Findings) -> dict[str, Any]:
    """One case for the JSON file."""
    record = one.group.records[0]
    numbers: dict[str, Any] = {"case": one.group.label, "title": record.title, "samples": len(one.group.records)}
    if record.shaken is not None:
        gamma = record.shaken.gamma
        numbers |= {"gamma": gamma if np.isfinite(gamma) else None, "period": record.shaken.period}
    numbers["intruders"] = [_rise_numbers(rise) for rise in one.rises]
    if one.rolls is not None:
        numbers["roll"] = told(one.rolls.roll)
    return numbers | {"notes": list(one.notes)}


def _rise_numbers(rise: Rise) -> dict[str, Any]:
    found = rise.deviations
    shown = np.nonzero(np.isfinite(rise.mean))[0]
    numbers: dict[str, Any] = {
        "name": rise.name,
        "phase": rise.phase,
        "periods": len(rise.time) - 1,
        "height_first": float(rise.mean[shown[0]]),
        "height_last": float(rise.mean[shown[-1]]),
        "rise_per_period": told(rise.rate),
        "windows": list(found.lengths),
    }
    if found.lacks:
        return numbers | {"lacks": found.lacks}
    widest = found.limit.gap[np.isfinite(found.limit.gap)]
    numbers["resampled"] = "samples" if found.whole else "blocks"
    numbers["moments"] = [
        {"periods": each.periods} | {name: getattr(each, name)._asdict() for name in MOMENTS} for each in found.moments
    ]
    numbers["transform_settled_at"] = found.settled
    numbers["largest_gap_of_curves"] = float(widest.max()) if len(widest) else None
    numbers["symmetry"] = [
        {"periods": each.periods, "slope": each.slope, "half_width": each.half_width, "lacks": each.lacks}
        for each in found.symmetries
    ]
    numbers["symmetry_slope"] = (
        None if found.slope is None else dict(zip(("value", "half_width"), found.slope, strict=True))
    )
    return numbers


def _short(value: float) -> str:
    """A number for a table; empty where there is none."""
    return f"{value:.8g}" if np.isfinite(value) else ""
