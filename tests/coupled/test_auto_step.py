"""`time.step = "auto"`: the number it stands for, where that is said, and the limits that `leito check` tells."""

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest

from coupled.build import build
from coupled.report.cautions import before
from coupled.report.check import check_scene
from coupled.running.run import run_scene
from coupled.scene import Scene, SceneError, dump_scene, load_scene
from coupled.step import limits_of, with_step
from coupled.templates import write_template
from particles import packing_limit

AUTO = ["time.step=auto", "output.figures=false", "output.frames_per_second=0"]
ROWS: dict[str, Any] = {
    "title": "grains over a row of small ones that overlap, and one alone",
    "gravity": [0.0, -9.81],
    "time": {"duration": 1.0, "step": "auto"},
    "box": {"width": 0.1, "height": 0.2},
    "grains": {
        "sizes": [{"radius": 2e-3, "count": 20}, {"radius": 2.5e-3, "count": 20}],
        "density": 1600.0,
    },
    "rows": [
        {"start": [0.0, -1e-3], "end": [0.1, -1e-3], "count": 101, "radius": 8e-4},
        {"start": [0.05, -0.1], "end": [0.05, -0.1], "count": 1, "radius": 8e-4},
    ],
    "interface": {"per_facet": 3, "boundaries": ["bottom"]},
    "structure": {
        "kind": "rigid",
        "beam": {"length": 0.04, "height": 0.01, "along": 10},
        "placement": {"x": 0.05, "y": 0.19},
        "path": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, -1e-3]]},
    },
    "contact": {"normal_stiffness": 1e6, "normal_damping": 5.0, "tangential_stiffness": 5e4, "friction": 0.5},
    "damping": {"translational": 2.0},
}


@pytest.fixture(scope="module")
def grains(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scene that `leito new grains` writes, and the run of its first 0.2 s with the step left to the model."""
    folder = tmp_path_factory.mktemp("auto")
    write_template("grains", folder / "grains.toml")
    overrides = [*AUTO, "time.duration=0.2", "time.safety=0.9"]
    run_scene(load_scene(folder / "grains.toml", overrides), out=folder / "runs" / "grains", threads=1, progress=False)
    return folder


def test_it_is_the_share_of_the_limit_of_any_packing() -> None:
    """The scene's own grains, one of each kind, have the same limit as all grains of the model that is built."""
    scene = Scene.model_validate(ROWS)
    built = build(scene)
    system = built.model.particles
    assert len(system.grains) == 40 + 31 + 101 + 1
    limit = packing_limit(system.grains, built.contact, damping=system.damping)
    assert system.time_step == built.scene.time.step == pytest.approx(0.8 * limit, rel=1e-12)
    without = {name: table for name, table in ROWS.items() if name != "rows"}
    alone = with_step(Scene.model_validate(without)).time.step
    assert built.scene.time.step < alone, "small ones find more place around a grain"


def test_safety_scales_it_and_a_bed_has_its_own() -> None:
    scene = with_step(load_scene("elastic_tube", ["time.step=auto", "bed.time.step=auto", "bed.time.safety=0.4"]))
    bare = with_step(load_scene("bed", ["time.step=auto"]))
    assert scene.bed.time.step == pytest.approx(0.5 * bare.time.step, rel=1e-12)
    assert bare.time.step > scene.time.step > 0.9 * bare.time.step, "glued grains are smaller than the soil's"
    assert with_step(scene) is scene


def test_everything_downstream_sees_a_number() -> None:
    scene = load_scene("bed", ["time.step=auto", "time.duration=0.5"])
    time = tomllib.loads(dump_scene(scene))["time"]
    assert (time["duration"], time["step"], time["safety"]) == (0.5, "auto", 0.8)
    assert scene.output.checkpoint_interval is None
    known = with_step(scene)
    assert known.time.safety is None and known.output.checkpoint_interval == pytest.approx(0.05)
    assert load_scene("bed", [f"time.step={known.time.step!r}", "time.duration=0.5"]) == known


@pytest.mark.parametrize(
    ("scene", "overrides", "words"),
    [
        ("bed", ["time.step=atuo"], 'time.step = "atuo" must be a number (time step of the grains [s], or "auto"'),
        ("bed", ["time.safety=0.5"], 'time.safety = 0.5 belongs to time.step = "auto"; remove it'),
        ("bed", ["time.step=auto", "time.safety=1.5"], "time.safety = 1.5 must be at most 1"),
        ("bed", ["time.step=auto", "time.safety=0.0"], "time.safety = 0 must be greater than 0"),
        ("winkler_beam", ["time.step=auto"], 'time.step = "auto" needs free grains'),
        ("bed", ["time.step=auto", "time.duration=1e-5"], "is longer than time.duration = 1e-05 s"),
        ("bed", ["time.step=auto", "output.history_interval=1e-6"], "output.history_interval = 1e-06 is shorter"),
    ],
)
def test_refusals(scene: str, overrides: list[str], words: str) -> None:
    with pytest.raises(SceneError) as caught:
        with_step(load_scene(scene, overrides))
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_run_writes_the_number_and_knows_its_scene_again(grains: Path) -> None:
    out = grains / "runs" / "grains"
    written, summary = load_scene(out / "scene.toml"), json.loads((out / "summary.json").read_text())
    assert written.time.step == summary["time_step"] and written.time.safety is None
    assert summary["packing_dt_ratio"] == pytest.approx(0.9, rel=1e-9)
    # the present contacts bear more than any packing: fewer than six to a grain, and not all grains are the smallest
    assert 0.0 < summary["network_dt_ratio"] < 0.9
    again = load_scene(grains / "grains.toml", [*AUTO, "time.duration=0.2", "time.safety=0.9"])
    run_scene(again, out=out, resume=True, threads=1, progress=False)  # the same scene: not refused


def test_check_tells_all_limits(grains: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On the settled bed there is a network, on the lattice there is none yet."""
    monkeypatch.chdir(grains)
    text = '\ntitle = "on it"\n[grains]\nbed = "grains"\n[time]\nduration = 0.1\nstep = "auto"\n'
    (grains / "on.toml").write_text(text)
    bed = ["bed.time.duration=0.2", "bed.time.step=auto", "bed.output.figures=false"]
    scene = load_scene(grains / "on.toml", bed)
    loose = told(scene)
    assert loose["limit of the present contacts"] == ["no contacts yet"]
    assert loose["chosen"][0].endswith("s (auto: 0.8 of the limit of any packing)")
    assert loose["chosen over that"] == ["0.800"]
    run_scene(scene, out=Path("runs/on"), threads=1, progress=False)
    settled = told(scene)
    assert settled["chosen"] == loose["chosen"]
    assert "without dashpots" in settled["limit of the present contacts"][0]
    share = [float(value) for value in settled["chosen over that"]]
    assert share[0] == 0.8 and 0.3 < share[1] < 0.8


def told(scene: Scene) -> dict[str, list[str]]:
    """Rows of the time step, by quantity."""
    found: dict[str, list[str]] = {}
    for section, quantity, value in check_scene(scene):
        if section == "time step":
            found.setdefault(quantity, []).append(value)
    return found


def test_step_above_the_limit_of_its_contacts_is_said() -> None:
    """Three discs pressed together in a row, ``omega_max^2 = 3 k/m``: steps below their limit and above it."""
    tables = {
        "title": "Three discs in a row",
        "time": {"duration": 1.0, "step": 1.05e-4},
        "box": {"width": 0.0119, "height": 0.2, "walls": ["left", "right"]},
        "grains": {
            "sizes": [{"radius": 2e-3, "count": 3}],
            "density": 1600.0,
            "layout": "list",
            "positions": [[2e-3, 0.1], [5.95e-3, 0.1], [9.9e-3, 0.1]],
        },
        "contact": {"normal_stiffness": 1e6},
    }
    built = build(Scene.model_validate(tables))
    limits = limits_of(built.model)
    limit = 2.0 / math.sqrt(3.0 * 1e6 / (math.pi * 2e-3**2 * 1600.0))
    assert limits.network.contacts == 2
    assert limits.of_network == pytest.approx(1.05e-4 / limit, rel=1e-9)
    assert [note for note in before(built) if "source's bound" in note] == before(built)
    faster = build(Scene.model_validate(tables | {"time": {"duration": 1.0, "step": 1.7e-4}}))
    (sentence,) = before(faster)
    assert "times 0.000164 s, the limit of the present contacts" in sentence and "auto" in sentence
