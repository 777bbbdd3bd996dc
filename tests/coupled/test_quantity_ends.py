"""Quantities that count from the ends of their window: a rise between means over whole periods of the shaking."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from bad_scenes import GRAINS, SHAKEN, Case, changed, require_refusal

from coupled.errors import QuantityError
from coupled.quantities import evaluate
from coupled.scene import Scene, dump_scene, load_scene, shipping_scenes
from coupled.scene.quantities import ColumnOverTime

PERIOD, START = SHAKEN["shaking"]["period"], 2.0 * SHAKEN["shaking"]["period"]
RATE, SWING = 0.3, 5.0  # per period
STEPS = 400  # rows per period


def height(time: np.ndarray) -> np.ndarray:
    """A steady rise under a bed that answers the floor in its period and in twice that, far beyond its rise."""
    turns = time / PERIOD
    return RATE * turns + SWING * np.sin(np.pi * turns + 1.0) + np.cos(2.0 * np.pi * turns)


def finished(folder: Path, periods: float) -> Path:
    """A run of so many periods that tells heights."""
    scene = Scene.model_validate(changed(SHAKEN, {"time.duration": periods * PERIOD}))
    (folder / "scene.toml").write_text(dump_scene(scene))
    (folder / "summary.json").write_text("{}")
    time = np.arange(round(periods * STEPS) + 1) * PERIOD / STEPS
    rows = "".join(f"{t:.17g},{y:.17g}\n" for t, y in zip(time, height(time), strict=True))
    (folder / "history.csv").write_text("time [s],intruder_y [m]\n" + rows)
    return folder


def told(kind: str, folder: Path, **keys: float) -> float:
    return evaluate(ColumnOverTime(name="a", kind=kind, column="intruder_y", **keys), folder)


@pytest.mark.parametrize("periods", [12.0, 17.0, 40.5])
def test_rise_between_means_over_two_periods_is_the_steady_one(periods: float, tmp_path: Path) -> None:
    """Means of the swings over two periods are zero: what is left is the rate times the distance of the middles."""
    run = finished(tmp_path, periods)
    steady = RATE * (periods - 2.0 - 2.0)  # from 2 on, and two periods from middle to middle
    # the mean of a sine by 400 trapezoids is off by (2 pi/400)^2/12 of it at most
    assert told("rise", run, start=START, over_periods=2) == pytest.approx(steady, abs=2e-4 * SWING)
    assert told("drop", run, start=START, over=2.0 * PERIOD) == pytest.approx(-steady, abs=2e-4 * SWING)
    if periods == 17.0:
        assert abs(told("rise", run, start=START) - RATE * 15.0) > SWING, "moments of one phase see the swing"


@pytest.mark.parametrize("periods", [12.0, 40.5])
def test_last_part_of_a_window_lies_where_the_run_ends(periods: float, tmp_path: Path) -> None:
    run = finished(tmp_path, periods)
    assert told("mean", run, over_periods=10) == pytest.approx(RATE * (periods - 5.0), abs=2e-4 * SWING)
    assert told("mean", run, over_periods=4, end=11.0 * PERIOD) == pytest.approx(RATE * 9.0, abs=2e-4 * SWING)
    last = np.linspace(periods - 1.0, periods, 100_001) * PERIOD
    # rows are 1/400 of a period apart, and the height is level at its largest
    assert told("max", run, over_periods=1) == pytest.approx(height(last).max(), abs=2e-4 * SWING)


def test_window_that_is_too_short_is_not_known(tmp_path: Path) -> None:
    run = finished(tmp_path, 5.0)
    with pytest.raises(
        QuantityError, match=r"a of .* is not known: the window from 0.1 to 0.25 s is shorter than 0.2 s"
    ):
        told("rise", run, start=START, over_periods=2)
    with pytest.raises(QuantityError, match=r"the window from 0 to 0.25 s is shorter than 0.5 s: run it longer"):
        told("mean", run, over_periods=10)


@pytest.mark.parametrize("name", [name for name in shipping_scenes() if name.startswith(("shaken", "brazil"))])
def test_shipped_shaken_scenes_tell_their_rise_over_two_periods(name: str) -> None:
    """Made shorter by half, and with another period, their windows still lie in the run."""
    whole = load_scene(name)
    scene = load_scene(name, [f"time.duration={0.5 * whole.time.duration}", "shaking.period=4.5"])
    rise, mean = (quantity for quantity in scene.quantities)
    assert (rise.start, rise.over_periods, rise.end) == (scene.shaking.start, 2, None)
    assert mean.end is None and mean.over_periods * 4.5 < scene.time.duration - scene.shaking.start


BAD: dict[str, Case] = {
    "periods of nothing": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "mean", "column": "contacts", "over_periods": 2}]},
        "quantities.0.over_periods",
        ("[shaking]", "give over"),
    ),
    "two lengths": (
        SHAKEN,
        {"quantities": [{"name": "a", "kind": "rise", "column": "intruder_y", "over_periods": 2, "over": 0.1}]},
        "quantities.0.over_periods",
        ("together with over", "keep one"),
    ),
    "length of nothing": (
        SHAKEN,
        {"quantities": [{"name": "a", "kind": "rise", "column": "intruder_y", "over": 0.0}]},
        "quantities.0.over",
        ("greater than 0", "length of the means"),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_refusal(case: str, tmp_path: Path) -> None:
    require_refusal(BAD[case], tmp_path)
