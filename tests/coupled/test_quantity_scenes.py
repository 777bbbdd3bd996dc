"""Quantities in scenes: the columns they may name, what is refused, and what a run tells."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from bad_scenes import (
    BEAM_ON_ROW,
    GONE,
    GRAINS,
    HERTZ,
    PERIODIC,
    RIGID,
    SHAKEN,
    SURFACES,
    TUBE,
    Case,
    changed,
    require_refusal,
)

from coupled.build import build
from coupled.errors import QuantityError
from coupled.quantities import evaluate
from coupled.running.observe import observe
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene
from coupled.scene.history import history_columns

QUIET = ["output.figures=false", "output.frames_per_second=0"]
GOOD: dict[str, dict[str, Any]] = {
    "grains": GRAINS,
    "tube": TUBE,
    "rigid": RIGID,
    "free": changed(RIGID, {"structure.path": GONE, "structure.kind": "free_rigid", "structure.density": 2700.0}),
    "beam on row": BEAM_ON_ROW,
    "hertz": HERTZ,
    "surfaces": SURFACES,
    "facets": changed(TUBE, {"interface.kind": "facets"}),
    "dropped moment": changed(TUBE, {"interface.couple": False}),
    "corotational": changed(TUBE, {"structure.theory": "corotational"}),
    "large strain": changed(TUBE, {"structure.theory": "large_strain"}),
    "dissipating": changed(TUBE, {"structure.generalised_alpha": {}}),
    "shaken": SHAKEN,
    "shaken sideways": changed(PERIODIC, {"shaking.direction": "x"}),
    "not dissipating": changed(TUBE, {"structure.hht": {"alpha": 0.0}}),
    "damped newmark": changed(TUBE, {"structure.newmark": {"beta": 0.3025, "gamma": 0.6}}),
}


@pytest.mark.parametrize("name", GOOD)
def test_columns_known_beforehand_are_those_that_are_seen(name: str) -> None:
    scene = Scene.model_validate(GOOD[name])
    seen = observe(build(scene).model, None)
    assert sorted(history_columns(scene)) == sorted(seen.numbers)


@pytest.mark.parametrize("name", ["beam_vibration", "pulsing_tube", "rolling_tube", "winkler_beam"])
def test_columns_of_shipped_scenes(name: str) -> None:
    scene = load_scene(name)
    assert sorted(history_columns(scene)) == sorted(observe(build(scene).model, None).numbers)


BAD: dict[str, Case] = {
    "unknown kind": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "men", "column": "contacts"}]},
        "quantities.0.kind",
        ("unknown", "did you mean 'mean'"),
    ),
    "key of another kind": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "value", "column": "contacts", "start": 1.0}]},
        "quantities.0.start",
        ("not a known key", 'kind = "value"'),
    ),
    "column that the scene does not write": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "value", "column": "reaction_y"}]},
        "quantities.0.column",
        ("no column that this scene writes", "allowed: time, contacts", "grains_kinetic"),
    ),
    "mistyped column": (
        TUBE,
        {"quantities": [{"name": "a", "kind": "when", "column": "reaction_y", "other": "centroidy", "reaches": 1.0}]},
        "quantities.0.other",
        ("did you mean 'centroid_y'",),
    ),
    "name with a space": (
        GRAINS,
        {"quantities": [{"name": "my angle", "kind": "surface_angle"}]},
        "quantities.0.name",
        ("letters, digits and underscores",),
    ),
    "name twice": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "surface_angle"}, {"name": "a", "kind": "surface_height"}]},
        "quantities.1.name",
        ("given twice",),
    ),
    "window backwards": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "mean", "column": "contacts", "start": 0.5, "end": 0.4}]},
        "quantities.0.end",
        ("not after start = 0.5 s",),
    ),
    "no value to reach": (
        TUBE,
        {"quantities": [{"name": "a", "kind": "when", "column": "reaction_y", "other": "centroid_y"}]},
        "quantities.0.reaches",
        ("missing", "changes_by"),
    ),
    "two values to reach": (
        TUBE,
        {
            "quantities": [
                {"name": "a", "kind": "when", "column": "time", "other": "time", "reaches": 1.0, "changes_by": 1.0}
            ]
        },
        "quantities.0.changes_by",
        ("together with reaches",),
    ),
    "surface without grains": (
        BEAM_ON_ROW,
        {"quantities": [{"name": "a", "kind": "surface_height"}]},
        "quantities.0.kind",
        ("free grains", "[grains]"),
    ),
    "left of left": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "surface_height", "left": 0.08, "right": 0.02}]},
        "quantities.0.right",
        ("not right of left = 0.08 m",),
    ),
    "flat rectangle": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "packing_fraction", "bottom": 0.1, "top": 0.1}]},
        "quantities.0.top",
        ("not above bottom = 0.1 m",),
    ),
    "beyond a period": (
        changed(GRAINS, {"box.periodic": ["x"]}),
        {"quantities": [{"name": "a", "kind": "surface_height", "left": -0.01}]},
        "quantities.0.right",
        ("more than a period of 0.1 m",),
    ),
    "no top": (
        GRAINS,
        {"quantities": [{"name": "a", "kind": "packing_fraction"}]},
        "quantities.0.top",
        ("missing",),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_quantity_is_refused_in_one_sentence(case: str, tmp_path: Path) -> None:
    require_refusal(BAD[case], tmp_path)


@pytest.fixture(scope="module")
def vibration(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("quantities") / "beam"
    run_scene(load_scene("beam_vibration", QUIET), out=out, threads=1, progress=False)
    return out


def test_frequency_of_the_beam(vibration: Path) -> None:
    """Newmark's mean acceleration slows it by ``(omega dt)^2/12``, and the mesh makes it 3.9e-5 too high."""
    scene = load_scene("beam_vibration")
    (frequency, _) = scene.quantities
    expected = frequency.exact * (1.0 + 3.9e-5 - (math.pi * frequency.exact * scene.time.step) ** 2 / 12)
    # Timoshenko's theory is itself 2e-6 below the plane-strain body
    assert evaluate(frequency, vibration) == pytest.approx(expected, rel=5e-6)


def test_run_tells_and_keeps_its_quantities(vibration: Path) -> None:
    summary = json.loads((vibration / "summary.json").read_text())
    scene = load_scene("beam_vibration")
    assert summary["quantities"] == {q.name: evaluate(q, vibration) for q in scene.quantities}
    text = (vibration / "log.txt").read_text()
    assert "strain_frequency" in text and "Hz     exact 553.461, off by -0.02" in text


def test_finished_run_tells_what_is_asked_now(vibration: Path, capsys: pytest.CaptureFixture[str]) -> None:
    late, end = (f'name="{name}", kind="value", column="time"' for name in ("late", "end"))
    asked = f"quantities=[{{{late}, time=1.0}}, {{{end}}}]"
    run_scene(load_scene("beam_vibration", [*QUIET, asked]), out=vibration, resume=True, threads=1, progress=False)
    told = capsys.readouterr().out
    assert "late" in told and "not known" in told and "strain_frequency" not in told
    assert json.loads((vibration / "summary.json").read_text())["quantities"] == {
        "late": None,
        "end": pytest.approx(0.072, rel=1e-12),
    }
    with pytest.raises(QuantityError, match="late of .* is not known: t = 1 s is outside the run"):
        evaluate(load_scene("beam_vibration", [asked]).quantities[0], vibration)


def test_unfinished_run_has_no_quantities(tmp_path: Path) -> None:
    with pytest.raises(QuantityError, match="there is no finished run in it"):
        evaluate(load_scene("beam_vibration").quantities[0], tmp_path)


def test_number_that_is_not_finite_is_a_sentence(vibration: Path, tmp_path: Path) -> None:
    (tmp_path / "summary.json").write_text("{}")
    (tmp_path / "history.csv").write_text("time [s],rotation [rad]\r\n0.0,0.0\r\n1.0,nan\r\n")
    quantity = load_scene("beam_vibration", ['quantities=[{name="q", kind="max", column="rotation"}]']).quantities[0]
    with pytest.raises(QuantityError, match="rotation has a value that is no finite number"):
        evaluate(quantity, tmp_path)


def test_drop_and_bed_of_falling_discs(tmp_path: Path) -> None:
    """Two discs without contact fall g t^2/2; the bed's numbers are those of their last places."""
    tables = {
        "title": "two discs fall",
        "gravity": [0.0, -10.0],
        "time": {"duration": 0.1, "step": 1e-4},
        "box": {"width": 1.0, "height": 2.0},
        "grains": {
            "sizes": [{"radius": 0.1, "count": 2}],
            "density": 1000.0,
            "layout": "list",
            "positions": [[0.2, 1.0], [0.7, 1.5]],
        },
        "contact": {"normal_stiffness": 1e6},
        "quantities": [
            {"name": "fall", "kind": "drop", "column": "highest_grain"},
            {"name": "when", "kind": "when", "column": "time", "other": "highest_grain", "changes_by": -0.0125},
            {"name": "packing", "kind": "packing_fraction", "bottom": 0.5, "top": 1.45},
            {"name": "angle", "kind": "surface_angle", "left": 0.2, "right": 0.7},
            {"name": "nowhere", "kind": "surface_angle", "left": 0.9, "right": 1.0},
        ],
        "output": {"figures": False, "history_interval": 1e-3},
    }
    scene = Scene.model_validate(tables)
    run_scene(scene, out=tmp_path / "fall", threads=1, progress=False)
    fall, when, packing, angle = (evaluate(quantity, tmp_path / "fall") for quantity in scene.quantities[:4])
    assert fall == pytest.approx(0.05, rel=1e-9)  # the leapfrog is exact for a constant force
    assert when == pytest.approx(0.05, abs=2.5e-6)  # curvature g h^2/8 of a piece over the speed, 0.5 m/s
    assert packing == pytest.approx(1.5 * math.pi * 0.01 / 0.95, rel=1e-9)  # one disc whole, one cut through its centre
    assert angle > 0.0
    assert json.loads((tmp_path / "fall" / "summary.json").read_text())["quantities"]["nowhere"] is None
    with pytest.raises(QuantityError, match="nowhere of .* is not known: no grains lie between x = 0.9 and 1 m"):
        evaluate(scene.quantities[4], tmp_path / "fall")


def test_bed_with_periodic_sides_goes_on_beyond_them(tmp_path: Path) -> None:
    """A disc that has gone through the left side: half of it lies at the right one, and all of it in the box."""
    tables = {
        "title": "a disc crosses a seam",
        "time": {"duration": 0.15, "step": 1e-4},
        "box": {"width": 1.0, "height": 1.0, "walls": [], "periodic": ["x"]},
        "grains": {
            "sizes": [{"radius": 0.1, "count": 1}],
            "density": 1000.0,
            "layout": "list",
            "positions": [[0.15, 0.5, -1.0, 0.0]],
        },
        "contact": {"normal_stiffness": 1e6},
        "quantities": [
            {"name": "all", "kind": "packing_fraction", "top": 1.0},
            {"name": "right", "kind": "packing_fraction", "top": 1.0, "left": 0.5},
            {"name": "height", "kind": "surface_height", "left": 0.9},
        ],
        "output": {"figures": False},
    }
    scene = Scene.model_validate(tables)
    run_scene(scene, out=tmp_path / "seam", threads=1, progress=False)
    whole, right, height = (evaluate(quantity, tmp_path / "seam") for quantity in scene.quantities)
    assert whole == pytest.approx(math.pi * 0.01, rel=1e-9)
    assert right == pytest.approx(math.pi * 0.01, rel=1e-6)  # half of the disc in half of the box
    # the mean of a quarter circle, by places that are 1/20 of a diameter apart and see its vertical end
    assert height == pytest.approx(0.5 + 0.1 * math.pi / 4, abs=1e-3)
