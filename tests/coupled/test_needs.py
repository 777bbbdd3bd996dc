"""What `leito check` says a scene models without need: found where it is, and taking it out changes nothing."""

from typing import Any

import numpy as np
import pytest

import meshes
from coupled.build import build
from coupled.report.need_rows import need_rows
from coupled.report.needs import without_need
from coupled.report.paired import measured_shares
from coupled.report.shares import Trial, shares
from coupled.report.strain import estimate
from coupled.scene import Scene
from structure import ElasticStructure, PlaneStrain, PointLoad, Pressure

GRAINS: dict[str, Any] = {
    "title": "twelve discs that fall on each other",
    "gravity": [0.0, -9.81],
    "time": {"duration": 0.1, "step": 1e-5},
    "box": {"width": 0.03, "height": 0.1},
    "grains": {"sizes": [{"radius": 2e-3, "count": 12}], "density": 1600.0, "spacing": 1.2, "jitter": 0.9},
    "contact": {"normal_stiffness": 1e5},
    "output": {"frames_per_second": 0.0},
}
BODY: dict[str, Any] = {
    "title": "a beam over a row",
    "time": {"duration": 0.1, "step": 1e-6},
    "rows": [{"start": [-0.1, -0.012], "end": [0.1, -0.012], "count": 11, "radius": 2e-3}],
    "contact": {"normal_stiffness": 1e5},
    "interface": {"per_facet": 2, "boundaries": ["bottom"], "largest_stiffness_ratio": 1e3},
    "structure": {
        "kind": "elastic", "density": 1000.0, "youngs_modulus": 1e9, "poissons_ratio": 0.3,
        "beam": {"length": 0.2, "height": 0.02, "along": 8, "across": 2},
        "loads": [{"kind": "boundary", "boundary": "top", "total_force": [0.0, -10.0]}],
    },
    "output": {"frames_per_second": 0.0},
}  # fmt: skip
STRESS = {"name": "stress", "kind": "max", "column": "max_von_mises"}
FRICTION = {"friction": 0.0, "tangential_stiffness": 5e3}
ROLLING = FRICTION | {"friction": 0.5, "rolling_friction": 0.0}


def scene_of(base: dict[str, Any], **changes: Any) -> Scene:
    """A scene with some tables changed: merged if both are tables, taken out if None."""
    tables = dict(base)
    for name, value in changes.items():
        if value is None:
            tables.pop(name)
        else:
            tables[name] = tables[name] | value if isinstance(tables.get(name), dict) else value
    return Scene.model_validate(tables)


def found_in(scene: Scene) -> list[str]:
    return [found.key for found in without_need(scene, build(scene))]


def test_a_lean_scene_has_nothing_needless() -> None:
    assert found_in(scene_of(GRAINS)) == []
    assert found_in(scene_of(BODY)) == []


# What is added to a scene, the key that is named, and the same scene without it.
IDLE = {
    "friction of zero": ({"contact": FRICTION}, "contact.friction"),
    "rolling friction of zero": ({"contact": ROLLING}, "contact.rolling_friction"),
    "a pair that says the same": (
        {"contact": {"pairs": [{"between": ["grains", "walls"], "normal_stiffness": 1e5}]}},
        "contact.pairs.0",
    ),
    "damping of zero": ({"damping": {"translational": 0.0, "rotational": 0.0}}, "damping"),
    "damping of spins without friction": ({"damping": {"translational": 0.0, "rotational": 5.0}}, "damping.rotational"),
    "velocity Verlet without dashpots": ({"time": {"integrator": "velocity_verlet"}}, "time.integrator"),
    "a lid": ({"box": {"walls": ["left", "right", "floor", "lid"]}}, "box.walls"),
}


@pytest.mark.parametrize(("added", "key"), IDLE.values(), ids=IDLE)
def test_what_is_needless_is_found_and_changes_nothing(added: dict[str, Any], key: str) -> None:
    scene = scene_of(GRAINS, **added)
    assert found_in(scene) == [key]
    rubs = {"contact": {name: ROLLING[name] for name in FRICTION}} if key == "contact.rolling_friction" else {}
    places = []
    for tried in (scene, scene_of(GRAINS, **rubs)):
        model = build(tried).model
        model.advance(4000)  # 0.04 s: they fall 8 mm, three quarters of them have met another
        grains = model.particles.grains
        places.append(grains.position[np.argsort(grains.number)])
        assert model.particles.look().count > 0
    # Sums may stand in another order: round-off of 0.1 m, which collisions of convex grains enlarge a thousandfold.
    assert np.abs(places[0] - places[1]).max() < 1e-13


NEEDED = {
    "friction": {"contact": FRICTION | {"friction": 0.3}},
    "damping": {"damping": {"translational": 1.0, "rotational": 0.0}},
    "Verlet with dashpots": {"contact": {"normal_damping": 1.0}, "time": {"integrator": "velocity_verlet"}},
    "a lid and no gravity": {"box": {"walls": ["left", "right", "floor", "lid"]}, "gravity": [0.0, 0.0]},
    "a pair that differs": {
        "contact": {"pairs": [{"between": ["grains", "walls"], "normal_stiffness": 2e5}]},
    },
}


@pytest.mark.parametrize("added", NEEDED.values(), ids=NEEDED)
def test_what_is_needed_is_not_found(added: dict[str, Any]) -> None:
    assert found_in(scene_of(GRAINS, **added)) == []


OF_BODIES: dict[str, Any] = {
    "gravity without free grains": ({"gravity": [0.0, -9.81]}, ["gravity"]),
    "walls without free grains": (
        {"box": {"width": 1.0, "height": 1.0}, "structure": {"placement": {"x": 0.5, "y": 0.5}}}, ["box.walls"],
    ),
    "Rayleigh's zeros": ({"structure": {"rayleigh": {}}}, ["structure.rayleigh"]),
    "iterated though calm": ({"interface": {"exchange": "iterated"}}, ["interface.exchange"]),
    "large strain that never comes": (
        {"structure": {"theory": "large_strain", "element": "standard"}}, ["structure.theory"],
    ),
    "as good as rigid": ({"structure": {"youngs_modulus": 1e15}}, ["structure.kind"]),
    "stiff, but its stress is asked for": (
        {"structure": {"youngs_modulus": 1e15}, "quantities": [STRESS]}, [],
    ),
}  # fmt: skip


@pytest.mark.parametrize(("changes", "keys"), OF_BODIES.values(), ids=OF_BODIES)
def test_what_a_body_has_without_need(changes: dict[str, Any], keys: list[str]) -> None:
    assert found_in(scene_of(BODY, **changes)) == keys


@pytest.mark.parametrize(("depth", "keys"), [(-0.02, ["interface"]), (-0.08, [])])
def test_a_rigid_body_on_a_path_above_all_grains(depth: float, keys: list[str]) -> None:
    """Grains stand up to 0.014 m, the beam's lower face at 0.07 m."""
    rigid = {
        "structure": {
            "kind": "rigid",
            "beam": {"length": 0.01, "height": 0.01, "along": 2, "across": 1},
            "placement": {"x": 0.015, "y": 0.085},
            "path": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, depth]]},
        },
        "interface": {"per_facet": 3, "boundaries": ["bottom"]},
    }
    assert found_in(scene_of(GRAINS, **rigid)) == keys


def test_frames_by_default_are_told_and_frames_that_are_asked_for_are_not() -> None:
    assert found_in(scene_of(GRAINS, output=None)) == ["output.frames_per_second"]
    assert found_in(scene_of(GRAINS, output={"frames_per_second": 20.0})) == []


MATERIAL = PlaneStrain(youngs_modulus=1e9, poissons_ratio=0.3, density=1000.0)
P = 10.0


def strain_and_deflection(mesh: meshes.StructureMesh, loads: list[Any]) -> tuple[float, float]:
    """Largest strain and range of the displacement by finite elements, the body at rest under balanced loads."""
    body = ElasticStructure(mesh, material=MATERIAL, time_step=1e-4, loads=loads, element="standard")
    moved = body.static_displacement()
    body.set_initial(displacement=moved)
    return body.peaks().strain, float(np.ptp(moved[:, 1]))


def test_estimated_strain_of_a_beam_is_near_that_of_finite_elements() -> None:
    """Bent by three points, at the height of the axis. The estimate leaves out 1/(1 - nu^2) and adds P/(E h)."""
    shape = {"length": 0.2, "height": 0.02, "along": 32, "across": 4, "order": 2}
    loads = [PointLoad(point=(x, 0.0), force=(0.0, f)) for x, f in ((0.0, -P), (-0.1, P / 2), (0.1, P / 2))]
    mesh = meshes.beam(**shape, origin=(-0.1, -0.01))
    strain, deflection = strain_and_deflection(mesh, loads)
    tables = {
        "structure": {"beam": shape, "loads": [{"kind": "boundary", "boundary": "top", "total_force": [0.0, -P]}]}
    }
    found = estimate(scene_of(BODY, **tables))
    assert found.force == P
    assert 1.0 < found.strain / strain < 1.3
    # P L^3/(48 E I): no shear, which adds 3 % here, and no 1 - nu^2, which takes 9 %.
    assert 1.0 < found.deflection / deflection < 1.3


def test_estimated_strain_of_a_ring_is_not_less_than_that_of_finite_elements() -> None:
    """Pinched by two points, and under a pressure that makes no bending: there the estimate is far on the safe side."""
    shape = {"outer_radius": 0.05, "inner_radius": 0.046, "around": 60, "layers": 2, "order": 2}
    mesh = meshes.tube(**shape)
    pinch = [PointLoad(point=(0.0, y), force=(0.0, f)) for y, f in ((0.048, -P), (-0.048, P))]
    for loads, table, most in (
        (pinch, {"kind": "boundary", "boundary": "outer", "total_force": [0.0, -P]}, 1.5),
        (
            [Pressure(boundary="outer", pressure=100.0)],
            {"kind": "pressure", "boundary": "outer", "pressure": 100.0},
            100.0,
        ),
    ):
        strain, _ = strain_and_deflection(mesh, loads)
        body = {key: value for key, value in BODY["structure"].items() if key != "beam"}
        tables = {key: value for key, value in BODY.items() if key in ("title", "time")}
        scene = Scene.model_validate(tables | {"structure": body | {"tube": shape, "loads": [table]}})
        assert 1.0 < estimate(scene).strain / strain < most


def test_shares_are_those_of_the_parts() -> None:
    scene = scene_of(GRAINS, contact=ROLLING)
    found = shares(scene, Trial(whole=1e-3, grains=1e-3, structure=0.0, exchange=0.0, n_free=12))
    assert sum(found.values()) == pytest.approx(1.0, abs=1e-12)  # sums of ten numbers
    assert found["friction"] > found["rolling resistance"] > found["walls"] > 0.0
    body = scene_of(BODY)
    found = shares(body, Trial(whole=4e-5, grains=1e-5, structure=2e-5, exchange=1e-5, n_free=0))
    assert found["elastic structure"] == pytest.approx(0.5, abs=1e-12)
    assert found["glued interface"] == pytest.approx(0.25, abs=1e-12)


def test_measured_shares_are_of_what_can_be_taken_out() -> None:
    """300 discs pressed together; the numbers are those of the machine, but friction is never free."""
    many = {"sizes": [{"radius": 2e-3, "count": 300}], "spacing": 1.0, "jitter": 0.0}
    box = {"width": 0.06, "height": 0.2}
    scene = scene_of(GRAINS, grains=many, box=box, contact=ROLLING | {"rolling_friction": 0.1}, gravity=[0.0, -1e3])
    measured = measured_shares(scene, None)
    assert set(measured) == {"friction", "rolling resistance", "walls"}
    assert all(one.low <= one.share <= one.high < 1.0 for one in measured.values())
    assert measured["friction"].share > 0.0
    rows = need_rows(scene, [], Trial(1e-5, 1e-5, 0.0, 0.0, 300), measured)
    assert any("measured" in value for _, name, value in rows if name == "friction")
    assert ("leaves out", "") in [row[:2] for row in rows]
