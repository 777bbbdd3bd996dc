"""Bad scenes: each is refused in one sentence that names the key and the remedy."""

from __future__ import annotations

import pytest
import tomli_w
from bad_scenes import BEAM_ON_ROW, GONE, GRAINS, HERTZ, RIGID, SURFACES, TUBE, Case, require_refusal

from coupled.scene import load_scene

BAD: dict[str, Case] = {
    "unknown key": (GRAINS, {"grains.densty": 1.0}, "grains.densty", ("not a known key", "'density'")),
    "unknown table": (GRAINS, {"grain": {}}, "grain", ("not a known key", "'grains'")),
    "negative step": (GRAINS, {"time.step": -1e-5}, "time.step", ("-1e-05", "greater than 0")),
    "zero radius": (GRAINS, {"grains.sizes.0.radius": 0.0}, "grains.sizes.0.radius", ("greater than 0", "[m]")),
    "text for a number": (GRAINS, {"time.step": "1e-5"}, "time.step", ("must be a number",)),
    "number for a text": (GRAINS, {"title": 3}, "title", ("string in quotes",)),
    "fraction of a grain": (GRAINS, {"grains.sizes.0.count": 2.5}, "grains.sizes.0.count", ("whole number",)),
    "not finite": (GRAINS, {"time.duration": float("inf")}, "time.duration", ("finite",)),
    "gravity in one direction": (GRAINS, {"gravity": [1.0]}, "gravity", ("too few entries",)),
    "missing table": (GRAINS, {"time": GONE}, "time", ("missing", "[time]")),
    "missing density": (GRAINS, {"grains.density": GONE}, "grains.density", ("missing", "[grains]", "kg/m3")),
    "missing title": (GRAINS, {"title": GONE}, "title", ("missing",)),
    "lattice without box": (GRAINS, {"box": GONE}, "box", ("missing", "add [box]")),
    "nothing to compute": (GRAINS, {"grains": GONE, "contact": GONE}, "grains", ("needs grains or a structure",)),
    "grain larger than box": (
        GRAINS,
        {"grains.sizes.0.radius": 0.06},
        "grains.sizes.0.radius",
        ("larger than the box",),
    ),
    "more grains than places": (GRAINS, {"grains.sizes.0.count": 100000}, "grains.sizes", ("100000", "lattice holds")),
    "lattice closer than touching": (GRAINS, {"grains.spacing": 0.9}, "grains.spacing", ("at least 1",)),
    "precision that is none": (
        GRAINS,
        {"grains.precision": "float16"},
        "grains.precision",
        ("'float64' or 'float32'",),
    ),
    "unknown wall": (GRAINS, {"box.walls": ["roof"]}, "box.walls.0", ("'lid'",)),
    "wall named twice": (GRAINS, {"box.walls": ["floor", "floor"]}, "box.walls", ("twice",)),
    "step above the limit": (GRAINS, {"time.step": 1e-3}, "time.step", ("2 sqrt(m_min/k_n)", "choose at most")),
    "step above the tangential limit": (
        GRAINS,
        {"time.step": 2e-4, "contact.tangential_stiffness": 1e6},
        "time.step",
        ("3 k_t", "choose at most"),
    ),
    "step longer than run": (BEAM_ON_ROW, {"time.step": 2.0}, "time.step", ("time.duration",)),
    "rows of history too dense": (GRAINS, {"output.history_interval": 1e-7}, "output.history_interval", ("one step",)),
    "frames between steps": (
        GRAINS,
        {"output.frames_per_second": 1e6},
        "output.frames_per_second",
        ("more than one frame in a time.step", "at most 100000"),
    ),
    "steps whose times are equal": (GRAINS, {"time.step": 1e-17}, "time.duration", ("1e+15 steps", "shorten it")),
    "number beyond all": (GRAINS, {"contact.friction": 1e31}, "contact.friction", ("at most 1e+30",)),
    "drag that turns grains about": (
        GRAINS,
        {"damping": {"translational": 2e5}},
        "damping.translational",
        ("within time.step = 1e-05 s", "less than 1e+04 1/s"),
    ),
    "rest without gravity": (GRAINS, {"time.stop_at_rest": 1e-6, "gravity": GONE}, "time.stop_at_rest", ("gravity",)),
    "wrong number of positions": (
        GRAINS,
        {"grains.layout": "list", "grains.positions": [[0.05, 0.05]]},
        "grains.positions",
        ("1 rows", "50 grains"),
    ),
    "positions outside the box": (
        GRAINS,
        {"grains.layout": "list", "grains.sizes.0.count": 1, "grains.positions": [[0.05, 0.001]]},
        "grains.positions.0",
        ("outside the box",),
    ),
    "damping of nothing": (BEAM_ON_ROW, {"damping.translational": 1.0}, "damping", ("free grains",)),
    "glued grains without structure": (
        TUBE,
        {"structure": GONE},
        "structure",
        ("missing", "an interface needs a structure"),
    ),
    "more cells than memory": (
        TUBE,
        {"structure.tube.around": 10_000_000},
        "structure.tube.around",
        ("above 10000000", "fewer cells"),
    ),
    "refined beyond memory": (
        TUBE,
        {"structure.refinement": 1e9},
        "structure.tube.around",
        ("above 10000000", "fewer cells"),
    ),
    "structure without interface": (TUBE, {"interface": GONE}, "interface", ("missing", "add [interface]")),
    "glued grains with walls alone": (
        TUBE,
        {"grains": GONE, "structure.placement.y": 0.1},
        "interface",
        ("walls meet free grains alone",),
    ),
    "glued grains with nothing to touch": (BEAM_ON_ROW, {"rows": GONE}, "interface", ("nothing to touch",)),
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
        ("less than 0.5", "incompressible"),
    ),
    "auxetic beyond reason": (TUBE, {"structure.poissons_ratio": -1.0}, "structure.poissons_ratio", ("than -1",)),
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
    "two shapes": (TUBE, {"structure.beam": {"length": 1.0, "height": 0.1}}, "structure.beam", ("keep one",)),
    "no shape": (TUBE, {"structure.tube": GONE}, "structure.tube", ("[structure.beam]",)),
    "tube inside out": (
        TUBE,
        {"structure.tube.inner_radius": 0.03},
        "structure.tube.inner_radius",
        ("outer_radius = 0.02",),
    ),
    "tube without thickness": (
        TUBE,
        {"structure.tube.inner_radius": 0.02},
        "structure.tube.inner_radius",
        ("less than outer_radius = 0.02",),
    ),
    "beam without thickness": (
        BEAM_ON_ROW,
        {"structure.beam.height": 0.0},
        "structure.beam.height",
        ("greater than 0", "[m]"),
    ),
    "load on a boundary of another shape": (
        TUBE,
        {"structure.loads.0.boundary": "top"},
        "structure.loads.0.boundary",
        ("loaded_arc",),
    ),
    "unknown load": (TUBE, {"structure.loads.0.kind": "pont"}, "structure.loads.0.kind", ("'point'",)),
    "load without kind": (TUBE, {"structure.loads.0.kind": GONE}, "structure.loads.0.kind", ("missing",)),
    "unstable newmark": (TUBE, {"structure.newmark": {"beta": 1 / 6}}, "structure.newmark.beta", ("0.25",)),
    "newmark that feeds energy": (
        TUBE,
        {"structure.newmark": {"gamma": 0.49}},
        "structure.newmark.gamma",
        ("unstable", "0.5"),
    ),
    "structure outside the box": (TUBE, {"structure.placement.x": 0.09}, "structure.placement.x", ("outside the box",)),
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
    "on no bed": (BEAM_ON_ROW, {"structure.placement.y": "on_bed"}, "structure.placement.y", ("number",)),
    "per facet and count": (TUBE, {"interface.count": 60}, "interface.count", ("per_facet = 2",)),
    "neither per facet nor count": (TUBE, {"interface.per_facet": GONE}, "interface.per_facet", ("missing",)),
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
    "glued inside": (TUBE, {"interface.boundaries": ["inner"]}, "interface.boundaries.0", ("outer",)),
    "mean velocity of facets": (
        TUBE,
        {"interface": {"kind": "facets", "velocity": "mean"}},
        "interface.velocity",
        ("glued grains", "remove it"),
    ),
    "facets inside": (
        TUBE,
        {"interface": {"kind": "facets", "boundaries": ["inner"]}},
        "interface.boundaries.0",
        ("outer",),
    ),
    "row under facets without a number": (
        BEAM_ON_ROW,
        {"interface": {"kind": "facets", "boundaries": ["bottom"]}},
        "interface.per_facet",
        ("missing", 'row under "bottom"'),
    ),
    "unknown interface": (TUBE, {"interface.kind": "mortar"}, "interface.kind", ("'facets'",)),
    "tolerance of an exchange that does not iterate": (
        TUBE,
        {"interface.tolerance": 1e-5},
        "interface.tolerance",
        ('exchange = "iterated"',),
    ),
    "loose tolerance": (
        TUBE,
        {"interface.exchange": "iterated", "interface.tolerance": 0.1},
        "interface.tolerance",
        ("0.01", '"predicted"'),
    ),
    "one iteration": (
        TUBE,
        {"interface.exchange": "iterated", "interface.iterations": 1},
        "interface.iterations",
        ("at least 3",),
    ),
    "no substep": (TUBE, {"interface.substeps": 0}, "interface.substeps", ("at least 1",)),
    "row under a bare boundary": (BEAM_ON_ROW, {"rows.0.under": "top"}, "rows.0.under", ("bottom",)),
    "row of coincident grains": (
        BEAM_ON_ROW,
        {"rows": [{"start": [0.0, 0.0], "end": [0.0, 0.0], "count": 3, "radius": 0.01}]},
        "rows.0.count",
        ("distance",),
    ),
    "bed that is not there": (GRAINS, {"grains": {"bed": "nowhere"}}, "grains.bed", ("no scene",)),
    "bed of itself": (GRAINS, {"grains": {"bed": "scene"}}, "grains.bed", ("leads back",)),
    "bed with a structure": (GRAINS, {"grains": {"bed": "elastic_tube"}}, "grains.bed", ("without [structure]",)),
    "box narrower than its bed": (GRAINS, {"grains": {"bed": "bed"}, "contact": GONE}, "box.width", ("bed's 1.2",)),
    "grains from a bed and of its own": (GRAINS, {"grains.bed": "bed"}, "grains.sizes", ("together with bed",)),
    "bed without grains": (BEAM_ON_ROW, {"bed": GRAINS}, "bed", ("serves no grains",)),
}


@pytest.mark.parametrize("scene", [GRAINS, TUBE, RIGID, BEAM_ON_ROW, HERTZ, SURFACES], ids=lambda s: s["title"])
def test_the_unchanged_scenes_are_accepted(scene, tmp_path):
    """Otherwise a refusal below could have another cause."""
    path = tmp_path / "scene.toml"
    path.write_text(tomli_w.dumps(scene))
    assert load_scene(path).title == scene["title"]


@pytest.mark.parametrize("case", BAD)
def test_bad_scene_is_refused_in_one_sentence(case, tmp_path):
    require_refusal(BAD[case], tmp_path)
