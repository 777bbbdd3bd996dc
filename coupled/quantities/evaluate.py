"""The value of a quantity of interest, from the history and the last state of a run."""

from __future__ import annotations

import math
import tomllib
from functools import singledispatch
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coupled.errors import QuantityError
from coupled.output import checkpoint, history
from coupled.quantities.curve import Curve
from coupled.quantities.frequency import frequency_of
from coupled.quantities.surface import mean_height, slope_angle
from coupled.scene import Scene, load_scene
from coupled.scene.quantities import ColumnOverTime, ColumnValue, ColumnWhen, Packing, Quantity, Surface
from coupled.scene.units import in_units
from particles.measures import Cells, fraction_in_cells

SCENE, SUMMARY = "scene.toml", "summary.json"
Floats = NDArray[np.float64]


def evaluate(quantity: Quantity, folder: Path) -> float:
    """Value of a quantity in a finished run.

    Parameters
    ----------
    quantity : Quantity
        A table of a scene's [[quantities]].
    folder : Path
        Of the run.

    Raises
    ------
    QuantityError
        If the run does not have it: it is not finished, a value is never reached, a time is outside the run, the
        number is not finite.
    """
    if not (Path(folder) / SUMMARY).exists():
        raise QuantityError(f"{quantity.name} of {folder} is not known: there is no finished run in it; go on with it")
    return _known(quantity, Path(folder))


def _known(quantity: Quantity, folder: Path) -> float:
    """Value of a quantity in a run that has come to its end, whose summary may not be written yet."""
    try:
        value = _value(quantity, folder)
    except (QuantityError, OSError) as error:
        why = in_units(str(error), _units(folder))
        raise QuantityError(f"{quantity.name} of {folder} is not known: {why}") from None
    if not math.isfinite(value):
        raise QuantityError(f"{quantity.name} of {folder} is not known: its value is {value}")
    return value


def _units(folder: Path) -> str:
    """The key `units` of the scene in a folder."""
    path = folder / SCENE
    return str(tomllib.loads(path.read_text()).get("units", "SI")) if path.exists() else "SI"


def known_of(scene: Scene, folder: Path) -> tuple[dict[str, float | None], list[str]]:
    """Values of all quantities of a scene by name, None where one is not known, and the sentences that say why."""
    values: dict[str, float | None] = {}
    sentences = []
    for quantity in scene.quantities:
        try:
            values[quantity.name] = _known(quantity, folder)
        except QuantityError as error:
            values[quantity.name] = None
            sentences.append(str(error))
    return values, sentences


@singledispatch
def _value(quantity: object, folder: Path) -> float:
    raise TypeError(f"{type(quantity).__name__} is no quantity")


@_value.register
def _(quantity: ColumnValue, folder: Path) -> float:
    curve = _curve(folder, quantity.column)
    return curve.at(float(curve.time[-1]) if quantity.time is None else quantity.time)


@_value.register
def _(quantity: ColumnOverTime, folder: Path) -> float:
    part = _curve(folder, quantity.column).between(quantity.start, quantity.end)
    over = _over(quantity, folder)
    if quantity.kind in ("drop", "rise"):
        return (-1.0 if quantity.kind == "drop" else 1.0) * _gain(part, over)
    if over is not None:
        part.require_length(over)
        part = part.last(over)
    match quantity.kind:
        case "mean":
            return part.mean()
        case "min":
            return float(part.value.min())
        case "max":
            return float(part.value.max())
        case "frequency":
            return frequency_of(part.time, part.value, part.name)


@_value.register
def _(quantity: ColumnWhen, folder: Path) -> float:
    other = _curve(folder, quantity.other)
    target = quantity.reaches
    if target is None:
        assert quantity.changes_by is not None, "the rules of the scene demand one of them"
        target = float(other.value[0]) + quantity.changes_by
    return _curve(folder, quantity.column).at(other.first_time_at(target))


@_value.register
def _(quantity: Surface, folder: Path) -> float:
    scene = load_scene(folder / SCENE)
    x, y, radius = _free_grains(folder)
    left, right = _ends(quantity, scene)
    bottom = float((y - radius).min())
    window = Cells(
        left=left, bottom=bottom, width=right - left, height=float((y + radius).max()) - bottom,
        columns=1, rows=1, period=_period(scene),
    )  # fmt: skip
    across, up, which = (np.concatenate(column) for column in zip(*window.images(x, y, radius), strict=True))
    law = mean_height if quantity.kind == "surface_height" else slope_angle
    return law(left + across, bottom + up, radius[which], left, right)


@_value.register
def _(quantity: Packing, folder: Path) -> float:
    scene = load_scene(folder / SCENE)
    left, right = _ends(quantity, scene)
    rectangle = Cells(
        left=left, bottom=quantity.bottom, width=right - left, height=quantity.top - quantity.bottom,
        columns=1, rows=1, period=_period(scene),
    )  # fmt: skip
    return float(fraction_in_cells(*_free_grains(folder), rectangle)[0, 0])


def _over(quantity: ColumnOverTime, folder: Path) -> float | None:
    """Length of the ends of a window that count [s], or None."""
    if quantity.over_periods is None:
        return quantity.over
    scene = load_scene(folder / SCENE)
    assert scene.shaking is not None, "the rules of the scene demand it"
    return quantity.over_periods * scene.shaking.period_with(scene.time.least_step)


def _gain(part: Curve, over: float | None) -> float:
    """Value at the end of a window minus that at its start, or the same of means over a length [s]."""
    if over is None:
        return float(part.value[-1] - part.value[0])
    part.require_length(2.0 * over)
    return part.last(over).mean() - part.first(over).mean()


def _curve(folder: Path, column: str) -> Curve:
    columns = history.read_history(folder / history.NAME)
    if column not in columns:
        raise QuantityError(f"{history.NAME} has no column {column}")
    if len(columns["time"]) == 0:
        raise QuantityError(f"{history.NAME} has no rows")
    value = columns[column]
    if not np.isfinite(value).all():
        raise QuantityError(f"the column {column} has a value that is no finite number")
    return Curve(name=column, time=columns["time"], value=value)


def _free_grains(folder: Path) -> tuple[Floats, Floats, Floats]:
    """Places and radii [m] of the free grains at the end of a run."""
    saved, _ = checkpoint.load(folder / checkpoint.NAME)
    count = int(saved["particles.grains.n_free"])
    x, y, radius = (saved[f"particles.grains.{name}"][:count] for name in ("x", "y", "radius"))
    return x, y, radius


def _ends(quantity: Surface | Packing, scene: Scene) -> tuple[float, float]:
    """Left and right end [m], from the box of the scene where they are not given."""
    left, right = quantity.left, quantity.right
    if right is None:
        assert scene.box is not None, "the rules of the scene demand ends or a box"
        right = scene.box.width
    return 0.0 if left is None else left, right


def _period(scene: Scene) -> tuple[float | None, None]:
    """Length after which x repeats [m]; heights are told as they are."""
    return (None if scene.box is None else scene.box.period[0], None)
