"""`grains.precision`: from the scene into the model, through a checkpoint, and onto a bed of the other kind."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coupled.build import build
from coupled.output import checkpoint
from coupled.scene import Scene

STEP = 1e-5


def scene(precision: str | None, **more: Any) -> Scene:
    tables = {
        "title": "forty discs that fall",
        "gravity": [0.0, -9.81],
        "time": {"duration": 0.1, "step": STEP},
        "box": {"width": 0.03, "height": 0.2},
        "grains": {"sizes": [{"radius": 2e-3, "count": 40}], "density": 1600.0, "spacing": 1.01, "jitter": 0.9},
        "contact": {"normal_stiffness": 1e5, "normal_damping": 1.0, "tangential_stiffness": 5e3, "friction": 0.5},
    }
    if precision is not None:
        tables["grains"]["precision"] = precision
    return Scene.model_validate(tables | more)


@pytest.mark.parametrize(("precision", "dtype"), [(None, np.float64), ("float64", np.float64), ("float32", np.float32)])
def test_the_scene_says_how_forces_are_stored(precision: str | None, dtype: type) -> None:
    grains = build(scene(precision)).model.particles.grains
    assert grains.fx.dtype == grains.mass.dtype == dtype
    assert grains.x.dtype == grains.vy.dtype == grains.radius.dtype == np.float64


def test_a_checkpoint_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    first, second = (build(scene("float32")).model for _ in range(2))
    first.advance(3000)
    assert first.particles.look().count > 20
    checkpoint.save(tmp_path / "state.h5", first.state(), scene="")
    second.restore(checkpoint.load(tmp_path / "state.h5")[0])
    for model in (first, second):
        model.advance(500)
    one, other = first.state(), second.state()
    assert all(np.array_equal(one[name], other[name]) for name in one)


def test_grains_fall_onto_each_other_alike() -> None:
    """Before collisions have enlarged the rounding of forces: their mean height after the first contacts."""
    heights = []
    for precision in ("float64", "float32"):
        model = build(scene(precision)).model
        model.advance(2000)  # 0.02 s: the first contacts
        heights.append(model.particles.grains.y.mean())
    assert heights[1] == pytest.approx(heights[0], rel=100 * 2.0**-24)
