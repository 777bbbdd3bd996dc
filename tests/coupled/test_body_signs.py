"""A structure that goes where its model does not reach ends the run with its place, and a sound one does not."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from beam_on_bed import BEAM, FACETS, GLUED, RADIUS, beam_on_bed

from coupled.output import checkpoint
from coupled.output.history import read_history
from coupled.running.body_signs import _within
from coupled.running.run import run_scene
from coupled.running.watchdog import Unstable
from coupled.scene import Scene, SceneError
from structure.overturned import first_overturned

INTERFACES = [pytest.param(GLUED, id="glued"), pytest.param(FACETS, id="facets")]
FREE = {"kind": "free_rigid", "density": 2700.0, "beam": BEAM}


def falling(from_height: float, acceleration: float) -> dict[str, Any]:
    """A free rigid beam above the bed."""
    loads = [{"kind": "body", "acceleration": [0.0, -acceleration]}]
    return FREE | {"placement": {"x": 0.15, "y": from_height}, "loads": loads}


def failure(tables: dict[str, Any], out: Path) -> str:
    """The sentence of a run that must be stopped; the state before it can be read."""
    with pytest.raises(Unstable) as caught:
        run_scene(Scene.model_validate(tables), out=out, threads=1, progress=False)
    checkpoint.load(out / "before_failure.h5")
    return str(caught.value)


@pytest.mark.parametrize("interface", INTERFACES)
def test_a_structure_that_would_pass_over_grains_is_told_before_it_meets_them(interface: dict, tmp_path: Path) -> None:
    """At 1e7 m/s2 it moves by 500 m/s after one step of 5e-5 s: 5 radii in a step. It went through the bed unseen."""
    said = failure(beam_on_bed(structure=falling(0.6, 1e7), interface=interface, duration=7e-4), tmp_path / "run")
    assert "t = 5e-05 s" in said and "moves at 500 m/s, 5 of the smallest grain's radius in a step" in said
    told = float(said.partition("take time.step = ")[2].split(" s")[0])
    assert told * 500.0 < 0.5 * RADIUS


@pytest.mark.parametrize("interface", INTERFACES)
def test_a_structure_behind_a_wall_is_told_where_it_is(interface: dict, tmp_path: Path) -> None:
    """The beam falls beside the one disc there is; walls do not hold it."""
    tables = beam_on_bed(structure=falling(0.02, 9.81), interface=interface, discs=[[RADIUS, RADIUS]], duration=0.3)
    said = failure(tables, tmp_path / "run")
    deep = 0.5 * RADIUS
    expected = math.sqrt(2 * (0.01 + deep) / 9.81)
    told = float(said.partition("t = ")[2].partition(" s")[0])
    assert 0.0 <= told - expected <= 2 * 5e-5, "the first step beyond half a radius"
    assert "behind the wall 'floor': walls hold grains, not structures" in said and "[[rows]]" in said
    assert read_history(tmp_path / "run" / "history.csv")["centroid_y"].min() > 0.01 - deep - 1e-4


def test_a_grain_inside_the_structure_is_told_at_the_start(tmp_path: Path) -> None:
    """It touches none of the glued grains."""
    tables = beam_on_bed(structure=falling(0.1, 9.81), interface=GLUED, discs=[[0.15, 0.1]])
    with pytest.raises(Unstable, match=r"the centre of grain 0 at \(0.15, 0.1\) m is inside the structure"):
        run_scene(Scene.model_validate(tables), out=tmp_path / "run", threads=1, progress=False)


def test_a_boundary_that_meets_no_grains_lets_one_in_and_that_is_told(tmp_path: Path) -> None:
    """Facets on the lower face alone; a disc falls onto the upper one."""
    tables = beam_on_bed(
        structure=FREE | {"placement": {"x": 0.15, "y": 0.1}},
        interface=FACETS | {"boundaries": ["bottom"]},
        discs=[[0.15, 0.12]],
        duration=0.1,
    )
    said = failure(tables, tmp_path / "run")
    told = float(said.partition("t = ")[2].partition(" s")[0])
    assert "the centre of grain 0" in said and "is inside the structure" in said
    # centre at 0.12, upper face at 0.11: the first step below it
    assert 0.0 <= told - math.sqrt(2 * 0.01 / 9.81) <= 2 * 5e-5


@pytest.mark.parametrize("theory", ["linear", "large_strain"])
def test_a_structure_turned_inside_out_is_told(theory: str, tmp_path: Path) -> None:
    """A pressure of 1e13 Pa on both ends of a bar of 7e10 Pa."""
    ends = [{"kind": "pressure", "boundary": side, "pressure": 1e13} for side in ("left", "right")]
    tables = beam_on_bed(structure={"theory": theory, "loads": ends, "placement": {"x": 0.0, "y": 0.0}}, step=1e-7)
    alone = {key: tables[key] for key in ("title", "structure", "output")} | {"time": {"duration": 1e-4, "step": 1e-7}}
    alone["output"] |= {"history_interval": 1e-6}
    assert "is turned inside out" in failure(alone, tmp_path / "run")


def test_a_path_that_jumps_over_grains_is_refused() -> None:
    path = {"points": [[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.05001, 0.0, -0.01]]}
    jumping = {"kind": "rigid", "beam": BEAM, "placement": {"x": 0.15, "y": "on_bed"}, "path": path}
    with pytest.raises(SceneError, match="points.2 .* grains would be passed over; give this way at least 0.0002 s"):
        Scene.model_validate(beam_on_bed(structure=jumping))
    path["points"][2][0] = 0.0503  # 33 m/s: 0.33 of a radius in a step
    Scene.model_validate(beam_on_bed(structure=jumping))


@pytest.mark.parametrize(("step", "sound"), [(1e-4, True), (1.3e-4, False)])
def test_an_exchange_that_feeds_grains_but_saturates_is_stopped(step: float, sound: bool, tmp_path: Path) -> None:
    """r of the closed contacts is 2.8 and 3.9, with free partners: the first is quiet, in the second grains rattle.

    What the second makes of energy stays below 5 % of what is there from one look to the next.
    """
    tables = beam_on_bed(step=step, duration=0.5, interface=GLUED | {"largest_stiffness_ratio": 1000.0})
    if sound:
        run_scene(Scene.model_validate(tables), out=tmp_path / "run", threads=1, progress=False)
        history = read_history(tmp_path / "run" / "history.csv")
        assert history["stiffness_ratio"][-1] > 2.0 and history["fastest_grain"][-1] < 1e-4
        return
    said = failure(tables, tmp_path / "run")
    assert "grains on the structure turn about at every step" in said and "above 2" in said
    assert float(said.partition("take time.step = ")[2].split(" s")[0]) < step / 2


def test_points_are_found_inside_a_polygon_as_by_angles() -> None:
    """Against the sum of the angles under which its sides are seen, which is a whole turn inside and none outside."""
    rng = np.random.default_rng(5)
    angle = np.linspace(0.0, 2 * np.pi, 17)[:-1]
    corners = np.column_stack([np.cos(angle), np.sin(angle)]) * rng.uniform(0.3, 1.0, (16, 1))
    facets = np.column_stack([np.arange(16), np.roll(np.arange(16), -1)])
    points = rng.uniform(-1.0, 1.0, (500, 2))
    seen = corners[None] - points[:, None]
    z = seen[..., 0] + 1j * seen[..., 1]
    turns = np.angle(np.roll(z, -1, axis=1) / z).sum(axis=1)
    np.testing.assert_array_equal(_within(points, corners, facets), np.abs(turns) > np.pi)


def test_the_first_cell_inside_out_is_named() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [2.0, 1.0]])
    cells = np.array([[0, 1, 2, 3], [1, 4, 5, 2]])
    assert first_overturned(points, cells, "quadrilateral") is None
    folded = points.copy()
    folded[4] = [0.5, 0.5]  # beyond the left side of the right cell
    assert first_overturned(folded, cells, "quadrilateral") == 1
    assert first_overturned(-folded[:, ::-1], cells, "quadrilateral") == 0, "a mirror image is inside out"
    assert first_overturned(points @ np.array([[0.0, 1.0], [-1.0, 0.0]]), cells, "quadrilateral") is None
