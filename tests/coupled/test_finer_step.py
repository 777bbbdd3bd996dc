"""A run that is taken up with a smaller step: time, velocities and counts go over without a jolt."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coupled.errors import LeitoError
from coupled.output import checkpoint
from coupled.output.history import read_history
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene
from coupled.templates import write_template
from coupled.running.watchdog import Unstable

RADIUS, DENSITY, STIFFNESS, SPEED, GRAVITY = 0.01, 1000.0, 1e5, 1.0, 9.81
MASS = np.pi * RADIUS**2 * DENSITY
OMEGA = np.sqrt(STIFFNESS / MASS)


def disc(*, height: float, velocity: float, step: float, duration: float, gravity: float = 0.0) -> Scene:
    """One disc above a floor, without damping."""
    tables: dict[str, Any] = {
        "title": "a disc",
        "gravity": [0.0, -gravity],
        "time": {"duration": duration, "step": step},
        "box": {"width": 1.0, "height": 10.0, "walls": ["floor"]},
        "grains": {
            "sizes": [{"radius": RADIUS, "count": 1}],
            "density": DENSITY,
            "layout": "list",
            "positions": [[0.5, height, 0.3, velocity, 2.0]],
        },
        "contact": {"normal_stiffness": STIFFNESS},
        "output": {"history_interval": duration, "frames_per_second": 0.0, "figures": False},
    }
    return Scene.model_validate(tables)


def test_free_fall_stays_the_parabola_to_round_off(tmp_path: Path) -> None:
    """The leapfrog is exact under a constant force, if velocities stand half a step ahead, whatever the step."""
    out = tmp_path / "run"
    run_scene(disc(height=9.0, velocity=1.0, step=1e-3, duration=0.5, gravity=GRAVITY), out=out, progress=False)
    finer = disc(height=9.0, velocity=1.0, step=1e-3 / 7, duration=1.0, gravity=GRAVITY)
    run_scene(finer, out=out, resume=True, progress=False)
    state, _ = checkpoint.load(out / "checkpoint.h5")
    assert state["model.steps_done"] == 7000 and state["particles.counters"][0] == 7000
    # 4000 steps of round-off
    np.testing.assert_allclose(state["particles.grains.y"], 9.0 + 1.0 - GRAVITY / 2, rtol=1e-12)
    np.testing.assert_allclose(state["particles.grains.x"], 0.5 + 0.3, rtol=1e-12)
    assert read_history(out / "history.csv")["time"].tolist() == [0.0, 0.5, pytest.approx(1.0)]


def test_a_bounce_that_is_taken_up_in_the_middle_keeps_its_energy_with_order_two(tmp_path: Path) -> None:
    """A quarter of the contact's time after touching; velocities left as they were would give order one."""
    errors = []
    for k, steps in enumerate((16, 32, 64)):
        step = np.pi / OMEGA / (4 * steps)  # the touch lies between two steps at the same share of a step
        gap = 0.37 * step * SPEED
        options = {"height": RADIUS + gap, "velocity": -SPEED}
        out = tmp_path / f"run{k}"
        run_scene(disc(**options, step=step, duration=steps * step), out=out, progress=False)
        run_scene(disc(**options, step=step / 3, duration=8 * steps * step), out=out, resume=True, progress=False)
        state, _ = checkpoint.load(out / "checkpoint.h5")
        errors.append(abs(float(state["particles.grains.vy"][0]) / SPEED - 1.0))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(rates > 1.8), (errors, rates)
    assert errors[0] < 1e-3


@pytest.mark.parametrize("step", [2e-3, 0.7e-3, 1e-3 / 2.5])
def test_a_step_that_is_no_whole_fraction_is_refused(step: float, tmp_path: Path) -> None:
    run_scene(disc(height=9.0, velocity=1.0, step=1e-3, duration=0.5), out=tmp_path / "run", progress=False)
    with pytest.raises(LeitoError, match="time.step = .* cannot take up a state of 0.001 s per step: take a whole"):
        run_scene(disc(height=9.0, velocity=1.0, step=step, duration=1.0), out=tmp_path / "run", resume=True)


def test_a_failed_run_goes_on_with_the_step_it_advises(tmp_path: Path) -> None:
    path = write_template("grains", tmp_path / "grains.toml")
    sets = ["output.frames_per_second=0", "output.figures=false", "time.duration=0.4", "output.history_interval=0.002"]
    with pytest.raises(Unstable) as caught:
        run_scene(load_scene(path, [*sets, "time.step=4e-4"]), out=tmp_path / "run", threads=1, progress=False)
    advised = re.search(r"take time.step = ([\d.e-]+) s", str(caught.value))[1]
    failed, _ = checkpoint.load(tmp_path / "run" / "before_failure.h5")
    finer = load_scene(path, [*sets, f"time.step={advised}"])
    run_scene(finer, out=tmp_path / "run", resume=True, threads=1, progress=False)
    times = read_history(tmp_path / "run" / "history.csv")["time"]
    assert np.all(np.diff(times) > 0.0) and times[-1] == pytest.approx(0.4, abs=1e-3)
    done, _ = checkpoint.load(tmp_path / "run" / "checkpoint.h5")
    assert done["model.steps_done"] * done["run.step"] > failed["model.steps_done"] * failed["run.step"]
    with pytest.raises(LeitoError, match="cannot take up a state"):
        run_scene(load_scene(path, [*sets, "time.step=4e-4"]), out=tmp_path / "run", resume=True, progress=False)
