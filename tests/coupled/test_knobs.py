"""Keys that are factors: what they keep (mass, restitution, packing, springs) and what they change (order, time)."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bad_scenes import BEAM_ON_ROW, GRAINS, HERTZ, SURFACES, TUBE, Case, changed, require_refusal

from coupled.build import build
from coupled.limits_before import packing_limit_of, settled_limit_of
from coupled.quantities import evaluate
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene
from coupled.scene.knobs import plain
from coupled.step import limits_of, with_step

QUIET = {"output": {"figures": False, "frames_per_second": 0.0}}
LAWS: dict[str, dict[str, Any]] = {
    "dashpot": {"normal_stiffness": 1e6, "normal_damping": 30.0},
    "restitution": {"normal_stiffness": 1e6, "restitution": 0.6},
    "hertz": {"normal": "hertz", "hertz_stiffness": 1e9, "restitution": 0.6},
    "recipe": {"recipe": {"from_drop_height": 5e-3, "max_overlap": 0.02, "restitution": 0.6}},
}


def one_grain(law: str, **factors: float) -> Scene:
    """A grain that falls 0.2 m onto a floor."""
    tables = changed(
        GRAINS,
        {
            "grains": {"sizes": [{"radius": 2e-3, "count": 1}], "density": 1600.0, "spacing": 100.0},
            "box": {"width": 1.0, "height": 1.0},
            "contact": LAWS[law],
            "time.step": 2e-6,
        },
    )
    for key, value in factors.items():
        table, name = {"coarsening": ("grains", "coarsening"), "stiffness": ("contact", "stiffness_factor")}[key]
        tables[table][name] = value
    return Scene.model_validate(tables)


def bounce(scene: Scene) -> tuple[float, float]:
    """Restitution [-] and time of contact [s] of the first bounce on the floor."""
    model = build(scene).model
    grains = model.particles.grains
    fall = math.sqrt(2.0 * (float(grains.y[0]) - float(grains.radius[0])) / 9.81)
    model.advance(int(0.999 * fall / scene.time.step))
    into, touched = 0.0, 0
    for _ in range(20000):
        model.advance(1)
        into = max(into, -float(grains.vy[0]))
        touched += float(grains.y[0]) < float(grains.radius[0])
        if grains.vy[0] > 0 and grains.y[0] > grains.radius[0]:
            break
    return float(grains.vy[0]) / into, touched * scene.time.step


@pytest.mark.parametrize("law", LAWS)
def test_springs_times_four_halve_the_time_and_keep_the_restitution(law: str) -> None:
    """``t ~ sqrt(m/k)``; with Hertz at a given speed ``(m/k_h)^(2/5)``. Steps of 2e-6 s show times to that."""
    before, after = bounce(one_grain(law)), bounce(one_grain(law, stiffness=4.0))
    assert after[0] == pytest.approx(before[0], abs=3e-3)  # the step's share of a contact that is half as long
    assert after[1] == pytest.approx(before[1] * 4.0 ** (-0.4 if law == "hertz" else -0.5), abs=6e-6)


@pytest.mark.parametrize("law", LAWS)
def test_grains_twice_as_large_keep_the_restitution(law: str) -> None:
    """Mass and so the time squared grow by four where springs stay; the recipe asks for the same spring."""
    before, after = bounce(one_grain(law)), bounce(one_grain(law, coarsening=2.0))
    assert after[0] == pytest.approx(before[0], abs=3e-3)
    if law != "hertz":
        # gravity presses four times the weight into the same spring: a part in m g/(k v sqrt(m/k)) of 1e-3
        assert after[1] == pytest.approx(2.0 * before[1], rel=3e-3, abs=6e-6)


def test_hertz_packing_is_as_stiff_as_before() -> None:
    """The force at an overlap that is the same share of the radius grows like the radius."""
    for changes in ({}, {"contact.hertz_stiffness": 1e9, "contact.restitution": 0.5}):
        base = {"normal": "hertz", "hertz_stiffness": 1e9} if changes else dict(HERTZ["contact"])
        forces = []
        for factor in (1.0, 3.0):
            tables = {**HERTZ, "contact": base, "grains": HERTZ["grains"] | {"coarsening": factor}}
            built = build(Scene.model_validate(tables))
            radius = float(built.model.particles.grains.radius.max())
            law = next(built.contact.models_of([0])).normal
            # slope times overlap is 3/2 of Hertz's force
            forces.append(law.stiffness_at(0.01 * radius, radius / 2) * 0.01 * radius)
        assert forces[1] == pytest.approx(3.0 * forces[0], rel=1e-9)


@pytest.mark.parametrize("factor", [1.5, 2.0, 3.0, 0.7])
def test_coarsening_keeps_the_mass_of_a_bed(factor: float) -> None:
    """Each of three sizes is rounded to whole grains: half a grain each at most."""
    before, after = (plain(load_scene("bed", [f"grains.coarsening={c}"])).grains for c in (1.0, factor))
    area = [sum(size.count * math.pi * size.radius**2 for size in grains.sizes) for grains in (before, after)]
    assert abs(area[1] - area[0]) <= 0.5 * sum(math.pi * size.radius**2 for size in after.sizes)
    assert after.largest_radius == pytest.approx(factor * before.largest_radius, rel=1e-12)


def small_bed(coarsening: float) -> Scene:
    return Scene.model_validate(
        {
            "title": "a small bed",
            "gravity": [0.0, -9.81],
            "time": {"duration": 1.0, "step": "auto", "step_fraction": 0.8},
            "box": {"width": 0.3, "height": 0.6},
            "grains": {
                "sizes": [{"radius": 2.2e-3, "count": 500}, {"radius": 1.8e-3, "count": 900}],
                "density": 1600.0,
                "jitter": 0.5,
                "coarsening": coarsening,
            },
            "contact": {
                "normal_stiffness": 4e5,
                "normal_damping": 40.0,
                "tangential_stiffness": 2e4,
                "tangential_damping": 7.0,
                "friction": 0.5,
            },
            "quantities": [
                {"name": "height", "kind": "surface_height"},
                {
                    "name": "packing",
                    "kind": "packing_fraction",
                    "bottom": 0.01,
                    "top": 0.05,
                    "left": 0.02,
                    "right": 0.28,
                },
            ],
            **QUIET,
        }
    )


@pytest.fixture(scope="module")
def beds(tmp_path_factory: pytest.TempPathFactory) -> dict[float, Path]:
    """A bed of 1400 grains and one of 350, settled."""
    folder = tmp_path_factory.mktemp("beds")
    for factor in (1.0, 2.0):
        run_scene(small_bed(factor), out=folder / f"{factor:g}", threads=1, progress=False)
    return {factor: folder / f"{factor:g}" for factor in (1.0, 2.0)}


def test_coarsened_bed_stands_as_high(beds: dict[float, Path]) -> None:
    """Walls and floor loosen a layer of a radius or so: the height changes by less than a coarse radius."""
    height, packing = ([evaluate(q, beds[c]) for c in (1.0, 2.0)] for q in small_bed(1.0).quantities)
    assert abs(height[1] - height[0]) < 4e-3, height
    assert height[0] > 0.06
    # 5 x 30 coarse discs lie in the rectangle: packings of few grains differ by a per cent or two
    assert packing[1] == pytest.approx(packing[0], abs=0.03)


@pytest.mark.parametrize("factor", [1.0, 2.0])
def test_step_fraction_is_one_of_the_sharp_limit(beds: dict[float, Path], factor: float) -> None:
    """Samples of a thousand grains give the limit of a bed at rest within 8 %: other numbers, friction."""
    scene = load_scene(beds[factor] / "scene.toml")
    tables = small_bed(factor).model_dump(exclude_none=True)
    half = with_step(Scene.model_validate(tables | {"time": tables["time"] | {"step_fraction": 0.4}}))
    assert half.time.step == pytest.approx(0.5 * scene.time.step, rel=1e-12)
    from coupled.bed import settled_state
    from particles import Grains, continued

    saved = settled_state(beds[factor])
    built = build(scene)
    system = continued(
        saved,
        Grains.from_saved(saved),
        built.contact,
        time_step=scene.time.step,
        walls=built.model.particles.walls,
        gravity=scene.gravity,
    )
    built.model.particles = system
    limits = limits_of(built.model)
    assert limits.of_network == pytest.approx(0.8, rel=0.08)


def test_hertz_has_the_limit_of_any_packing_and_light_intruders_lower_it() -> None:
    """Hertz's spring has no limit but at an overlap; a light intruder with many neighbours moves faster than a grain."""
    hertz = Scene.model_validate(HERTZ)
    assert settled_limit_of(hertz) == packing_limit_of(hertz)
    bare = changed(GRAINS, {"gravity": [0.0, -9.81], "box.width": 0.1})
    light, heavy = (
        Scene.model_validate(bare | {"intruders": [{"radius": 0.01, "density": density, "x": 0.05, "y": 0.05}]})
        for density in (20.0, 1600.0)
    )
    assert settled_limit_of(light) < 0.9 * settled_limit_of(Scene.model_validate(bare))
    assert settled_limit_of(heavy) == pytest.approx(settled_limit_of(Scene.model_validate(bare)), rel=1e-9)


def test_step_stays_inside_the_limit_of_the_coupling() -> None:
    """A light tube: at the whole of the limit its stiffness ratio is just that at which the exchange is stable."""
    tables = changed(TUBE, {"time.step": "auto", "time.step_fraction": 1.0, "interface.largest_stiffness_ratio": 1.5})
    built = build(Scene.model_validate(tables))
    assert built.stiffness_ratio == pytest.approx(1.5, rel=5e-4)
    with_dashpots = changed(tables, {"contact.normal_damping": 20.0, "interface.substeps": 3})
    again = build(Scene.model_validate(with_dashpots))
    assert again.stiffness_ratio == pytest.approx(1.5, rel=5e-4)
    half = build(Scene.model_validate(changed(with_dashpots, {"time.step_fraction": 0.5})))
    assert half.scene.time.step == pytest.approx(0.5 * again.scene.time.step, rel=1e-9)


def test_refined_mesh_converges_with_the_order_of_its_cells() -> None:
    """First frequency of the beam with enhanced cells: twice as many make a quarter of the error."""
    errors = []
    for factor in (2, 4, 8):
        scene = plain(load_scene("beam_vibration", ["structure.beam.order=1", f"structure.refinement={factor}"]))
        body = build(scene).model.structure
        errors.append(float(body.frequencies(1)[0]) / 276.7312 - 1.0)  # converged, 240 x 12 cells of order 2
    rates = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert rates == pytest.approx([2.0, 2.0], abs=0.1), errors


def test_refined_step_converges_with_order_two(tmp_path: Path) -> None:
    """Newmark's period error is ``(omega dt)^2/12``: a quarter at half the step."""
    frequencies = []
    quiet = ["output.figures=false", "output.frames_per_second=0", "time.step=7.2e-5"]
    for factor in (1, 2, 4):
        scene = load_scene("beam_vibration", [*quiet, f"time.refinement={factor}"])
        run_scene(scene, out=tmp_path / str(factor), threads=1, progress=False)
        frequencies.append(evaluate(scene.quantities[0], tmp_path / str(factor)))
    first, second = np.diff(frequencies)
    assert math.log2(first / second) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(
    ("name", "overrides", "number"),
    [
        ("elastic_tube", ["structure.refinement=2"], 180),
        ("elastic_tube", ["structure.refinement=0.5"], 180),
        ("elastic_tube", ["grains.coarsening=2"], 90),
        ("elastic_tube", ["grains.coarsening=2", "structure.refinement=1.5"], 90),
        ("winkler_beam", ["structure.refinement=3"], 120),
        ("winkler_beam", ["structure.refinement=0.5"], 120),
    ],
)
def test_glued_grains_keep_their_size_over_that_of_the_grains(name: str, overrides: list[str], number: int) -> None:
    scene = plain(load_scene(name, overrides))
    shape, interface = scene.structure.shape, scene.interface
    assert len(interface.facet_lengths(shape)) * interface.grains_per_facet(shape) == number


def test_skin_changes_how_often_lists_are_made_and_nothing_else() -> None:
    """Sums in another order: round-off, which 400 steps of falling grains do not let grow beyond 1e-12 of the box."""
    places, rebuilds = [], []
    for factor in (0.5, 1.0, 4.0):
        tables = changed(GRAINS, {"grains.jitter": 0.5, "grains.skin_factor": factor, "time.step": 5e-5})
        system = build(Scene.model_validate(tables)).model.particles
        system.advance(400)
        order = np.argsort(system.grains.number)
        places.append(system.grains.position[order])
        rebuilds.append(system.rebuilds)
    assert rebuilds[0] > rebuilds[1] > rebuilds[2]
    for other in places[1:]:
        np.testing.assert_allclose(other, places[0], rtol=0.0, atol=1e-13)


def test_bed_follows_what_stands_on_it() -> None:
    scene = plain(load_scene("elastic_tube", ["grains.coarsening=2", "contact.stiffness_factor=4"]))
    bare = load_scene("bed")
    for law in (scene.contact, scene.bed.contact):
        assert law.normal_stiffness == 4 * bare.contact.normal_stiffness
        assert law.normal_damping == pytest.approx(4 * bare.contact.normal_damping, rel=1e-12)
    assert scene.bed.grains == plain(load_scene("bed", ["grains.coarsening=2"])).grains
    assert plain(bare) is bare and plain(scene) is scene


def test_pairs_materials_and_recipes_follow() -> None:
    pairs = plain(Scene.model_validate(changed(SURFACES, {"contact.stiffness_factor": 9.0}))).contact.pairs
    assert pairs[2].normal_stiffness == 9 * 2e6 and pairs[2].rolling_friction == 0.1
    hertz = plain(Scene.model_validate(changed(HERTZ, {"contact.stiffness_factor": 9.0}))).contact
    assert hertz.materials["floor"].youngs_modulus == 9e9 and hertz.materials["floor"].poissons_ratio == 0.2


BAD: dict[str, Case] = {
    "coarsening of a list": (
        GRAINS,
        {
            "grains.layout": "list",
            "grains.positions": [[0.05, 0.1]],
            "grains.sizes": [{"radius": 2e-3, "count": 1}],
            "grains.coarsening": 2.0,
        },
        "grains.coarsening",
        ('layout = "list"',),
    ),
    "coarsening by nothing": (GRAINS, {"grains.coarsening": 0.0}, "grains.coarsening", ("greater than 0",)),
    "refined row of springs": (
        BEAM_ON_ROW,
        {"structure.refinement": 2.0},
        "structure.refinement",
        ("160 intervals of the 120", "divides 3 glued grains"),
    ),
    "fraction of a given step": (GRAINS, {"time.step_fraction": 0.5}, "time.step_fraction", ("time.refinement",)),
    "fraction and safety": (
        GRAINS,
        {"time.step": "auto", "time.step_fraction": 0.5, "time.safety": 0.5},
        "time.safety",
        ("together with time.step_fraction",),
    ),
    "refined auto step": (
        GRAINS,
        {"time.step": "auto", "time.refinement": 2.0},
        "time.refinement",
        ("time.step_fraction",),
    ),
    "no skin": (GRAINS, {"grains.skin_factor": 0.0}, "grains.skin_factor", ("greater than 0",)),
    "fraction above one": (
        GRAINS,
        {"time.step": "auto", "time.step_fraction": 1.5},
        "time.step_fraction",
        ("at most 1",),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_factor_is_refused_in_one_sentence(case: str, tmp_path: Path) -> None:
    require_refusal(BAD[case], tmp_path)
