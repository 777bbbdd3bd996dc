"""Loads and schedules in scenes: what is built, what is refused, what a run folder keeps."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from bad_scenes import GONE, TUBE, Case, changed, require_refusal

import structure as fem
from coupled.build import build
from coupled.report.check import check_scene
from coupled.errors import LeitoError
from coupled.report.figures import plot_run
from coupled.output import checkpoint
from coupled.running.run import run_scene
from coupled.scene import Scene, SceneError, dump_scene, load_scene

RING: dict[str, Any] = {
    "title": "a ring under its loads",
    "time": {"duration": 0.02, "step": 1e-3},
    "structure": {
        "kind": "elastic",
        "youngs_modulus": 70e9,
        "poissons_ratio": 0.35,
        "density": 2700.0,
        "tube": {"outer_radius": 0.05, "inner_radius": 0.04},
        "loads": [{"kind": "pressure", "boundary": "inner", "pressure": 1e5}],
    },
    "output": {"history_interval": 1e-3, "frames_per_second": 0.0, "checkpoint_interval": 0.005},
}
FIRST = "structure.loads.0"


def with_schedule(schedule: dict[str, Any]) -> dict[str, Any]:
    return {f"{FIRST}.schedule": schedule}


BAD: dict[str, Case] = {
    "former key": (
        TUBE,
        {f"{FIRST}.ramp_time": 0.5},
        f"{FIRST}.ramp_time",
        ("no longer a key", 'schedule = { kind = "ramp", over = 0.5 }'),
    ),
    "former key without ramp": (TUBE, {f"{FIRST}.ramp_time": 0.0}, f"{FIRST}.ramp_time", ('kind = "constant"',)),
    "unknown schedule": (
        TUBE,
        with_schedule({"kind": "sinus", "frequency": 1.0}),
        f"{FIRST}.schedule.kind",
        ("did you mean 'sine'", "constant, ramp, sine, table"),
    ),
    "schedule without kind": (TUBE, with_schedule({"over": 1.0}), f"{FIRST}.schedule.kind", ("missing", "ramp")),
    "schedule that is a number": (TUBE, {f"{FIRST}.schedule": 0.5}, f"{FIRST}.schedule.kind", ("0.5",)),
    "ramp over nothing": (
        TUBE,
        with_schedule({"kind": "ramp", "over": 0.0}),
        f"{FIRST}.schedule.over",
        ("greater than 0", "[s]"),
    ),
    "ramp with another key": (
        TUBE,
        with_schedule({"kind": "ramp", "ovr": 1.0}),
        f"{FIRST}.schedule.ovr",
        ("'over'", 'together with kind = "ramp"'),
    ),
    "sine without frequency": (TUBE, with_schedule({"kind": "sine"}), f"{FIRST}.schedule.frequency", ("period",)),
    "sine with both": (
        TUBE,
        with_schedule({"kind": "sine", "frequency": 2.0, "period": 0.5}),
        f"{FIRST}.schedule.period",
        ("keep one",),
    ),
    "table of one row": (
        TUBE,
        with_schedule({"kind": "table", "times": [0.0], "factors": [1.0]}),
        f"{FIRST}.schedule.times",
        ("at least 2",),
    ),
    "table without factors": (
        TUBE,
        with_schedule({"kind": "table", "times": [0.0, 1.0]}),
        f"{FIRST}.schedule.factors",
        ("missing", "file"),
    ),
    "table of unequal columns": (
        TUBE,
        with_schedule({"kind": "table", "times": [0.0, 1.0], "factors": [0.0, 1.0, 2.0]}),
        f"{FIRST}.schedule.factors",
        ("3 numbers", "the 2 times"),
    ),
    "table that goes back": (
        TUBE,
        with_schedule({"kind": "table", "times": [0.0, 1.0, 1.0], "factors": [0.0, 1.0, 2.0]}),
        f"{FIRST}.schedule.times.2",
        ("later than 1 s",),
    ),
    "table from both": (
        TUBE,
        with_schedule({"kind": "table", "file": "load.csv", "times": [0.0, 1.0], "factors": [0.0, 1.0]}),
        f"{FIRST}.schedule.file",
        ("keep one",),
    ),
    "table from an absent file": (
        TUBE,
        with_schedule({"kind": "table", "file": "load.csv"}),
        f"{FIRST}.schedule.file",
        ("cannot be read", "beside the scene"),
    ),
    "pressure on a boundary of another shape": (
        TUBE,
        {FIRST.rpartition(".")[0]: [{"kind": "pressure", "boundary": "top", "pressure": 1.0}]},
        f"{FIRST}.boundary",
        ("inner", "loaded_arc", "free_arc"),
    ),
    "pressure that follows a body that the theory does not": (
        TUBE,
        {FIRST.rpartition(".")[0]: [{"kind": "pressure", "boundary": "inner", "pressure": 1.0, "follows": True}]},
        f"{FIRST}.follows",
        ("true", 'structure.theory = "corotational"', "follows = false"),
    ),
    "pressure without size": (
        TUBE,
        {FIRST.rpartition(".")[0]: [{"kind": "pressure", "boundary": "inner"}]},
        f"{FIRST}.pressure",
        ("missing", "[Pa]"),
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_loads_are_refused(name: str, tmp_path: Path) -> None:
    require_refusal(BAD[name], tmp_path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time,factor\n0,0\n1.0,abc\n", ('"abc" in line 3', "no finite number")),
        ("0,0\n\n# a remark\n1.0,\n", ('"" in line 4',)),
        ("0,0\n1,nan\n", ('"nan" in line 2',)),
        ("0,0\n2,1\n1.5,1\n", ("1.5 s in line 3 after 2 s",)),
        ("0\n1\n", ("1 column in line 1", "two columns")),
        ("0,0,0\n1,1,1\n", ("3 columns in line 1",)),
        ("0;0\n1;1\n", ("1 column in line 1", "with a comma between them")),
        ("time,factor\n0,1\n", ("1 row of numbers", "at least 2")),
        ("", ("0 rows of numbers",)),
        (b"\xff\xfe0,1", ("cannot be read", "UTF-8")),
    ],
)
def test_bad_tables_are_refused_with_their_line(text: str | bytes, words: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    spoiled = with_schedule({"kind": "table", "file": "load.csv"})
    require_refusal((TUBE, spoiled, f"{FIRST}.schedule.file", ('"load.csv"', *words)), tmp_path)


def written(folder: Path, loads: list[dict[str, Any]], **changes: Any) -> Path:
    """A scene file of the ring under loads."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "ring.toml"
    path.write_text(tomli_w.dumps(changed(RING, {"structure.loads": loads, **changes})))
    return path


def test_a_table_becomes_part_of_the_scene(tmp_path: Path) -> None:
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "load.csv").write_text("\ufefftime [s], factor\n0.0, 0.0\n0.5, 2.0 # top\n\n1e0, -1\n")
    schedule = {"kind": "table", "file": "tables/load.csv"}
    path = written(tmp_path, [{"kind": "body", "acceleration": [0.0, 1.0], "schedule": schedule}])
    scene = load_scene(path)
    resolved = tomllib.loads(dump_scene(scene))["structure"]["loads"][0]["schedule"]
    assert resolved == {"kind": "table", "times": [0.0, 0.5, 1.0], "factors": [0.0, 2.0, -1.0]}
    elsewhere = tmp_path / "elsewhere.toml"
    elsewhere.write_text(dump_scene(scene))
    (tmp_path / "tables" / "load.csv").unlink()
    assert load_scene(elsewhere) == scene
    with pytest.raises(SceneError, match="cannot be read"):
        load_scene(path)
    constant = load_scene(path, [f'{FIRST}.schedule={{kind="constant"}}'])
    assert constant.structure.loads[0].schedule.kind == "constant"


def test_a_file_is_for_scene_files(tmp_path: Path) -> None:
    tables = changed(RING, with_schedule({"kind": "table", "file": "load.csv"}))
    with pytest.raises(SceneError, match="where a scene file is loaded"):
        Scene.model_validate(tables)


def test_every_load_pushes_as_its_schedule_says(tmp_path: Path) -> None:
    """Resultant of the loads of a scene at 20 times against the sums done here."""
    loads = [
        {"kind": "body", "acceleration": [0.0, -9.81], "schedule": {"kind": "constant"}},
        {
            "kind": "boundary",
            "boundary": "free_arc",
            "total_force": [2.0, 0.0],
            "schedule": {"kind": "ramp", "over": 0.01},
        },
        {"kind": "point", "point": [0.045, 0.0], "force": [0.0, 5.0], "schedule": {"kind": "sine", "period": 0.02}},
        {
            "kind": "pressure",
            "boundary": "loaded_arc",
            "pressure": 10.0,
            "schedule": {"kind": "table", "times": [0.0, 0.01], "factors": [1.0, 3.0]},
        },
        {"kind": "pressure", "boundary": "inner", "pressure": 1e3},
    ]
    body = build(load_scene(written(tmp_path, loads))).model.structure
    chord = 2 * 0.05 * np.sin(np.pi / 3)
    for _ in range(20):
        t = body.time
        expected = [
            2.0 * min(t / 0.01, 1.0),
            -9.81 * body.mass + 5.0 * np.sin(2 * np.pi * t / 0.02) - 10.0 * chord * np.interp(t, [0, 0.01], [1, 3]),
        ]
        np.testing.assert_allclose(body.external_force(), expected, atol=1e-9)
        body.advance(np.zeros_like(body.polyline.points))


def test_check_names_the_loads(tmp_path: Path) -> None:
    loads = [
        {"kind": "pressure", "boundary": "inner", "pressure": 1e5, "schedule": {"kind": "sine", "frequency": 50.0}},
        {"kind": "point", "point": [0.05, 0.0], "force": [0.0, 5.0]},
    ]
    said = [row[1:] for row in check_scene(load_scene(written(tmp_path, loads))) if row[0] == "loads"]
    assert said == [
        ("pressure on inner", "100000 Pa, sine of 50 Hz"),
        ("at 0.05, 0 m from the centroid", "0, 5 N/m, constant"),
    ]


def test_check_says_what_the_step_does_not_resolve(tmp_path: Path) -> None:
    rows = {"kind": "table", "times": [0.0, 0.0005, 0.01], "factors": [0.0, 1.0, 0.0]}
    loads = [
        {"kind": "body", "acceleration": [0.0, 1.0], "schedule": {"kind": "sine", "period": 0.01}},
        {"kind": "body", "acceleration": [0.0, 1.0], "schedule": rows},
        {"kind": "body", "acceleration": [0.0, 1.0], "schedule": {"kind": "sine", "period": 0.021}},
    ]
    notes = [text for section, _, text in check_scene(load_scene(written(tmp_path, loads))) if section == "note"]
    assert [note.partition(":")[0] for note in notes] == ["structure.loads.0", "structure.loads.1"]
    assert "10 steps a period" in notes[0] and "0.0005 s apart" in notes[1]


def test_a_run_with_a_table_is_resumed_without_its_file(tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_text("0,0\n0.004,1\n0.016,-1\n")
    schedule = {"kind": "table", "file": "load.csv"}
    following = RING["structure"]["loads"][0] | {"follows": True}
    loads = [{"kind": "body", "acceleration": [0.0, 1.0], "schedule": schedule}, following]
    path = written(tmp_path, loads, **{"structure.theory": "corotational", "time.step": 1e-4})
    whole = run_scene(load_scene(path), out=tmp_path / "whole", threads=1, progress=False)
    part = run_scene(load_scene(path, ["time.duration=0.01"]), out=tmp_path / "part", threads=1, progress=False)
    (tmp_path / "load.csv").unlink()
    again = load_scene(part / "scene.toml", ["time.duration=0.02"])
    (part / "summary.json").unlink()
    run_scene(again, out=part, resume=True, threads=1, progress=False)
    left, right = (checkpoint.load(folder / "checkpoint.h5")[0] for folder in (whole, part))
    for name in left.keys() - {"run.seconds"}:
        np.testing.assert_array_equal(left[name], right[name], err_msg=name)
    assert plot_run(part)


def test_a_run_is_not_resumed_with_another_table(tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_text("0,0\n0.004,1\n")
    path = written(
        tmp_path, [{"kind": "body", "acceleration": [0.0, 1.0], "schedule": {"kind": "table", "file": "load.csv"}}]
    )
    run_scene(load_scene(path), out=tmp_path / "run", threads=1, progress=False)
    (tmp_path / "load.csv").write_text("0,0\n0.004,2\n")
    with pytest.raises(LeitoError, match="schedule.factors"):
        run_scene(load_scene(path), out=tmp_path / "run", resume=True, threads=1, progress=False)


@pytest.mark.parametrize("kind", ["corotational", "large_strain", "free_rigid"])
def test_a_pressure_follows_what_the_scene_turns(kind: str, tmp_path: Path) -> None:
    """The push on the upper arc stays square to it while a pair of forces turns the tube."""
    pair = [{"kind": "point", "point": [x, 0.0], "force": [0.0, 2e3 * x]} for x in (0.05, -0.05)]
    load = {"kind": "pressure", "boundary": "loaded_arc", "pressure": 100.0, "follows": True}
    own = {"structure.theory": kind}
    if kind == "free_rigid":
        own = {"structure.kind": kind, "structure.youngs_modulus": GONE, "structure.poissons_ratio": GONE}
    body = build(load_scene(written(tmp_path, [load, *pair], **own))).model.structure
    for _ in range(60):
        body.advance(np.zeros_like(body.polyline.points))
    angle, push = body.mean_rotation(), 100.0 * 2 * 0.05 * np.sin(np.pi / 3)
    assert angle > 0.5
    # the ring under its pair of forces is no circle: by the strain, 1e-5
    np.testing.assert_allclose(body.external_force(), push * np.array([np.sin(angle), -np.cos(angle)]), rtol=1e-4)


def test_the_pulsing_tube_breathes_as_lame_says() -> None:
    """Lame's ``u = (1 + nu)/E ((1 - 2 nu) A b + B/b)``, ``A = p a^2/(b^2 - a^2)``, ``B = A b^2``, times the sine."""
    inner, outer, pressure, young, poisson = 0.04, 0.05, 1e6, 70e9, 0.35
    in_plane = pressure * inner**2 / (outer**2 - inner**2)
    grown = (1 + poisson) / young * ((1 - 2 * poisson) + 1.0) * in_plane * outer
    model = build(load_scene("pulsing_tube")).model
    for factor in (1.0, 0.0, -1.0, 0.0, 1.0):
        model.advance(125)
        body = model.structure
        seen = np.sum(body.boundary_displacement * body.polyline.points, axis=1) / outer
        # The sine sets in with a slope: it rings at 18 kHz with 100 Hz/18 kHz = 0.6 %; the mesh gives 0.3 % less.
        np.testing.assert_allclose(seen, factor * grown, atol=0.01 * grown)
    assert abs(body.mean_rotation()) < 1e-12


def test_points_count_from_the_centroid(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        [{"kind": "point", "point": [0.0, 0.045], "force": [1.0, 0.0]}],
        **{"structure.placement": {"x": 3.0, "y": 2.0}},
    )
    body = build(load_scene(path)).model.structure
    assert isinstance(body, fem.ElasticStructure)
    load = {"kind": "point", "point": [0.0, 0.0], "force": [1.0, 0.0]}
    off = written(tmp_path, [load], **{"structure.placement": {"x": 3.0, "y": 2.0}})
    with pytest.raises(LeitoError, match=r"structure.loads.0.point = \[0.0, 0.0\] from the centroid, .* off the mesh"):
        build(load_scene(off))


def test_points_count_from_the_middle_of_a_tube_of_odd_facets(tmp_path: Path) -> None:
    """Its box is not about its middle: a node below, a facet above. Force times arm is the moment."""
    load = {"kind": "point", "point": [0.0, 0.045], "force": [1.0, 0.0]}
    rigid = {"structure.kind": "free_rigid", "structure.youngs_modulus": GONE, "structure.poissons_ratio": GONE}
    path = written(tmp_path, [load], **rigid, **{"structure.tube.around": 7})
    body = build(load_scene(path)).model.structure
    body.advance(np.zeros_like(body.polyline.points))
    # at rest at first: half the square of the step
    assert body.mean_rotation() == pytest.approx(-0.045 / body.inertia * body.time_step**2 / 2, rel=1e-6)
