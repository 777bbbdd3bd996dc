"""Studies of small scenes, run: a known order, chance, knobs of speed, stopping and going on, refusals."""

from __future__ import annotations

import csv
import math
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import tomli_w
from held_leito import held_leito, wait_until

from coupled.errors import LeitoError
from coupled.scene import Scene
from coupled.study import study as study_module
from coupled.study.judging.errors import observed_order
from coupled.study.settings.ask import knob_values, reference_keys
from coupled.study.settings.cost import Trial
from coupled.study.study import Wishes, run_study

BEAM = {
    "title": "a beam that swings",
    "time": {"duration": 0.0216, "step": 3.6e-5},
    "structure": {
        "kind": "elastic",
        "youngs_modulus": 70e9,
        "poissons_ratio": 0.35,
        "density": 2700.0,
        "beam": {"length": 1.0, "height": 0.05, "along": 8, "across": 1, "order": 2},
        "initial": {"mode": 1, "amplitude": 1e-3},
    },
    "output": {"history_interval": 1.44e-4},
    "quantities": [{"name": "frequency", "kind": "frequency", "column": "structure_strain"}],
}
HEAP = {
    "title": "a few grains fall",
    "gravity": [0.0, -9.81],
    "time": {"duration": 0.25, "step": 4e-5},
    "box": {"width": 0.04, "height": 0.3},
    "grains": {
        "sizes": [{"radius": 2.0e-3, "count": 40}, {"radius": 1.6e-3, "count": 40}],
        "density": 1600.0,
        "jitter": 0.5,
    },
    "contact": {"normal_stiffness": 1e6, "normal_damping": 60.0, "tangential_stiffness": 5e4, "friction": 0.5},
    "quantities": [{"name": "height", "kind": "surface_height"}],
}


def study(folder: Path, scene: dict, **wishes):
    """Run a study and return it with its rows by setting."""
    path = folder / "scene.toml"
    path.write_text(tomli_w.dumps(scene))
    done = run_study(path, Wishes(**wishes), out=folder / "study", progress=False, say=lambda sentence: None)
    with open(folder / "study" / "study.csv", newline="") as file:
        return done, {row["setting"]: row for row in csv.DictReader(file)}


@pytest.fixture(scope="module")
def beam(tmp_path_factory):
    folder = tmp_path_factory.mktemp("beam")
    wishes = {"values": {"step": (4.0, 2.0, 0.5, 1e5)}, "reference": ("time.step=4.5e-6",)}
    return folder, *study(folder, BEAM, knobs=("step",), **wishes)


def swung(step: float, frequency: float) -> float:
    """Frequency of a mode in the trapezoidal rule, ``atan(omega dt/2)/(pi dt)`` [Hz]; its energy has twice that."""
    return 2.0 * math.atan(math.pi * frequency * step) / (math.pi * step)


def test_the_table_shows_the_order_and_the_error_of_newmark_s_scheme(beam):
    _, done, rows = beam
    values = {name: float(row["value"]) for name, row in rows.items() if row["value"]}
    steps = {"step = 2": 7.2e-5, "as it is": 3.6e-5, "step = 0.5": 1.8e-5}
    order = observed_order([(steps[name], values[name]) for name in steps])
    assert order == pytest.approx(2.0, abs=0.1)
    true = math.tan(math.pi * 4.5e-6 * values["finest"] / 2.0) / (math.pi * 4.5e-6)
    for name, factor in (("step = 4", 4.0), ("step = 2", 2.0), ("step = 0.5", 0.5)):
        # what a fit to samples of 12 oscillations leaves, and other modes: far below the errors, 5e-3 to 8e-5
        assert values[name] == pytest.approx(swung(3.6e-5 * factor, true), rel=1e-5)
    assert float(rows["step = 4"]["error"]) == pytest.approx(values["step = 4"] / values["finest"] - 1.0, rel=1e-9)
    assert done.judged["frequency"][0].ran.same_bits is None


def test_settings_of_equal_numbers_are_one_run(beam):
    """The preset "draft" of a structure alone is twice the step, "standard" the scene as it is."""
    _, _, rows = beam
    for preset, same in (("draft", "step = 2"), ("standard", "as it is")):
        for column in ("value", "wall_s"):
            assert rows[f"accuracy = {preset}"][column] == rows[same][column]


def test_a_setting_that_is_refused_is_a_row_and_not_the_end(beam):
    folder, done, rows = beam
    assert rows["step = 100000"]["status"] == "refused" and "time.step" in rows["step = 100000"]["message"]
    text = (folder / "study" / "study.md").read_text()
    assert "order 2.0" in text or "order 1.9" in text
    assert (folder / "study" / "pareto_frequency.png").stat().st_size > 10_000
    assert "left out" not in text


def test_work_done_is_reused_and_a_further_value_added(beam):
    folder, _, before = beam
    made = {path: path.stat().st_mtime_ns for path in (folder / "study" / "runs").glob("*/summary.json")}
    assert len(made) == 6  # those of the step, and the preset "reference": the other two are among them
    with pytest.raises(LeitoError, match="holds a study already; go on with --resume"):
        run_study(folder / "scene.toml", Wishes(knobs=("step",)), out=folder / "study", progress=False)
    again = run_study(
        folder / "scene.toml",
        Wishes(knobs=("step",), values={"step": (4.0, 3.0)}, reference=("time.step=4.5e-6",)),
        out=folder / "study", resume=True, progress=False, say=lambda sentence: None,
    )  # fmt: skip
    assert all(path.stat().st_mtime_ns == moment for path, moment in made.items())
    assert len(list((folder / "study" / "runs").glob("*/summary.json"))) == 7
    values = {item.setting.name: item.value for item in again.judged["frequency"]}
    assert values["step = 4"] == float(before["step = 4"]["value"]) and "step = 3" in values


def test_chance_is_told_from_error_and_threads_change_nothing(tmp_path):
    """The height of a heap depends on the seed; the step has no effect that three seeds could resolve."""
    wishes = {"knobs": ("step", "threads"), "values": {"step": (0.5,), "threads": (2,)}, "seeds": 3}
    done, rows = study(tmp_path, HEAP, reference=("time.step=1e-5",), **wishes)
    by_name = {item.setting.name: item for item in done.judged["height"]}
    base = by_name["as it is"].ran
    assert len(set(base.values["height"])) == 3
    assert by_name["threads = 2"].ran.values == base.values and rows["threads = 2"]["same_bits"] == "True"
    assert by_name["step = 0.5"].ran.values != base.values
    assert rows["step = 0.5"]["verdict"] == "not resolved"
    assert float(rows["step = 0.5"]["half_width"]) > 0.0
    assert "not resolved, from fast to slow: " in (tmp_path / "study" / "study.md").read_text()


@pytest.mark.parametrize(("wish", "code"), [(signal.SIGKILL, -9), (signal.SIGINT, 130)])
def test_a_study_that_is_ended_goes_on_where_it_was(wish, code, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(tomli_w.dumps(BEAM | {"output": BEAM["output"] | {"checkpoint_interval": 1.44e-3}}))
    command = [
        "study", str(path), "--values", "step=4",
        "--jobs", "1", "--reference", "time.step=9e-6", "--out", str(tmp_path / "study"), "--no-progress",
    ]  # fmt: skip
    runs = tmp_path / "study" / "runs"
    process = held_leito(command, at=0.01, after=1, start_new_session=True)
    wait_until(lambda: len(list(runs.glob("*/checkpoint.h5"))) == 2, process)
    process.send_signal(wish)
    said = process.communicate(timeout=300)[1]
    assert process.returncode == code, said
    assert code < 0 or "the study is stopped; go on with --resume" in said
    moments = {summary: summary.stat().st_mtime_ns for summary in runs.glob("*/summary.json")}
    assert len(moments) == 1 and not (tmp_path / "study" / "study.csv").exists()
    again = subprocess.run(
        [sys.executable, "-m", "coupled.cli", *command, "--resume"], capture_output=True, text=True, timeout=300
    )
    assert again.returncode == 0, again.stderr
    assert all(path.stat().st_mtime_ns == moment for path, moment in moments.items())
    assert len(list(runs.glob("*/summary.json"))) == 5
    lines = again.stdout.splitlines()
    assert any(line.startswith("study of 6 settings") for line in lines) and "step = 4" in again.stdout


def test_a_study_under_mpirun_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
    with pytest.raises(LeitoError, match="start it without mpirun"):
        study(tmp_path, BEAM)


def without_quantities(scene):
    return {key: value for key, value in scene.items() if key != "quantities"}


@pytest.mark.parametrize(
    ("scene", "wishes", "words"),
    [
        (without_quantities(BEAM), {}, "names no quantities"),
        (BEAM, {"knobs": ("stp",)}, "did you mean 'step'"),
        (BEAM, {"knobs": ("rolling",)}, "this scene has no rolling to turn"),
        (BEAM, {"seeds": 3}, "--seeds 3: the scene lays no grains out by chance"),
        (HEAP, {"seeds": 0}, "--seeds 0: must be at least 1"),
        (BEAM, {"budget": 1e-9}, "--budget 1e-09: the scene as it is and its reference alone take"),
        (BEAM, {"reference": ("time.stp=1e-6",)}, "time.stp is not a known key"),
        (BEAM, {"overrides": ("time.stp=1e-6",)}, "time.stp is not a known key"),
    ],
)
def test_refusals(scene, wishes, words, tmp_path):
    with pytest.raises(LeitoError, match=words.replace("(", r"\(")):
        study(tmp_path, scene, **wishes)
    assert not (tmp_path / "study" / "runs").exists()


def test_a_study_that_goes_on_with_another_scene_is_timed_anew(tmp_path, monkeypatch):
    tried: list[float] = []

    def try_out(scene):
        tried.append(scene.time.duration)
        return Trial(seconds=scene.time.duration, grains=0.0, structure=1.0)

    monkeypatch.setattr(study_module, "try_out", try_out)
    short, longer = (Scene.model_validate(BEAM | {"time": BEAM["time"] | {"duration": t}}) for t in (0.0216, 0.216))
    for scene in (short, short, longer):
        assert study_module._trial(scene, tmp_path).seconds == scene.time.duration
    assert tried == [0.0216, 0.216]


def test_after_a_budget_that_was_too_small_nothing_is_in_the_way(tmp_path):
    for _ in range(2):  # the second time it is refused for the same reason
        with pytest.raises(LeitoError, match="--budget 1e-06: the scene as it is and its reference alone take"):
            study(tmp_path, BEAM, knobs=(), budget=1e-6)


def test_a_file_in_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / "study").write_text("")
    with pytest.raises(LeitoError, match="study is a file; give another folder"):
        study(tmp_path, BEAM)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("step", "write it as knob=a,b,c"),
        ("step=", "write it as knob=a,b,c"),
        ("stepp=1", "did you mean 'step'"),
        ("step=a", "'a' is no value of step; give numbers above 0"),
        ("step=-1", "'-1' is no value of step; give numbers above 0"),
        ("substeps=1.5", "'1.5' is no value of substeps; give whole numbers above 0"),
        ("exchange=laged", "did you mean 'lagged'"),
    ],
)
def test_values_that_are_refused(text, words):
    with pytest.raises(LeitoError) as refused:
        knob_values([text])
    assert words in str(refused.value)


def test_a_reference_that_is_no_key_is_told_by_its_own_option():
    with pytest.raises(LeitoError, match="--reference step: write it as key=value"):
        reference_keys(["time.step=1e-6", "step"])


def test_values_of_one_knob_are_given_once():
    assert knob_values(["step=2,1", "exchange=lagged"]) == {"step": (2.0, 1.0), "exchange": ("lagged",)}
    with pytest.raises(LeitoError, match="step is given twice"):
        knob_values(["step=2", "step=1"])
