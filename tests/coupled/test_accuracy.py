"""Presets: what goes before what, that they are numerical alone, that steps stay inside the limits, and their runs."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from bad_scenes import GRAINS, TUBE, Case, changed, require_refusal

from coupled.build import build
from coupled.ensemble.samples import samples_of
from coupled.errors import LeitoError
from coupled.limits_before import coupling_limit_of, settled_limit_of
from coupled.output import checkpoint
from coupled.quantities import evaluate
from coupled.report.check import check_scene
from coupled.running.run import run_scene
from coupled.scene import Scene, SceneError, dump_scene, load_scene, shipping_scenes
from coupled.step import with_step

QUIET = ["output.figures=false", "output.frames_per_second=0"]
PRESETS = ("draft", "standard", "reference")
BED: dict[str, Any] = changed(GRAINS, {"grains.sizes": [{"radius": 2e-3, "count": 2400}], "box.height": 1.2})


def given(folder: Path, tables: dict[str, Any], *sets: str, accuracy: str | None = None) -> Scene:
    (folder / "scene.toml").write_text(tomli_w.dumps(tables))
    return load_scene(folder / "scene.toml", sets, accuracy=accuracy)


def test_key_in_the_file_goes_before_a_preset_in_the_file(tmp_path: Path) -> None:
    scene = given(tmp_path, changed(BED, {"accuracy": "draft", "grains.coarsening": 1.5}))
    assert scene.time.step == 1e-5 and scene.grains.coarsening == 1.5
    assert scene.preset.gives == () and scene.preset.by_hand == ("time.step", "grains.coarsening")
    left = given(tmp_path, changed(BED, {"accuracy": "draft", "time.step": "auto"}))
    assert left.time.step_fraction == 0.9 and left.time.safety is None and left.grains.coarsening == 2.0
    assert left.preset.by_hand == () and left.accuracy is None


def test_preset_of_the_command_line_goes_before_the_file(tmp_path: Path) -> None:
    tables = changed(BED, {"accuracy": "reference", "grains.coarsening": 1.5})
    scene = given(tmp_path, tables, accuracy="draft")
    assert (scene.time.step, scene.time.step_fraction, scene.grains.coarsening) == ("auto", 0.9, 2.0)
    assert scene.preset.name == "draft" and scene.preset.by_hand == ()
    assert given(tmp_path, tables, "accuracy=draft") == scene
    standard = given(tmp_path, tables, accuracy="standard")
    assert standard.time.step == 1e-5 and standard.grains.coarsening == 1.0
    safe = given(tmp_path, changed(BED, {"time.step": "auto", "time.safety": 0.5}), accuracy="draft")
    assert safe.time.safety is None and safe.time.step_fraction == 0.9


def test_set_goes_before_all(tmp_path: Path) -> None:
    step = given(tmp_path, BED, "time.step=2e-6", accuracy="draft")
    assert step.time.step == 2e-6 and step.time.step_fraction is None and step.grains.coarsening == 2.0
    assert step.preset.by_hand == ("time.step",) and step.preset.gives == ("grains.coarsening = 2",)
    share = given(tmp_path, BED, "time.step_fraction=0.5", accuracy="draft")
    assert (share.time.step, share.time.step_fraction) == ("auto", 0.5)
    assert share.preset.by_hand == ("time.step_fraction",)
    table = given(tmp_path, BED, "time={duration=0.5, step=2e-6}", accuracy="draft")
    assert table.time.step == 2e-6 and table.preset.by_hand == ("time.step",)


def test_bed_of_a_file_of_its_own_follows(tmp_path: Path) -> None:
    scene = load_scene("elastic_tube", accuracy="draft")
    assert scene.bed.time.step == "auto" and scene.bed.time.step_fraction == 0.9
    assert scene.bed.preset is None and load_scene("elastic_tube").bed == load_scene("bed")
    by_hand = load_scene("elastic_tube", ["grains.coarsening=1.5", "bed.time.step=2e-5"], accuracy="draft")
    assert by_hand.bed.time.step == 2e-5 and by_hand.preset.by_hand == ("grains.coarsening",)
    assert load_scene("elastic_tube", accuracy="reference").bed == load_scene("bed")


@pytest.mark.parametrize("name", shipping_scenes())
@pytest.mark.parametrize("preset", PRESETS)
def test_presets_leave_the_physics_alone(name: str, preset: str) -> None:
    """Grains may stand for several and have their dashpots; whatever else is not mesh, step or exchange is the same."""
    before, after = (with_step(load_scene(name, accuracy=a)).model_dump() for a in (None, preset))
    for law in ("friction", "rolling_friction", "normal_stiffness", "tangential_stiffness", "restitution", "recipe"):
        assert (before["contact"] or {}).get(law) == (after["contact"] or {}).get(law)
    for key in ("units", "gravity", "box", "damping", "intruders", "quantities", "output.history_interval"):
        first, second = before, after
        for part in key.split("."):
            first, second = first[part], second[part]
        assert first == second, key
    if before["structure"] is not None:
        mesh = {"tube", "beam"}
        assert all(before["structure"][key] == after["structure"][key] for key in before["structure"].keys() - mesh)
    assert before["time"]["duration"] == after["time"]["duration"]


@pytest.mark.parametrize("name", shipping_scenes())
@pytest.mark.parametrize("preset", PRESETS)
def test_steps_stay_inside_the_limits(name: str, preset: str) -> None:
    scene = with_step(load_scene(name, accuracy=preset))
    if scene.first_grains is None:
        return
    share = {"draft": 0.9, "standard": 1.0, "reference": 0.25}[preset]
    step = scene.time.step
    assert step <= share * settled_limit_of(scene) * (1 + 1e-9)
    assert step <= share * coupling_limit_of(scene, step) * (1 + 1e-9)
    if scene.bed is not None:
        assert scene.bed.time.step <= settled_limit_of(scene.bed)


@pytest.mark.parametrize("name", [name for name in shipping_scenes() if name != "bed_million"])
@pytest.mark.parametrize("preset", ["draft", "reference"])
def test_every_scene_passes_a_check(name: str, preset: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A million grains are left out for their time; but for their number they are those of `bed`.

    On one core: the compiled code for threads is tested elsewhere, and takes long to compile for every scene.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    rows = {(section, quantity): value for section, quantity, value in check_scene(load_scene(name, accuracy=preset))}
    assert rows["accuracy", "preset"] == preset
    ratio = [quantity for section, quantity in rows if section == "interface" and quantity.startswith("stiffness")]
    for quantity in ratio:
        assert float(rows["interface", quantity]) <= float(quantity.rpartition(" ")[2].rstrip(")"))


def small_tube() -> dict[str, Any]:
    return changed(TUBE, {"time.duration": 4e-3, "time.step": 1e-6, "output": {"history_interval": 1e-3}})


@pytest.mark.parametrize("preset", ["draft", "reference"])
def test_run_with_a_preset_is_resumed_to_the_same_bits(preset: str, tmp_path: Path) -> None:
    def scene(*sets: str, accuracy: str = preset) -> Scene:
        return given(tmp_path, small_tube(), *QUIET, *sets, accuracy=accuracy)

    half, whole = tmp_path / "half", tmp_path / "whole"
    run_scene(scene("time.duration=2e-3"), out=half, threads=1, progress=False)
    other = "reference" if preset == "draft" else "draft"
    with pytest.raises(LeitoError, match=f"preset.name = {other} differs from {preset}"):
        run_scene(scene(accuracy=other), out=half, resume=True, threads=1, progress=False)
    run_scene(scene(), out=half, resume=True, threads=1, progress=False)
    run_scene(scene(), out=whole, threads=1, progress=False)
    states = [checkpoint.load(folder / checkpoint.NAME)[0] for folder in (half, whole)]
    for key in states[1].keys() - {"run.seconds"}:
        np.testing.assert_array_equal(states[0][key], states[1][key], err_msg=key)
    summary = json.loads((whole / "summary.json").read_text())
    assert summary["accuracy"]["name"] == preset and f"accuracy {preset}: " in (whole / "log.txt").read_text()
    assert load_scene(whole / "scene.toml") == with_step(scene())


@pytest.mark.parametrize(
    ("name", "quantity"), [("beam_vibration", "strain_frequency"), ("pulsing_tube", "strain_energy")]
)
def test_errors_against_closed_forms_fall_from_draft_to_reference(name: str, quantity: str, tmp_path: Path) -> None:
    """Order 2 in mesh and step: a quarter each time one of them is halved, a sixteenth of the step's part here."""
    errors = {}
    for preset in PRESETS:
        scene = load_scene(name, QUIET, accuracy=preset)
        run_scene(scene, out=tmp_path / preset, threads=1, progress=False)
        (wanted,) = (one for one in scene.quantities if one.name == quantity)
        errors[preset] = abs(evaluate(wanted, tmp_path / preset) - wanted.exact)
    assert errors["reference"] < 0.3 * errors["standard"], errors
    if name == "beam_vibration":  # the other's mesh is the same in draft, and its step does not matter
        assert errors["standard"] < 0.3 * errors["draft"], errors


def test_reference_step_is_a_share_of_the_draft_step(tmp_path: Path) -> None:
    built = [build(given(tmp_path, small_tube(), accuracy=preset)) for preset in ("draft", "reference")]
    assert built[0].scene.interface.exchange == "predicted" and built[1].scene.interface.exchange == "iterated"
    assert built[1].scene.structure.tube.around == 2 * built[0].scene.structure.tube.around
    assert built[1].scene.time.step < 0.3 * settled_limit_of(built[1].scene)


def test_ensembles_take_presets_as_one_key_more(tmp_path: Path) -> None:
    samples = samples_of("bed", 2, vary=["accuracy=draft,reference"], overrides=["grains.seed=3"], out=tmp_path)
    assert [sample.task.scene.preset.name for sample in samples] == ["draft", "draft", "reference", "reference"]
    assert [sample.task.scene.grains.seed for sample in samples] == [3, 4, 3, 4]


BAD: dict[str, Case] = {
    "unknown preset": (GRAINS, {"accuracy": "drafty"}, "accuracy", ("is no preset", "did you mean 'draft'")),
    "preset that is no word": (GRAINS, {"accuracy": 3}, "accuracy", ("is no preset",)),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_preset_is_refused_in_one_sentence(case: str, tmp_path: Path) -> None:
    require_refusal(BAD[case], tmp_path)


def test_preset_is_not_taken_twice(tmp_path: Path) -> None:
    """A scene that a run has written has the numbers of its preset."""
    (tmp_path / "resolved.toml").write_text(dump_scene(with_step(load_scene("bed", accuracy="draft"))))
    with pytest.raises(SceneError, match='accuracy = "draft" is asked of a scene that a run has written'):
        load_scene(tmp_path / "resolved.toml", accuracy="draft")
    with pytest.raises(SceneError, match="is read at the top of a scene file"):
        Scene.model_validate(GRAINS | {"accuracy": "draft"})
