"""Numbers that are not finite are named, and round-off neither refuses a sound body nor moves one."""

from __future__ import annotations

import numpy as np
import pytest

import meshes
from structure import BodyForce, ElasticStructure, FreeRigid, PlaneStrain, PointLoad, PrescribedRigid, StructureError

STEP = 1e-5
LAST = 2  # of the steps before the bad one
BODIES = ("linear", "corotational", "large_strain", "without ledger", "free rigid", "prescribed")


def bar(**scale: float) -> meshes.StructureMesh:
    size = scale.get("size", 1.0)
    return meshes.beam(length=size, height=0.1 * size, along=10, across=1)


def body(kind: str, loads: tuple = ()) -> ElasticStructure | FreeRigid | PrescribedRigid:
    if kind == "free rigid":
        return FreeRigid(bar(), density=1000.0, time_step=STEP, loads=loads)
    if kind == "prescribed":
        return PrescribedRigid(bar(), path=[[0, 0, 0], [1, 0, 1]], time_step=STEP)
    theory = "linear" if kind == "without ledger" else kind
    material = PlaneStrain(youngs_modulus=1e9, poissons_ratio=0.3, density=1000.0)
    options = {"theory": theory, "ledger": kind != "without ledger"}
    return ElasticStructure(bar(), material=material, time_step=STEP, loads=loads, **options)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of the infinity that is asked for
@pytest.mark.parametrize("number", [np.nan, np.inf])
@pytest.mark.parametrize("kind", BODIES)
def test_a_force_that_is_no_number_is_named_with_its_node_and_time(kind: str, number: float) -> None:
    moving = body(kind)
    force = np.zeros_like(moving.polyline.points)
    for _ in range(LAST):
        moving.advance(force)
    force[7, 1] = number
    with pytest.raises(StructureError, match=rf"t = 3e-05 s: the force on boundary node 7 is \(0, {number}\) N/m"):
        moving.advance(force)


@pytest.mark.parametrize("kind", BODIES)
def test_a_force_that_is_no_number_at_the_start_is_named(kind: str) -> None:
    moving = body(kind)
    with pytest.raises(StructureError, match=r"t = 0 s: the force on boundary node 0 is \(nan, nan\) N/m"):
        moving.begin_under(np.full_like(moving.polyline.points, np.nan))


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of the overflow that is asked for
@pytest.mark.parametrize("kind", [kind for kind in BODIES if kind not in ("prescribed", "without ledger")])
def test_a_load_beyond_all_numbers_ends_in_a_sentence(kind: str) -> None:
    """1e308 N on two nodes has works of more than 1e308 J; the turning theories find no balance before that."""
    moving = body(kind, (PointLoad(point=(0.7, 0.0), force=(0.0, 1e308)), BodyForce(acceleration=(0.0, 1e306))))
    idle = np.zeros_like(moving.polyline.points)
    with pytest.raises(StructureError, match="finite numbers|no balance|too long"):
        for _ in range(10):
            moving.advance(idle)


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("density", [1e-12, 1e12])
def test_units_do_not_matter(size: float, density: float) -> None:
    """The frequencies of a bar in units of c/L are those of 1 m and 1 kg/m3, and so is a step near the first period."""
    material = {"youngs_modulus": 3.0 * density * size**2, "poissons_ratio": 0.3, "density": density}
    seen = []
    for scale, numbers in ((1.0, {"youngs_modulus": 3.0, "poissons_ratio": 0.3, "density": 1.0}), (size, material)):
        elastic = ElasticStructure(bar(size=scale), material=PlaneStrain(**numbers), time_step=0.1)
        elastic.release_from_mode(1, 1e-3 * scale)
        for _ in range(20):
            elastic.advance(np.zeros_like(elastic.polyline.points))
        seen.append([*elastic.frequencies(3), *(elastic.boundary_displacement.ravel() / scale)])
    # The eigensolver's own tolerance for the shape, relative to displacements of 1e-3.
    np.testing.assert_allclose(seen[1], seen[0], rtol=1e-7, atol=1e-10)


@pytest.mark.parametrize(("stiffness", "refused"), [(1e17, False), (1e20, True)])
def test_a_step_that_loses_the_rigid_motion_is_refused_when_asked(stiffness: float, refused: bool) -> None:
    """What is not refused falls and turns as a rigid body does to 1e-3; what is, turns off by 1 % and more."""
    mesh = meshes.beam(length=0.2, height=0.02, along=10, across=2)
    loads = (BodyForce(acceleration=(0.0, -9.81)), PointLoad(point=(0.2, 0.0), force=(0.0, 10.0)))
    material = PlaneStrain(youngs_modulus=stiffness, poissons_ratio=0.3, density=2700.0)
    elastic = ElasticStructure(mesh, material=material, time_step=5e-5, loads=loads)
    rigid = FreeRigid(mesh, density=2700.0, time_step=5e-5, loads=loads)
    for _ in range(500):
        for moving in (elastic, rigid):
            moving.advance(np.zeros_like(mesh.outer_polyline.points))
    fall = abs((elastic.centroid() - rigid.centroid())[1] / rigid.centroid()[1])
    turn = abs(elastic.mean_rotation() / rigid.mean_rotation() - 1.0)
    assert turn > 0.01 if refused else max(fall, turn) < 1e-3
    if refused:
        with pytest.raises(StructureError, match="above 1e\\+09, where round-off moves the body"):
            elastic.require_resolved()
    else:
        elastic.require_resolved()


@pytest.mark.parametrize("saved_by", BODIES[:3] + BODIES[4:])
@pytest.mark.parametrize("kind", BODIES[:3] + BODIES[4:])
def test_a_state_goes_back_into_a_kind_that_keeps_the_same(saved_by: str, kind: str) -> None:
    """The two theories that turn keep the same arrays, and may take over from each other."""
    saved, moving = body(saved_by), body(kind)
    saved.advance(np.zeros_like(saved.polyline.points))
    if saved_by == kind or {saved_by, kind} == {"corotational", "large_strain"}:
        moving.restore(saved.state())
        np.testing.assert_array_equal(moving.boundary_displacement, saved.boundary_displacement)
        return
    with pytest.raises(StructureError, match="it is that of another theory, scheme or kind of structure"):
        moving.restore(saved.state())


def test_a_stiff_bar_falls_and_turns_as_a_rigid_one() -> None:
    """A push at one end for 2000 steps, of a matrix that stands 1e9 over the mass.

    K knows a turn to 16 digits only: a stiffness of 1e-16 K that is left over would hold it as a spring, with an error
    that grows with the square of the steps, to 5e-2 of the turn and 4e-3 of the fall here.
    """
    steps, push, step, length = 2000, 7e-6, 5e-5, 0.2
    material = PlaneStrain(youngs_modulus=7e10, poissons_ratio=0.3, density=1.8e-3)
    light = ElasticStructure(
        meshes.beam(length=length, height=0.02, along=10, across=2),
        material=material,
        time_step=step,
        loads=[BodyForce(acceleration=(0.0, -9.81)), PointLoad(point=(length, 0.01), force=(0.0, push))],
    )
    light.require_resolved()
    start, idle = light.centroid()[1], np.zeros_like(light.polyline.points)
    for _ in range(steps):
        light.advance(idle)
    mass, time = light.mass, steps * step
    inertia = mass * (length**2 + 0.02**2) / 12
    fall = 0.5 * (9.81 - push / mass) * time**2
    # The linear theory shows the arc tangent of an angle. Its solver's round-off, 2e-16 of 1e9 in every step, adds up.
    turn = 0.5 * push * 0.5 * length / inertia * time**2
    assert turn > 0.01
    assert start - light.centroid()[1] == pytest.approx(fall, rel=1e-4)
    assert np.tan(light.mean_rotation()) == pytest.approx(turn, rel=1e-3)
