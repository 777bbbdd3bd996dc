"""What the samples of an ensemble came to, one by one and in the mean."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from coupled.campaign import Outcome
from coupled.campaign.statistics import Interval, confidence
from coupled.ensemble.grid import Combination
from coupled.ensemble.samples import Sample
from coupled.errors import QuantityError
from coupled.output import history
from coupled.quantities import evaluate
from coupled.report.quantities import unit_shown
from coupled.scene.history import unit_of

TABLE, MEANS = "ensemble.csv", "ensemble_mean.csv"


@dataclass(frozen=True, kw_only=True)
class Result:
    """A sample with its numbers by name, which are units beside them; a number that is not known is left out."""

    sample: Sample
    outcome: Outcome
    numbers: dict[str, float]
    units: dict[str, str]
    unknown: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Mean:
    """A quantity of one combination over its samples; `interval` is None where no sample has it."""

    combination: Combination
    quantity: str
    unit: str
    interval: Interval | None


def result_of(sample: Sample, outcome: Outcome) -> Result:
    """The quantities of the scene out of a run that is done; of a scene without any, the last row of its history."""
    if outcome.status != "done":
        return Result(sample=sample, outcome=outcome, numbers={}, units={})
    asked, system = sample.task.scene.quantities, sample.task.scene.units
    if not asked:
        rows = history.read_history(sample.task.folder / history.NAME)
        last = {name: float(column[-1]) for name, column in rows.items()}
        units = {name: unit_of(name, system) for name in last}
        return Result(sample=sample, outcome=outcome, numbers=last, units=units)
    numbers, unknown = {}, []
    for quantity in asked:
        try:
            numbers[quantity.name] = evaluate(quantity, sample.task.folder)
        except QuantityError as error:
            unknown.append(str(error))
    units = {quantity.name: unit_shown(quantity, system) for quantity in asked}
    return Result(sample=sample, outcome=outcome, numbers=numbers, units=units, unknown=tuple(unknown))


def means_of(results: Sequence[Result]) -> list[Mean]:
    """Mean and confidence interval (95 %) of each quantity over the samples of each combination that have it."""
    units = _units(results)
    combinations = dict.fromkeys(result.sample.combination for result in results)
    found = []
    for combination in combinations:
        own = [result for result in results if result.sample.combination == combination]
        for name, unit in units.items():
            values = [result.numbers[name] for result in own if name in result.numbers]
            interval = confidence(values) if values else None
            found.append(Mean(combination=combination, quantity=name, unit=unit, interval=interval))
    return found


def write_tables(results: Sequence[Result], means: Sequence[Mean], out: Path) -> None:
    """Write ``ensemble.csv``, a row per sample, and ``ensemble_mean.csv``, a row per combination and quantity.

    Numbers are written exactly and no time or name of a machine among them, so that the same samples give the
    same file, whoever has run them.
    """
    keys, units = _keys(results), _units(results)
    header = [*keys, "seed", "status", "folder", *(f"{name} [{unit}]" for name, unit in units.items())]
    rows = [
        [
            *(value for _, value in result.sample.combination.values),
            "" if result.sample.seed is None else str(result.sample.seed),
            result.outcome.status,
            result.sample.task.name,
            *(repr(result.numbers[name]) if name in result.numbers else "" for name in units),
        ]
        for result in results
    ]
    _write(out / TABLE, [header, *rows])
    lines = [
        [*(value for _, value in mean.combination.values), mean.quantity, mean.unit, *_shown(mean, repr)]
        for mean in means
    ]
    _write(out / MEANS, [[*keys, "quantity", "unit", "mean", "half_width_95", "samples"], *lines])


def table(results: Sequence[Result], means: Sequence[Mean]) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Header and rows for a terminal, failed samples at the end."""
    keys = _keys(results)
    rows = [
        (
            *(value for _, value in mean.combination.values),
            mean.quantity,
            *_shown(mean, _six_digits),
            _spoken(mean.unit),
        )
        for mean in means
    ]
    return (*keys, "quantity", "mean", "+- (95 %)", "samples", "unit"), rows


def _six_digits(number: float) -> str:
    """A number for a terminal; the interval of a single sample has no end."""
    return f"{number:.6g}" if math.isfinite(number) else "?"


def _spoken(unit: str) -> str:
    return "" if unit == "-" else unit


def _shown(mean: Mean, write: Callable[[float], str]) -> tuple[str, str, str]:
    if mean.interval is None:
        return ("", "", "0")
    return (write(mean.interval.mean), write(mean.interval.half_width), str(mean.interval.count))


def _keys(results: Sequence[Result]) -> list[str]:
    return [key for key, _ in results[0].sample.combination.values]


def _units(results: Sequence[Result]) -> dict[str, str]:
    """Units by quantity, in the order in which they are first met."""
    units: dict[str, str] = {}
    for result in results:
        units |= {name: unit for name, unit in result.units.items() if name not in units}
    return units


def _write(path: Path, rows: list[list[str]]) -> None:
    """In one move, as all files of a run."""
    beside = path.with_suffix(".part")
    with open(beside, "w", newline="") as file:
        csv.writer(file).writerows(rows)
    os.replace(beside, path)
