"""Factors and presets on shaken scenes: what they leave as it is, and that the runs hold."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bad_scenes import SHAKEN, Case, changed, require_refusal
from test_shaken_scenes import FEW, RHO

from coupled.build import build
from coupled.output.history import read_history
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene
from particles import ParticleSystem

AMPLITUDE = 1.5 * (4.0 / (2.0 * np.pi)) ** 2
FACTORS: dict[str, dict[str, Any]] = {
    "as it is": {},
    "coarse": {"grains.coarsening": 2.0},
    "coarse, step left to the model": {"grains.coarsening": 1.5, "time.step": "auto"},
    "stiff": {"contact.stiffness_factor": 4.0},
    "single": {"grains.precision": "float32"},
    "finer step": {"time.refinement": 2.0},
}
DRAFT = {"grains.coarsening": 1.5, "grains.precision": "float32", "contact.stiffness_factor": 0.5, "time.step": "auto"}


def of_intruder(system: ParticleSystem) -> tuple[float, float]:
    """Its radius and mass."""
    (at,) = np.nonzero(system.grains.number == system.grains.n_free - 1)[0]
    return float(system.grains.radius[at]), float(system.grains.mass[at])


@pytest.mark.parametrize("name", FACTORS)
def test_factors_leave_the_shaking_and_the_intruder(name: str) -> None:
    built = build(Scene.model_validate(changed(FEW, FACTORS[name])))
    system = built.model.particles
    shaking = system.shaking
    assert (shaking.period, shaking.start, shaking.amplitude) == (4.0, 1.0, pytest.approx(AMPLITUDE, rel=1e-12))
    assert [wall.name for wall in system.walls if wall.shaken] == ["floor"]
    # 1.5^2 times the density over that times pi of the others; single precision has 24 bits
    assert of_intruder(system) == (1.5, pytest.approx(1.5**2 * np.pi * RHO, rel=2.0**-23))
    # as much of the other grains, to half a grain of 15 and the spread of their sizes
    mass = system.grains.mass[: system.grains.n_free].sum(dtype=float) - 1.5**2 * np.pi * RHO
    assert mass == pytest.approx(60 * 0.25 * np.pi * RHO, rel=0.06)


@pytest.mark.parametrize("accuracy", ["draft", "reference"])
def test_presets_change_the_step_of_a_shaken_scene_alone(accuracy: str) -> None:
    """An intruder among grains is told apart by its size: draft takes no larger grains."""
    usual, preset = load_scene("shaken_walls"), load_scene("shaken_walls", accuracy=accuracy)
    changes = {"time", "preset"}
    assert usual.model_dump(exclude=changes) == preset.model_dump(exclude=changes)
    assert preset.time.step == "auto" and preset.time.duration == usual.time.duration


def test_a_shaken_run_with_all_factors_holds(tmp_path: Path) -> None:
    scene = Scene.model_validate(changed(FEW, DRAFT))
    out = run_scene(scene, out=tmp_path / "run", threads=1, progress=False)
    seen = read_history(out / "history.csv")
    np.testing.assert_allclose(
        seen["floor_y"], AMPLITUDE * (1.0 - np.cos(0.5 * np.pi * np.maximum(seen["time"] - 1.0, 0.0))), atol=1e-9
    )
    assert seen["walls_work"][-1] > 1.0
    # of the integrator with the step that the model chooses, 0.8 of its limit: some percent at each impact
    assert np.abs(seen["ledger_relative_error"]).max() < 0.05
    # nothing has left the box, or fallen through its floor
    assert (seen["intruder_y"] - seen["floor_y"]).min() > 1.5 * 0.9 and seen["highest_grain"].max() < 15.0


STEPS = {"time.step": "auto", "shaking": {"gamma": 2.0, "period_steps": 5000}}
BAD: dict[str, Case] = {
    "coarser grains in counted steps": (
        changed(SHAKEN, STEPS),
        {"grains.coarsening": 2.0},
        "shaking.period_steps",
        ("left to the model", "give shaking.period"),
    ),
    "stiffer grains in counted steps": (
        changed(SHAKEN, STEPS),
        {"contact.stiffness_factor": 2.0},
        "shaking.period_steps",
        ("stiffness_factor changes them", "time.step as a number"),
    ),
    "grains too coarse for their box": (
        FEW,
        {"grains.coarsening": 6.0},
        "grains.sizes",
        ("2 grains are more than the 1 that", "made by grains.coarsening = 6)"),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_refusal(case: str, tmp_path: Path) -> None:
    require_refusal(BAD[case], tmp_path)
