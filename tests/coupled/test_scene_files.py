"""Scenes that ship, inheritance from a bed, overrides and the resolved scene."""

from __future__ import annotations

import math
import tomllib

import pytest
import tomli_w

from coupled.scene import SceneError, SettledGrains, dump_scene, load_scene, shipping_scenes

NAMES = (
    "bed",
    "shaken_walls",
    "shaken_smooth_walls",
    "shaken_no_friction",
    "shaken_periodic",
    "brazil_nut",
    "beam_vibration",
    "rolling_tube",
    "elastic_beam",
    "elastic_tube",
    "pulsing_tube",
    "rigid_beam",
    "rigid_tube",
    "rigid_tube_trench",
    "winkler_beam",
)


def test_the_promised_scenes_ship():
    assert set(NAMES) <= set(shipping_scenes())


@pytest.mark.parametrize("name", shipping_scenes())
def test_resolved_scene_reads_back_equal(name, tmp_path):
    scene = load_scene(name)
    path = tmp_path / "resolved.toml"
    path.write_text(dump_scene(scene))
    again = load_scene(path)
    assert again == scene
    assert dump_scene(again) == dump_scene(scene)


def test_resolved_scene_says_every_default():
    resolved = tomllib.loads(dump_scene(load_scene("elastic_tube")))
    assert resolved["units"] == "SI"
    assert resolved["structure"]["newmark"] == {"beta": 0.25, "gamma": 0.5}
    assert resolved["interface"]["exchange"] == "predicted"
    assert resolved["output"]["checkpoint_interval"] == 0.5
    assert resolved["bed"]["grains"]["layout"] == "lattice"


@pytest.mark.parametrize("name", ["elastic_tube", "rigid_tube_trench", "elastic_beam"])
def test_scene_on_a_bed_takes_over_its_surroundings(name):
    scene, bed = load_scene(name), load_scene("bed")
    assert scene.bed == bed
    assert isinstance(scene.grains, SettledGrains)
    for table in ("units", "gravity", "box", "contact", "damping"):
        assert getattr(scene, table) == getattr(bed, table)
    assert scene.first_grains == bed.grains


def test_own_table_goes_before_the_beds(tmp_path):
    path = tmp_path / "scene.toml"
    scene = {
        "title": "grains of a bed, without friction",
        "time": {"duration": 1.0, "step": 1e-5},
        "grains": {"bed": "bed"},
        "contact": {"normal_stiffness": 1e6},
    }
    path.write_text(tomli_w.dumps(scene))
    loaded = load_scene(path)
    assert loaded.contact.friction is None
    assert loaded.bed.contact.friction == 0.8
    assert loaded.box == loaded.bed.box


def test_the_sources_numbers_of_glued_grains():
    """G 4 has 180 on the tube and 588 on the beam, G 3.4 has 120 intervals below the beam."""
    for name, number in (("elastic_tube", 180), ("rigid_beam", 588), ("winkler_beam", 120)):
        scene = load_scene(name)
        shape, interface = scene.structure.shape, scene.interface
        facets = len(interface.facet_lengths(shape))
        assert facets * interface.grains_per_facet(shape) == number


def test_bed_runs_at_the_sources_share_of_its_bound():
    """G 4 states 88 % of 0.5 sqrt(m_min/k_n) in two digits: half a percent of rounding."""
    bed = load_scene("bed")
    bound = 0.5 * math.sqrt(bed.grains.smallest_mass / bed.contact.normal_stiffness)
    assert bed.time.step / bound == pytest.approx(0.88, abs=0.005)


def test_trench_path_keeps_one_speed():
    """G gives the first three ways and 30 s in all; the tube moves at 0.02 m/s throughout."""
    points = load_scene("rigid_tube_trench").structure.path.points
    for (t0, x0, y0), (t1, x1, y1) in zip(points, points[1:]):
        assert math.hypot(x1 - x0, y1 - y0) / (t1 - t0) == pytest.approx(0.02, rel=1e-12)
    assert points[-1] == (30.0, 0.0, 0.0)


def test_overrides_change_single_keys():
    scene = load_scene(
        "elastic_tube",
        [
            "time.duration=0.1",
            "structure.loads.0.total_force=[0, -5.0]",
            "structure.rayleigh.mass_factor = 1",
            "interface.exchange=lagged",
            'title="a test"',
            "contact.friction=0.5",
            "bed.grains.sizes.0.count=10",
            "bed.time.duration=0.2",
        ],
    )
    assert scene.time.duration == 0.1
    assert scene.structure.loads[0].total_force == (0.0, -5.0)
    assert scene.structure.rayleigh.mass_factor == 1.0
    assert scene.interface.exchange == "lagged"
    assert scene.title == "a test"
    assert (scene.contact.friction, scene.bed.contact.friction) == (0.5, 0.8)
    assert scene.contact.normal_stiffness == scene.bed.contact.normal_stiffness
    assert scene.bed.grains.sizes[0].count == 10
    assert scene.bed.time.duration == 0.2
    assert scene.output.checkpoint_interval == pytest.approx(0.01)


def test_overrides_act_on_a_bed_inside_the_file(tmp_path):
    path = tmp_path / "resolved.toml"
    path.write_text(dump_scene(load_scene("elastic_tube")))
    scene = load_scene(path, ["bed.grains.sizes.2.count=1"])
    assert scene.bed.grains.sizes[2].count == 1


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("time.step", "key=value"),
        ("=3", "key=value"),
        ("time..step=3", "key=value"),
        ("time.step=[1", "no TOML value"),
        ("time.step=-1", "time.step = -1 must be greater than 0"),
        ("time.stepp=1.0", "did you mean 'step'"),
        ("grains.sizes.7.count=1", "index from 0 to 2"),
        ("grains.sizes.first.count=1", "index from 0 to 2"),
        ("time.step.size=1", "is a value and has no keys"),
        ("bed.time.step=1.0", "names no bed"),
        ("contact.friction=true", "must be a number"),
    ],
)
def test_bad_override_is_refused(override, words):
    with pytest.raises(SceneError) as caught:
        load_scene("bed", [override])
    assert words in str(caught.value)


def test_a_bare_name_finds_the_scene_beside_first(tmp_path):
    bed = tomllib.loads(dump_scene(load_scene("bed", ["grains.sizes.0.count=5"])))
    (tmp_path / "bed.toml").write_text(tomli_w.dumps(bed))
    scene = {
        "title": "own bed",
        "time": {"duration": 1.0, "step": 1e-5},
        "grains": {"bed": "bed"},
    }
    (tmp_path / "scene.toml").write_text(tomli_w.dumps(scene))
    assert load_scene(tmp_path / "scene.toml").bed.grains.sizes[0].count == 5


def test_the_word_absent_leaves_a_key_or_table_out():
    scene = load_scene("bed", ["damping=absent", "contact.rolling_friction=absent", "output=absent"])
    assert scene.damping is None and not scene.contact.rolls
    assert load_scene("bed", ["title='absent'"]).title == "absent"
    assert load_scene("bed", ["structure=absent"]) == load_scene("bed")  # what is not there may be left out
    assert [size.count for size in load_scene("bed", ["grains.sizes.0=absent"]).grains.sizes] == [7500, 3750]
    with pytest.raises(SceneError, match="time.step is missing"):
        load_scene("bed", ["time.step=absent"])
