"""Scenes with shaken walls, intruders, periodic sides and spread sizes: what is built, written and taken up again."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bad_scenes import GONE, PERIODIC, SHAKEN, changed
from same_run import assert_same_run

from coupled.balance import take_balance
from coupled.build import build
from coupled.measuring.record import Record
from coupled.measuring.rises import height_over_floor
from coupled.output.history import History, read_history
from coupled.report import cautions
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene
from coupled.step import with_step

WIDTH, RHO = 12.0, 1.0 / np.pi
FEW: dict[str, Any] = {
    "title": "a few grains and an intruder on a shaken floor",
    "units": "dimensionless",
    "gravity": [0.0, -1.0],
    "time": {"duration": 8.0, "step": 2e-3},
    "box": {"width": WIDTH, "height": 40.0, "periodic": ["x"]},
    "grains": {"sizes": [{"radius": 0.5, "spread": 0.1, "count": 60}], "density": RHO, "jitter": 0.5},
    "intruders": [{"radius": 1.5, "density": RHO, "x": 1.0}],
    "contact": {"normal_stiffness": 1000.0, "restitution": 0.3, "tangential_stiffness": 750.0, "friction": 0.5},
    "shaking": {"gamma": 1.5, "period": 4.0, "start": 1.0},
    "output": {
        "history_interval": 0.1, "frames_per_second": 1.0, "checkpoint_interval": 1.0, "figures": False
    },
}  # fmt: skip


def test_grains_lie_apart_with_the_intruder_in_the_middle() -> None:
    scene = load_scene("shaken_walls")
    grains = build(scene).model.particles.grains
    order = np.argsort(grains.number)
    x, y, radius = (getattr(grains, name)[order] for name in ("x", "y", "radius"))
    apart = np.hypot(x[:, None] - x, y[:, None] - y) - radius[:, None] - radius
    assert apart[~np.eye(len(x), dtype=bool)].min() > 0.0
    assert len(x) == 2501 and radius[-1] == 2.5
    assert x[-1] == scene.box.width / 2
    # as many rows below it as above, to one row
    assert abs(np.sum(y[:-1] < y[-1]) - 1250) < 35
    assert (0.4875 <= radius[:-1].min() < 0.4876) and (0.5124 < radius[:-1].max() <= 0.5125)
    # a uniform distribution: mean to three of its standard errors, variance of a uniform one
    assert abs(radius[:-1].mean() - 0.5) < 3 * 0.0125 / np.sqrt(3 * 2500)
    assert np.var(radius[:-1]) == pytest.approx(0.0125**2 / 3, rel=0.05)


def test_seed_and_spread_decide_the_sizes() -> None:
    def radii(*sets: str) -> np.ndarray:
        grains = build(load_scene("brazil_nut", sets)).model.particles.grains
        return grains.radius[np.argsort(grains.number)]

    np.testing.assert_array_equal(radii(), radii())
    assert np.all(radii()[:-1] != radii("grains.seed=2")[:-1])
    assert np.all(radii("grains.sizes.0.spread=0")[:-1] == 0.5)


def moved(shift: float, steps: int, start: np.ndarray) -> tuple[np.ndarray, Any]:
    """Displacements and turns of grains that start at `start`, all shifted along x and folded into the box."""
    place = start.copy()
    place[:, 0] = (place[:, 0] + shift) % WIDTH
    tables = copy.deepcopy(FEW)
    tables["grains"] |= {"layout": "list", "positions": place[:-1].tolist()}
    tables["intruders"] = [FEW["intruders"][0] | {"x": place[-1, 0], "y": place[-1, 1]}]
    system = build(Scene.model_validate(tables)).model.particles
    system.advance(steps)
    order = np.argsort(system.grains.number)
    grains = system.grains
    return np.column_stack([grains.position[order] - place, grains.theta[order]]), system


def test_nothing_depends_on_where_the_seam_lies() -> None:
    """Friction springs across the seam, an intruder on it: the same motion but for round-off, which grows.

    Sums of forces run in the order of the storage, which the seam changes: not the same bits.
    """
    system = build(Scene.model_validate(FEW)).model.particles
    order = np.argsort(system.grains.number)
    start = system.grains.position[order]
    here, system = moved(0.0, 1500, start)
    assert system.look().tangential_energy > 0.0 and system.rebuilds > 5
    for shift in (0.3, -1.0, 5.7, 100.123):
        there, _ = moved(shift, 1500, start)
        # one part in 1e16 of places some 10 diameters away, grown by a few collisions each
        np.testing.assert_allclose(there, here, atol=1e-9)


def test_history_follows_intruder_and_floor(tmp_path: Path) -> None:
    scene = Scene.model_validate(FEW)
    run = run_scene(scene, out=tmp_path / "run", threads=1, progress=False)
    seen = read_history(run / "history.csv")
    amplitude = 1.5 * (4.0 / (2 * np.pi)) ** 2
    since = np.maximum(seen["time"] - 1.0, 0.0)
    np.testing.assert_allclose(seen["floor_y"], amplitude * (1 - np.cos(2 * np.pi * since / 4.0)), atol=1e-9)
    assert seen["intruder_x"][0] == 1.0
    # the velocity of the history is that of half a step later: a parabola before anything touches
    falling = seen["contacts"] == 0
    assert falling[:3].all()
    drop = seen["intruder_y"][0] - seen["intruder_y"][:3]
    np.testing.assert_allclose(drop, 0.5 * seen["time"][:3] ** 2, atol=1e-9)
    # work of the floor and the weights it lifts are in the ledger; what is missing is the integrator's
    assert seen["walls_work"][-1] > 1.0
    assert np.abs(seen["ledger_relative_error"]).max() < 0.02


def test_history_names_what_moves(tmp_path: Path) -> None:
    """A floor at rest under shaken sides has no displacement."""
    walled = {"box.periodic": GONE, "intruders.0.x": 6.0, "shaking.walls": ["right", "left"]}
    tables = changed(FEW, walled | {"time.duration": 3.0})
    run = run_scene(Scene.model_validate(tables), out=tmp_path / "run", threads=1, progress=False)
    seen = read_history(run / "history.csv")
    assert "floor_y" not in seen and seen["walls_y"].max() > 0.5
    record = Record(run)
    np.testing.assert_array_equal(height_over_floor(record, "intruder"), seen["intruder_y"])
    np.testing.assert_allclose(record.moved(seen["time"], "left")[:, 1], seen["walls_y"], atol=1e-12)


@pytest.mark.parametrize(("start", "sentences"), [(7.9, 0), (8.0, 1)])
def test_shaking_after_the_end_is_told(start: float, sentences: int) -> None:
    said = cautions.before(build(Scene.model_validate(changed(FEW, {"shaking.start": start}))))
    assert sum("nothing shakes" in sentence for sentence in said) == sentences


def test_run_taken_up_in_the_middle_of_a_period_has_the_same_bits(tmp_path: Path) -> None:
    tables = copy.deepcopy(FEW)
    whole = run_scene(Scene.model_validate(tables), out=tmp_path / "whole", threads=1, progress=False)
    part = changed(tables, {"time.duration": 4.0})
    out = run_scene(Scene.model_validate(part), out=tmp_path / "part", threads=1, progress=False)
    run_scene(Scene.model_validate(tables), out=out, threads=1, progress=False, resume=True)
    assert_same_run(whole, out)


ROUGH = changed(FEW, {"box.walls": [], "shaking.gamma": 0.5, "shaking.start": 10.0, "time.duration": 12.0})
ROUGH["contact"] = {"normal_stiffness": 1000.0, "normal_damping": 5.0, "tangential_stiffness": 750.0, "friction": 0.5}
ROUGH["rows"] = [{"start": [0.5, -0.5], "end": [11.5, -0.5], "count": 12, "radius": 0.5}]
"""A floor of glued grains in place of the wall."""


def test_rough_floor_shakes_and_is_taken_up_with_the_same_bits(tmp_path: Path) -> None:
    whole = run_scene(Scene.model_validate(ROUGH), out=tmp_path / "whole", threads=1, progress=False)
    part = run_scene(
        Scene.model_validate(changed(ROUGH, {"time.duration": 11.0})), out=tmp_path / "part", threads=1, progress=False
    )
    run_scene(Scene.model_validate(ROUGH), out=part, threads=1, progress=False, resume=True)
    assert_same_run(whole, part)
    seen = read_history(whole / "history.csv")
    frames = Record(whole).frames("grains", 1)
    held = np.array([arrays["points"][arrays["body"] != -1][:, 1] for _, arrays in frames])
    # places are written in single precision
    np.testing.assert_allclose(held + 0.5, np.tile(seen["floor_y"][::10, None], 12), atol=1e-6)
    # the run ends at the top, where the grains have been lifted by the stroke; they had come to rest before, but for
    # what the bed packs
    weight, begin = 60 * 0.25 + 2.25, int(np.searchsorted(seen["time"], 9.99))
    work = seen["rows_work"][-1] - seen["rows_work"][begin]
    assert seen["floor_y"][-1] == seen["floor_y"].max()
    assert work == pytest.approx(weight * seen["floor_y"][-1], rel=0.05)
    assert np.all(seen["walls_work"] == 0.0)
    # what is missing is the integrator's
    assert np.abs(seen["ledger_relative_error"]).max() < 0.02


def test_row_stays_where_it_is_told_to() -> None:
    """The floor shakes through: a row that is told to stay has the velocity that it is given."""
    still = changed(FEW, {}) | {"rows": [dict(ROUGH["rows"][0], start=[0.5, 30.0], end=[11.5, 30.0], shaken=False)]}
    still["rows"] = [still["rows"][0], still["rows"][0] | {"start": [0.5, 35.0], "end": [11.5, 35.0]}]
    still["rows"][1] |= {"velocity": [1.0, 0.0]}
    system = build(Scene.model_validate(still)).model.particles
    start = system.grains.position[system.grains.n_free :].copy()
    system.advance(1000)
    moved = system.grains.position[system.grains.n_free :] - start
    np.testing.assert_allclose(moved, np.repeat([[0.0, 0.0], [2.0, 0.0]], 12, axis=0), atol=1e-12)


@pytest.mark.parametrize(("units", "length"), [("dimensionless", "-"), ("SI", "m")])
def test_numbers_without_units_are_told_without(
    units: str, length: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rise = {"name": "rise", "kind": "rise", "column": "intruder_y"}
    scene = Scene.model_validate(changed(FEW, {"units": units, "time.duration": 0.2}) | {"quantities": [rise]})
    out = run_scene(scene, out=tmp_path / "run", threads=1, progress=False)
    heading, told = (out / "history.csv").read_text().splitlines()[0].split(","), capsys.readouterr().out
    assert f"intruder_y [{length}]" in heading and len([name for name in heading if name.endswith("[-]")]) > 3
    assert all(name.endswith("[-]") for name in heading) == (units == "dimensionless")
    assert (" s simulated" in told, "J/m" in told) == (units == "SI", units == "SI")
    assert ("m" in next(line for line in told.splitlines() if "rise" in line).split()) == (units == "SI")


def test_rows_go_on_under_headings_of_an_earlier_version(tmp_path: Path) -> None:
    path = tmp_path / "history.csv"
    History(path).write({"time [s]": 1.0, "intruder_y [m]": 2.0})
    taken_up = History(path, keep_until=1.0)
    taken_up.write({"intruder_y [-]": 4.0, "time [-]": 3.0})
    assert taken_up.last_time == 3.0
    seen = read_history(path)
    assert seen["time"].tolist() == [1.0, 3.0] and seen["intruder_y"].tolist() == [2.0, 4.0]


def test_period_in_steps_is_a_time_that_a_finer_step_leaves() -> None:
    scene = with_step(Scene.model_validate(PERIODIC))
    assert scene.shaking.period == pytest.approx(5000 * 1e-5, rel=1e-12) and scene.shaking.period_steps is None
    system = build(Scene.model_validate(PERIODIC)).model.particles
    assert system.shaking.period == scene.shaking.period
    assert system.shaking.ramp == scene.shaking.period, "a sine begins with a ramp"


def test_walls_of_a_bed_and_its_intruders_pass_on() -> None:
    bed = changed(SHAKEN, {"shaking": GONE})
    tables = {
        "title": "on a bed", "time": SHAKEN["time"], "grains": {"bed": "bed"}, "bed": bed, "shaking": SHAKEN["shaking"],
        "box": bed["box"], "contact": bed["contact"], "gravity": bed["gravity"], "intruders": bed["intruders"],
    }  # fmt: skip
    settled = build(Scene.model_validate(bed)).model
    settled.advance(500)
    saved = {name.removeprefix("particles."): a for name, a in settled.state().items() if name.startswith("particles.")}
    model = build(Scene.model_validate(tables), bed=saved).model
    model.advance(10)
    assert model.followed == (50, 51)
    grains = model.particles.grains
    assert grains.radius[grains.number == 50][0] == 5e-3


def test_intruder_with_a_name_has_a_law_of_its_own() -> None:
    """Soft against walls: the overlaps of a disc that lies on the floor."""
    tables: dict[str, Any] = {
        "title": "an intruder alone on the floor",
        "units": "dimensionless", "gravity": [0.0, -1.0], "time": {"duration": 40.0, "step": 1e-3},
        "box": {"width": 20.0, "height": 20.0},
        "grains": {
            "sizes": [{"radius": 1.0, "count": 1}], "density": RHO, "layout": "list", "positions": [[15.0, 1.0]]
        },
        "intruders": [{"name": "nut", "radius": 2.0, "density": RHO, "x": 5.0, "y": 2.0}],
        "contact": {
            "normal_stiffness": 1000.0, "normal_damping": 40.0,
            "pairs": [{"between": ["nut", "walls"], "normal_stiffness": 250.0}],
        },
    }  # fmt: skip
    system = build(Scene.model_validate(tables)).model.particles
    system.advance(40_000)
    overlap = dict(zip(system.grains.number, system.look().overlap, strict=True))
    # weights m g = 1 and 4 on springs of 1000 and 250, known to the rounding of heights of 1
    assert overlap[0] == pytest.approx(1.0 / 1000.0, rel=1e-9)
    assert overlap[1] == pytest.approx(4.0 / 250.0, rel=1e-9)
    later = {name: table for name, table in tables.items() if name not in ("grains", "title")}
    later |= {"title": "on that bed", "grains": {"bed": "bed"}, "bed": tables}
    later["rows"] = [{"start": [0.0, 15.0], "end": [0.0, 15.0], "count": 1, "radius": 0.5, "name": "kerb"}]
    saved = system.state()
    again = build(Scene.model_validate(later), bed=saved).model.particles
    again.advance(10)
    overlap = dict(zip(again.grains.number, again.look().overlap, strict=True))
    assert overlap[1] == pytest.approx(4.0 / 250.0, rel=1e-9), "the row's material has moved the intruder's on"


def test_structure_rides_in_a_shaken_box() -> None:
    """Walls move grains, and grains a free body: its balance closes, as the walls' work is all that comes in."""
    tube = {
        "kind": "free_rigid", "density": 1600.0, "tube": {"outer_radius": 0.015, "inner_radius": 0.01},
        "placement": {"x": 0.05, "y": "on_bed"},
    }  # fmt: skip
    tables = changed(SHAKEN, {"intruders": [], "structure": tube, "interface": {"per_facet": 2}, "shaking.start": 0.05})
    tables["contact"] = {"normal_stiffness": 1e5, "normal_damping": 3.0, "tangential_stiffness": 5e3, "friction": 0.5}
    model = build(Scene.model_validate(tables)).model
    start = take_balance(model, model.particles.look(), None).entries
    model.advance(15_000)
    balance = take_balance(model, model.particles.look(), start)
    assert balance.entries["walls_work"] > 0.0
    assert abs(balance.relative_error) < 0.01
