"""Point loads anywhere: resultant, moment and virtual work, and what is refused."""

import math

import meshes
import numpy as np
import pytest
from structure import FreeRigid, PlaneStrain, PointLoad, StructureError
from structure.discrete import DiscreteBody
from structure.loads.vectors import LoadVectors
from structure.loads.point_location import shares_at

KINDS = [("quadrilateral", 1), ("triangle", 1), ("quadrilateral", 2), ("triangle", 2)]


def ring(cell: str, order: int, around: int = 12) -> meshes.StructureMesh:
    return meshes.tube(outer_radius=1.0, inner_radius=0.6, around=around, layers=2, cell=cell, order=order)


@pytest.mark.parametrize(("cell", "order"), KINDS)
def test_shares_carry_the_force_to_its_point(cell: str, order: int) -> None:
    """Resultant and moment of any force mean: shares add up to 1, and their nodes' mean place is the point."""
    mesh, rng = ring(cell, order), np.random.default_rng(3)
    for radius, angle in zip(rng.uniform(0.62, 0.94, 60), rng.uniform(0, 2 * np.pi, 60), strict=True):
        point = (radius * math.cos(angle), radius * math.sin(angle))
        nodes, shares = shares_at(mesh, point)
        assert len(nodes) == mesh.cells.shape[1]
        assert shares.sum() == pytest.approx(1.0, abs=1e-13)
        np.testing.assert_allclose(shares @ mesh.points[nodes], point, atol=1e-12)  # Newton to 1e-14 of a cell
    node = mesh.points[17]
    nodes, shares = shares_at(mesh, tuple(node))
    assert nodes[np.argmax(shares)] == 17 and shares.max() == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(("cell", "order"), KINDS)
def test_a_point_force_does_the_work_of_its_point(cell: str, order: int) -> None:
    """On a rectangle the shape functions hold every polynomial of their order."""
    mesh = meshes.beam(length=2.0, height=1.0, along=5, across=3, cell=cell, order=order)
    point, force = (0.713, 0.377), np.array([3.0, -2.0])
    load = LoadVectors(DiscreteBody(mesh, 1.0), [PointLoad(point=point, force=tuple(force))])
    nodal = DiscreteBody(mesh, 1.0).nodes.gather(load.vectors[0])
    x, y = mesh.points.T
    powers = [(i, j) for i in range(order + 1) for j in range(order + 1 - i)]
    for i, j in powers:
        field = np.outer(x**i * y**j, [1.0, 0.5])
        expected = point[0] ** i * point[1] ** j * force @ [1.0, 0.5]
        assert np.vdot(nodal, field) == pytest.approx(expected, abs=1e-12)


def test_a_point_inside_turns_a_rigid_body_as_newton_says() -> None:
    mesh = meshes.beam(length=2.0, height=0.5, along=8, origin=(-1.0, -0.25))
    body = FreeRigid(mesh, density=3.0, time_step=1e-3, loads=[PointLoad(point=(0.63, 0.1), force=(1.0, 4.0))])
    for _ in range(10):
        body.advance(np.zeros_like(mesh.outer_polyline.points))
    torque, inertia = 0.63 * 4.0 - 0.1 * 1.0, 3.0 * (2.0**2 + 0.5**2) / 12
    # turned by 1e-5 rad over the push: the lever changes by as much
    assert body.mean_rotation() == pytest.approx(torque / inertia * 0.01**2 / 2, rel=1e-4)
    np.testing.assert_allclose(body.momentum(), [0.01, 0.04], rtol=1e-12)


@pytest.mark.parametrize("around", [6, 30])
@pytest.mark.parametrize(("cell", "order"), KINDS)
def test_a_point_of_the_circle_is_taken_to_the_nearest_facet(cell: str, order: int, around: int) -> None:
    mesh = ring(cell, order, around)
    for angle in np.linspace(0.05, 2 * np.pi, 40):
        point = np.array([math.cos(angle), math.sin(angle)])
        nodes, shares = shares_at(mesh, tuple(point))
        place = shares @ mesh.points[nodes]
        assert shares.sum() == pytest.approx(1.0, abs=1e-14)
        chord = 2 * math.pi / (around * order)
        assert np.hypot(*(place - point)) <= chord**2 / 8  # of the arc over the chord of neighbouring nodes
        # no point of the polygon is nearer
        if order == 1:
            rim = mesh.outer_polyline.points
            for start, end in zip(rim, np.roll(rim, -1, axis=0), strict=True):
                fine = start + np.linspace(0, 1, 400)[:, None] * (end - start)
                assert np.hypot(*(fine - point).T).min() >= np.hypot(*(place - point)) - 1e-12


@pytest.mark.parametrize(
    ("mesh", "point", "words"),
    [
        (lambda: ring("quadrilateral", 1), (0.0, 0.0), "0.58 m off the mesh"),
        (lambda: ring("triangle", 2), (1.05, 0.0), "the nearest is (1.0"),
        (lambda: meshes.beam(length=1.0, height=0.1, along=10), (0.5, 0.101), "0.001 m off the mesh"),
        (lambda: meshes.beam(length=1.0, height=0.1, along=10), (-0.2, -0.1), "the nearest is (0.0, 0.0)"),
    ],
)
def test_a_point_off_the_body_is_refused(mesh, point: tuple[float, float], words: str) -> None:
    body = mesh()
    with pytest.raises(StructureError) as refusal:
        shares_at(body, point)
    assert words in str(refusal.value), str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_a_point_on_a_straight_side_may_miss_it_by_round_off() -> None:
    mesh = meshes.beam(length=1.0, height=0.1, along=10, origin=(0.3, 0.7))
    nodes, shares = shares_at(mesh, (0.3 + 0.37, 0.7 + 0.1 + 1e-12))
    np.testing.assert_allclose(shares @ mesh.points[nodes], [0.67, 0.8], atol=1e-11)


@pytest.mark.parametrize(("cell", "order"), KINDS)
def test_a_point_in_a_small_body_far_from_the_origin(cell: str, order: int) -> None:
    """Millimetres at a distance of kilometres: coordinates have 1e-13 m, far more than 1e-14 of a cell."""
    mesh = meshes.beam(length=1e-3, height=3e-4, along=6, across=2, origin=(1e3, 1e3), cell=cell, order=order)
    for x, y in np.random.default_rng(2).uniform(0.05, 0.95, (20, 2)) * [1e-3, 3e-4]:
        nodes, shares = shares_at(mesh, (1e3 + x, 1e3 + y))
        np.testing.assert_allclose(shares @ (mesh.points[nodes] - 1e3), [x, y], atol=1e-12)


def test_a_point_between_cells_belongs_to_one_of_them(soft: PlaneStrain) -> None:
    """Where cells share a side, one of them alone takes the point: the force is not doubled."""
    mesh = meshes.beam(length=1.0, height=0.1, along=10, across=2)
    loads = LoadVectors(DiscreteBody(mesh, soft.density), [PointLoad(point=(0.35, 0.05), force=(0.0, 1.0))])
    np.testing.assert_allclose(loads.resultant(0.0, np.zeros(loads.vectors.shape[1])), [0.0, 1.0], atol=1e-14)
