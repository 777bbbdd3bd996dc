"""Bad scenes: each is refused in one sentence that names the key and the remedy."""

from __future__ import annotations

import copy
from typing import Any

import pytest
import tomli_w

from coupled.scene import SceneError, load_scene

GRAINS: dict[str, Any] = {
    "title": "a few grains",
    "gravity": [0.0, -9.81],
    "time": {"duration": 1.0, "step": 1e-5},
    "box": {"width": 0.1, "height": 0.2},
    "grains": {"sizes": [{"radius": 2e-3, "count": 50}], "density": 1600.0},
    "contact": {"normal_stiffness": 1e6, "tangential_stiffness": 5e4, "friction": 0.5},
}
TUBE: dict[str, Any] = {
    **GRAINS,
    "title": "a tube on a few grains",
    "structure": {
        "kind": "elastic",
        "youngs_modulus": 70e9,
        "poissons_ratio": 0.35,
        "density": 2700.0,
        "tube": {"outer_radius": 0.02, "inner_radius": 0.015},
        "placement": {"x": 0.05, "y": "on_bed"},
        "loads": [{"kind": "boundary", "boundary": "loaded_arc", "total_force": [0.0, -10.0]}],
    },
    "interface": {"per_facet": 2},
}
RIGID: dict[str, Any] = {
    **TUBE,
    "structure": {
        "kind": "rigid",
        "tube": {"outer_radius": 0.02, "inner_radius": 0.015},
        "placement": {"x": 0.05, "y": "on_bed"},
        "path": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, -0.01]]},
    },
}
BEAM_ON_ROW: dict[str, Any] = {
    "title": "a beam on a row",
    "time": {"duration": 1.0, "step": 1e-5},
    "structure": {
        "kind": "elastic",
        "youngs_modulus": 70e9,
        "poissons_ratio": 0.35,
        "density": 2700.0,
        "beam": {"length": 1.0, "height": 0.05},
    },
    "interface": {"per_facet": 3, "boundaries": ["bottom"]},
    "rows": [{"under": "bottom", "radius": 4e-3}],
    "contact": {"normal_stiffness": 1e7},
}
HERTZ: dict[str, Any] = {
    **GRAINS,
    "title": "a few grains with Hertz's spring",
    "contact": {
        "normal": "hertz",
        "youngs_modulus": 1e8,
        "poissons_ratio": 0.3,
        "restitution": 0.8,
        "friction": 0.5,
        "materials": {"floor": {"youngs_modulus": 1e9, "poissons_ratio": 0.2}},
        "pairs": [{"between": ["grains", "walls"], "friction": 0.2}],
    },
}
SURFACES: dict[str, Any] = {
    **RIGID,
    "title": "a rigid tube, a row and walls of their own materials",
    "rows": [{"start": [0.01, 0.15], "end": [0.01, 0.15], "count": 1, "radius": 2e-3, "name": "kerb"}],
    "contact": {
        "normal_stiffness": 1e6,
        "restitution": 0.8,
        "tangential_ratio": 0.05,
        "friction": 0.5,
        "pairs": [
            {"between": ["grains", "structure"], "friction": 0.2},
            {"between": ["kerb", "structure"], "friction": 0.2},
            {"between": ["floor", "grains"], "rolling_friction": 0.1, "normal_stiffness": 2e6},
        ],
    },
}
GONE = object()

# scene, the keys that are changed, the key that must be named, words that must be said
BAD: dict[str, tuple[dict[str, Any], dict[str, Any], str, tuple[str, ...]]] = {
    "unknown key": (
        GRAINS,
        {"grains.densty": 1.0},
        "grains.densty",
        ("not a known key", "'density'"),
    ),
    "unknown table": (GRAINS, {"grain": {}}, "grain", ("not a known key", "'grains'")),
    "negative step": (GRAINS, {"time.step": -1e-5}, "time.step", ("-1e-05", "greater than 0")),
    "zero radius": (
        GRAINS,
        {"grains.sizes.0.radius": 0.0},
        "grains.sizes.0.radius",
        ("greater than 0", "[m]"),
    ),
    "text for a number": (GRAINS, {"time.step": "1e-5"}, "time.step", ("must be a number",)),
    "number for a text": (GRAINS, {"title": 3}, "title", ("string in quotes",)),
    "fraction of a grain": (
        GRAINS,
        {"grains.sizes.0.count": 2.5},
        "grains.sizes.0.count",
        ("whole number",),
    ),
    "not finite": (GRAINS, {"time.duration": float("inf")}, "time.duration", ("finite",)),
    "gravity in one direction": (GRAINS, {"gravity": [1.0]}, "gravity", ("too few entries",)),
    "missing table": (GRAINS, {"time": GONE}, "time", ("missing", "[time]")),
    "missing density": (
        GRAINS,
        {"grains.density": GONE},
        "grains.density",
        ("missing", "[grains]", "kg/m3"),
    ),
    "missing title": (GRAINS, {"title": GONE}, "title", ("missing",)),
    "lattice without box": (GRAINS, {"box": GONE}, "box", ("missing", "add [box]")),
    "grains without law": (GRAINS, {"contact": GONE}, "contact", ("missing", "normal_stiffness")),
    "nothing to compute": (
        GRAINS,
        {"grains": GONE, "contact": GONE},
        "grains",
        ("needs grains or a structure",),
    ),
    "grain larger than box": (
        GRAINS,
        {"grains.sizes.0.radius": 0.06},
        "grains.sizes.0.radius",
        ("larger than the box",),
    ),
    "more grains than places": (
        GRAINS,
        {"grains.sizes.0.count": 100000},
        "grains.sizes",
        ("100000", "lattice holds"),
    ),
    "lattice closer than touching": (
        GRAINS,
        {"grains.spacing": 0.9},
        "grains.spacing",
        ("at least 1",),
    ),
    "unknown wall": (GRAINS, {"box.walls": ["roof"]}, "box.walls.0", ("'lid'",)),
    "wall named twice": (GRAINS, {"box.walls": ["floor", "floor"]}, "box.walls", ("twice",)),
    "step above the limit": (
        GRAINS,
        {"time.step": 1e-3},
        "time.step",
        ("2 sqrt(m_min/k_n)", "choose at most"),
    ),
    "step above the tangential limit": (
        GRAINS,
        {"time.step": 2e-4, "contact.tangential_stiffness": 1e6},
        "time.step",
        ("3 k_t", "choose at most"),
    ),
    "step longer than run": (BEAM_ON_ROW, {"time.step": 2.0}, "time.step", ("time.duration",)),
    "rows of history too dense": (
        GRAINS,
        {"output.history_interval": 1e-7},
        "output.history_interval",
        ("one step",),
    ),
    "rest without gravity": (
        GRAINS,
        {"time.stop_at_rest": 1e-6, "gravity": GONE},
        "time.stop_at_rest",
        ("gravity",),
    ),
    "friction without spring": (
        GRAINS,
        {"contact.tangential_stiffness": GONE},
        "contact.tangential_stiffness",
        ("friction = 0.5", "normal_stiffness/20"),
    ),
    "tangential spring without friction": (
        GRAINS,
        {"contact.friction": GONE},
        "contact.tangential_stiffness",
        ("contact.friction",),
    ),
    "rolling without friction": (
        GRAINS,
        {
            "contact.friction": GONE,
            "contact.tangential_stiffness": GONE,
            "contact.rolling_friction": 0.2,
        },
        "contact.rolling_friction",
        ("needs contact.friction",),
    ),
    "rolling damping without rolling": (
        GRAINS,
        {"contact.rolling_damping_ratio": 0.3},
        "contact.rolling_damping_ratio",
        ("rolling_friction",),
    ),
    "no stiffness": (
        GRAINS,
        {"contact.normal_stiffness": GONE},
        "contact.normal_stiffness",
        ("recipe",),
    ),
    "stiffness and recipe": (
        GRAINS,
        {
            "contact.tangential_stiffness": GONE,
            "contact.recipe": {"from_drop_height": 1.0, "restitution": 0.5},
        },
        "contact.normal_stiffness",
        ("recipe",),
    ),
    "recipe without wish": (
        GRAINS,
        {"contact": {"recipe": {"restitution": 0.5}}},
        "contact.recipe",
        ("from_drop_height", "from_impact_speed"),
    ),
    "restitution above one": (
        GRAINS,
        {"contact": {"recipe": {"from_drop_height": 1.0, "restitution": 1.5}}},
        "contact.recipe.restitution",
        ("at most 1",),
    ),
    "old name of a wish": (
        GRAINS,
        {"contact": {"recipe": {"drop_height": 1.0, "restitution": 0.5}}},
        "contact.recipe.drop_height",
        ("not a known key", "'from_drop_height'"),
    ),
    "recipe of Hertz's spring": (
        GRAINS,
        {"contact": {"normal": "hertz", "recipe": {"from_drop_height": 1.0, "restitution": 0.5}}},
        "contact.normal",
        ("linear spring",),
    ),
    "recipe without grains": (
        BEAM_ON_ROW,
        {"contact": {"recipe": {"from_impact_speed": 1.0, "restitution": 0.5}}},
        "contact.recipe",
        ("free grains", "give normal_stiffness"),
    ),
    "restitution and dashpot": (
        GRAINS,
        {"contact.restitution": 0.8, "contact.normal_damping": 10.0},
        "contact.normal_damping",
        ("contact.restitution", "keep one"),
    ),
    "no rebound": (GRAINS, {"contact.restitution": 0.0}, "contact.restitution", ("greater than 0",)),
    "end of no restitution": (
        GRAINS,
        {"contact.restitution_at": "zero_overlap"},
        "contact.restitution_at",
        ("needs contact.restitution",),
    ),
    "restitution of prescribed grains": (
        BEAM_ON_ROW,
        {"contact.restitution": 0.5},
        "contact.restitution",
        ("mass of a free grain", "outright"),
    ),
    "unknown spring": (GRAINS, {"contact.normal": "herz"}, "contact.normal", ("'hertz'",)),
    "modulus of a linear spring": (
        GRAINS,
        {"contact.youngs_modulus": 1e8},
        "contact.youngs_modulus",
        ('contact.normal = "hertz"',),
    ),
    "linear spring of Hertz": (
        HERTZ,
        {"contact.normal_stiffness": 1e6},
        "contact.normal_stiffness",
        ("contact.hertz_stiffness",),
    ),
    "dashpot of Hertz": (HERTZ, {"contact.normal_damping": 1.0}, "contact.normal_damping", ("contact.restitution",)),
    "Hertz's spring twice": (
        HERTZ,
        {"contact.hertz_stiffness": 1e8},
        "contact.hertz_stiffness",
        ("contact.youngs_modulus", "keep one"),
    ),
    "no spring of Hertz": (
        GRAINS,
        {"contact": {"normal": "hertz"}},
        "contact.hertz_stiffness",
        ("missing", "youngs_modulus"),
    ),
    "modulus without Poisson's ratio": (
        HERTZ,
        {"contact.poissons_ratio": GONE},
        "contact.poissons_ratio",
        ("beside youngs_modulus",),
    ),
    "grains that grow when squeezed": (
        HERTZ,
        {"contact.poissons_ratio": 0.6},
        "contact.poissons_ratio",
        ("at most 0.5",),
    ),
    "friction on Hertz's stiffness": (
        GRAINS,
        {"contact": {"normal": "hertz", "hertz_stiffness": 1e8, "friction": 0.5}},
        "contact.tangential_ratio",
        ("friction = 0.5", "youngs_modulus"),
    ),
    "two tangential springs": (
        GRAINS,
        {"contact.tangential_ratio": 0.05},
        "contact.tangential_ratio",
        ("contact.tangential_stiffness",),
    ),
    "dashpot of another tangential spring": (
        GRAINS,
        {"contact.tangential_damping_ratio": 0.1},
        "contact.tangential_damping_ratio",
        ("contact.tangential_damping",),
    ),
    "rolling spring on Mindlin's": (
        HERTZ,
        {"contact.rolling_friction": 0.1},
        "contact.rolling_stiffness",
        ("missing", "N m/rad", '"constant_torque"'),
    ),
    "rolling spring of a constant torque": (
        GRAINS,
        {"contact.rolling_friction": 0.1, "contact.rolling": "constant_torque", "contact.rolling_stiffness": 1.0},
        "contact.rolling_stiffness",
        ('"elastic_plastic"',),
    ),
    "kind of no rolling resistance": (
        GRAINS,
        {"contact.rolling": "constant_torque"},
        "contact.rolling",
        ("needs contact.rolling_friction",),
    ),
    "pair of an unknown material": (
        SURFACES,
        {"contact.pairs.0.between": ["grains", "stucture"]},
        "contact.pairs.0.between.1",
        ("no material", "'structure'", "kerb", "walls"),
    ),
    "pair with a wall that is not there": (
        SURFACES,
        {"contact.pairs.2.between": ["grains", "lid"]},
        "contact.pairs.2.between.1",
        ("no material",),
    ),
    "pair of three": (
        SURFACES,
        {"contact.pairs.0.between": ["grains", "structure", "kerb"]},
        "contact.pairs.0.between",
        ("at most 2",),
    ),
    "pair of one": (SURFACES, {"contact.pairs.0.between": ["grains"]}, "contact.pairs.0.between", ("too few",)),
    "pair twice": (
        SURFACES,
        {"contact.pairs.1.between": ["structure", "grains"]},
        "contact.pairs.1.between",
        ("given already", "keep one"),
    ),
    "pair that never meets": (
        SURFACES,
        {"contact.pairs.1.between": ["structure", "floor"]},
        "contact.pairs.1.between",
        ("never meet", "remove"),
    ),
    "pair without numbers": (SURFACES, {"contact.pairs.0.friction": GONE}, "contact.pairs.0", ("friction",)),
    "pair with a key of all": (
        SURFACES,
        {"contact.pairs.0.rolling": "constant_torque"},
        "contact.pairs.0.rolling",
        ("not a known key",),
    ),
    "pair with another dashpot": (
        SURFACES,
        {"contact.pairs.0.normal_damping": 1.0},
        "contact.pairs.0.normal_damping",
        ("another kind", "restitution"),
    ),
    "pair with another tangential spring": (
        SURFACES,
        {"contact.pairs.0.tangential_stiffness": 1e5},
        "contact.pairs.0.tangential_stiffness",
        ("another kind", "tangential_ratio"),
    ),
    "pair of half a material": (
        HERTZ,
        {
            "contact": {
                "normal": "hertz",
                "hertz_stiffness": 1e8,
                "pairs": [{"between": ["grains", "floor"], "youngs_modulus": 1e8}],
            }
        },
        "contact.pairs.0.poissons_ratio",
        ("missing", "youngs_modulus"),
    ),
    "friction of a pair without spring": (
        SURFACES,
        {"contact.friction": GONE, "contact.tangential_ratio": GONE},
        "contact.pairs.0.tangential_stiffness",
        ("friction = 0.2",),
    ),
    "row with the name of another material": (SURFACES, {"rows.0.name": "walls"}, "rows.0.name", ("taken",)),
    "constants of an unknown material": (
        HERTZ,
        {"contact.materials.flor": {"youngs_modulus": 1e9, "poissons_ratio": 0.2}},
        "contact.materials.flor",
        ("no material", "'floor'"),
    ),
    "constants of half a material": (
        HERTZ,
        {"contact.materials.floor.poissons_ratio": GONE},
        "contact.materials.floor.poissons_ratio",
        ("missing", "[contact.materials.floor]"),
    ),
    "constants of a linear spring": (
        SURFACES,
        {"contact.materials": {"floor": {"youngs_modulus": 1e9, "poissons_ratio": 0.2}}},
        "contact.materials",
        ('contact.normal = "hertz"',),
    ),
    "constants of some": (
        HERTZ,
        {"contact.youngs_modulus": GONE, "contact.poissons_ratio": GONE},
        "contact.materials.grains",
        ("missing", "youngs_modulus"),
    ),
    "wrong number of positions": (
        GRAINS,
        {"grains.layout": "list", "grains.positions": [[0.05, 0.05]]},
        "grains.positions",
        ("1 rows", "50 grains"),
    ),
    "positions outside the box": (
        GRAINS,
        {
            "grains.layout": "list",
            "grains.sizes.0.count": 1,
            "grains.positions": [[0.05, 0.001]],
        },
        "grains.positions.0",
        ("outside the box",),
    ),
    "damping of nothing": (
        BEAM_ON_ROW,
        {"damping.translational": 1.0},
        "damping",
        ("free grains",),
    ),
    "glued grains without structure": (
        TUBE,
        {"structure": GONE},
        "structure",
        ("missing", "glued grains need a structure"),
    ),
    "structure without interface": (
        TUBE,
        {"interface": GONE},
        "interface",
        ("missing", "add [interface]"),
    ),
    "glued grains with nothing to touch": (
        BEAM_ON_ROW,
        {"rows": GONE},
        "interface",
        ("nothing to touch",),
    ),
    "elastic without modulus": (
        TUBE,
        {"structure.youngs_modulus": GONE},
        "structure.youngs_modulus",
        ("elastic", "[Pa]"),
    ),
    "incompressible": (
        TUBE,
        {"structure.poissons_ratio": 0.5},
        "structure.poissons_ratio",
        ("less than 0.5",),
    ),
    "auxetic beyond reason": (
        TUBE,
        {"structure.poissons_ratio": -1.0},
        "structure.poissons_ratio",
        ("than -1",),
    ),
    "unknown kind": (TUBE, {"structure.kind": "plastic"}, "structure.kind", ("'elastic'",)),
    "rigid without path": (RIGID, {"structure.path": GONE}, "structure.path", ("missing", "rigid")),
    "rigid with loads": (
        RIGID,
        {"structure.loads": [{"kind": "body", "acceleration": [0.0, -9.81]}]},
        "structure.loads",
        ("rigid", "remove it"),
    ),
    "path back in time": (
        RIGID,
        {"structure.path.points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0]]},
        "structure.path.points.2",
        ("later than 1 s",),
    ),
    "path that starts elsewhere": (
        RIGID,
        {"structure.path.points": [[0.0, 0.0, 0.1], [1.0, 0.0, 0.0]]},
        "structure.path.points.0",
        ("[0.0, 0.0, 0.0]",),
    ),
    "two shapes": (
        TUBE,
        {"structure.beam": {"length": 1.0, "height": 0.1}},
        "structure.beam",
        ("keep one",),
    ),
    "no shape": (TUBE, {"structure.tube": GONE}, "structure.tube", ("[structure.beam]",)),
    "tube inside out": (
        TUBE,
        {"structure.tube.inner_radius": 0.03},
        "structure.tube.inner_radius",
        ("outer_radius = 0.02",),
    ),
    "load on a boundary of another shape": (
        TUBE,
        {"structure.loads.0.boundary": "top"},
        "structure.loads.0.boundary",
        ("loaded_arc",),
    ),
    "unknown load": (
        TUBE,
        {"structure.loads.0.kind": "pont"},
        "structure.loads.0.kind",
        ("'point'",),
    ),
    "load without kind": (
        TUBE,
        {"structure.loads.0.kind": GONE},
        "structure.loads.0.kind",
        ("missing",),
    ),
    "unstable newmark": (
        TUBE,
        {"structure.newmark": {"beta": 1 / 6}},
        "structure.newmark.beta",
        ("0.25",),
    ),
    "structure outside the box": (
        TUBE,
        {"structure.placement.x": 0.09},
        "structure.placement.x",
        ("outside the box",),
    ),
    "path out of the box": (
        RIGID,
        {"structure.path.points": [[0.0, 0.0, 0.0], [1.0, 0.05, 0.0]]},
        "structure.placement.x",
        ("outside the box",),
    ),
    "gap above a number": (
        TUBE,
        {"structure.placement": {"x": 0.05, "y": 0.1, "gap": 0.01}},
        "structure.placement.gap",
        ("on_bed",),
    ),
    "on no bed": (
        BEAM_ON_ROW,
        {"structure.placement.y": "on_bed"},
        "structure.placement.y",
        ("number",),
    ),
    "per facet and count": (TUBE, {"interface.count": 60}, "interface.count", ("per_facet = 2",)),
    "neither per facet nor count": (
        TUBE,
        {"interface.per_facet": GONE},
        "interface.per_facet",
        ("missing",),
    ),
    "count that does not divide": (
        TUBE,
        {"interface.per_facet": GONE, "interface.count": 61},
        "interface.count",
        ("multiple of 30",),
    ),
    "glued grains that overlap": (
        TUBE,
        {"interface.diameter": 3e-3},
        "interface.diameter",
        ("overlap", "0.00209057 m apart"),
    ),
    "glued inside": (
        TUBE,
        {"interface.boundaries": ["inner"]},
        "interface.boundaries.0",
        ("outer",),
    ),
    "no substep": (TUBE, {"interface.substeps": 0}, "interface.substeps", ("at least 1",)),
    "row under a bare boundary": (
        BEAM_ON_ROW,
        {"rows.0.under": "top"},
        "rows.0.under",
        ("bottom",),
    ),
    "row of coincident grains": (
        BEAM_ON_ROW,
        {"rows": [{"start": [0.0, 0.0], "end": [0.0, 0.0], "count": 3, "radius": 0.01}]},
        "rows.0.count",
        ("distance",),
    ),
    "bed that is not there": (
        GRAINS,
        {"grains": {"bed": "nowhere"}},
        "grains.bed",
        ("no scene",),
    ),
    "bed of itself": (GRAINS, {"grains": {"bed": "scene"}}, "grains.bed", ("leads back",)),
    "bed with a structure": (
        GRAINS,
        {"grains": {"bed": "elastic_tube"}},
        "grains.bed",
        ("without [structure]",),
    ),
    "box narrower than its bed": (
        GRAINS,
        {"grains": {"bed": "bed"}, "contact": GONE},
        "box.width",
        ("bed's 1.2",),
    ),
    "grains from a bed and of its own": (
        GRAINS,
        {"grains.bed": "bed"},
        "grains.sizes",
        ("together with bed",),
    ),
    "bed without grains": (BEAM_ON_ROW, {"bed": GRAINS}, "bed", ("serves no grains",)),
}


def _changed(scene: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Return a copy of a scene with keys set, or removed where the value is GONE."""
    data = copy.deepcopy(scene)
    for path, value in changes.items():
        *tables, last = path.split(".")
        here: Any = data
        for part in tables:
            here = here[int(part)] if isinstance(here, list) else here.setdefault(part, {})
        if value is GONE:
            del here[last]
        else:
            here[last] = value
    return data


@pytest.mark.parametrize("scene", [GRAINS, TUBE, RIGID, BEAM_ON_ROW, HERTZ, SURFACES], ids=lambda s: s["title"])
def test_the_unchanged_scenes_are_accepted(scene, tmp_path):
    """Otherwise a refusal below could have another cause."""
    path = tmp_path / "scene.toml"
    path.write_text(tomli_w.dumps(scene))
    assert load_scene(path).title == scene["title"]


@pytest.mark.parametrize("case", BAD)
def test_bad_scene_is_refused_in_one_sentence(case, tmp_path):
    scene, changes, key, words = BAD[case]
    path = tmp_path / "scene.toml"
    path.write_text(tomli_w.dumps(_changed(scene, changes)))
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    sentence = str(caught.value)
    assert caught.value.key == key
    assert sentence.startswith(f"scene.toml: {key} ")
    assert all(word in sentence for word in words), sentence
    assert "\n" not in sentence and sentence.endswith(".")


def test_missing_file_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"absent\.toml: there is no such file"):
        load_scene(tmp_path / "absent.toml")


def test_unknown_name_suggests_the_nearest_scene():
    with pytest.raises(SceneError, match="did you mean 'elastic_tube'"):
        load_scene("elastic_tueb")


def test_broken_toml_is_refused_with_its_line(tmp_path):
    path = tmp_path / "broken.toml"
    path.write_text('title = "broken"\n[time\nstep = 1e-5\n')
    with pytest.raises(SceneError, match=r"broken\.toml: .*not valid TOML.*line 2"):
        load_scene(path)


def test_two_beds_that_name_each_other_are_refused(tmp_path):
    for name, other in (("one", "two"), ("two", "one")):
        scene = {**GRAINS, "grains": {"bed": other}}
        (tmp_path / f"{name}.toml").write_text(tomli_w.dumps(scene))
    with pytest.raises(SceneError, match="leads back to this scene"):
        load_scene(tmp_path / "one.toml")


def test_error_inside_a_bed_names_the_file_of_the_bed(tmp_path):
    bad = _changed(GRAINS, {"grains.density": -1.0})
    (tmp_path / "soil.toml").write_text(tomli_w.dumps(bad))
    (tmp_path / "scene.toml").write_text(tomli_w.dumps({**GRAINS, "grains": {"bed": "soil"}}))
    with pytest.raises(SceneError, match=r"^soil\.toml: grains\.density = -1"):
        load_scene(tmp_path / "scene.toml")
