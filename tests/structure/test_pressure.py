"""Pressure: resultants of closed and open boundaries, Lame's ring, rigid bodies, work."""

import math

import meshes
import numpy as np
import pytest
from held import moved
from moving import cross, turned
from scipy.integrate import solve_ivp
from structure import ElasticStructure, FreeRigid, PlaneStrain, Pressure, Ramp, StructureError
from structure.discrete import DiscreteBody
from structure.loads.vectors import LoadVectors
from structure.loads.pressure import PressedBoundary

KINDS = [("quadrilateral", 1), ("triangle", 1), ("quadrilateral", 2), ("triangle", 2)]


def pressed(mesh: meshes.StructureMesh, boundary: str, pressure: float = 7.0) -> PressedBoundary:
    return PressedBoundary(DiscreteBody(mesh, 1.0), Pressure(boundary=boundary, pressure=pressure))


@pytest.mark.parametrize(("cell", "order"), KINDS)
@pytest.mark.parametrize("boundary", ["outer", "inner"])
def test_a_closed_boundary_of_any_shape_is_in_balance(cell: str, order: int, boundary: str) -> None:
    mesh = meshes.tube(outer_radius=1.0, inner_radius=0.6, cell=cell, order=order, centre=(3.0, -2.0))
    load = pressed(mesh, boundary)
    rng = np.random.default_rng(1)
    displacement = 0.3 * rng.normal(size=(len(load.nodes), 2))
    force = load.force(displacement)
    scale = np.abs(force).sum()
    eps = np.finfo(float).eps
    assert np.abs(force.sum(axis=0)).max() < 10 * eps * scale
    assert abs(cross(mesh.points[load.nodes] + displacement, force)) < 100 * eps * scale


@pytest.mark.parametrize(("cell", "order"), KINDS)
@pytest.mark.parametrize("boundary", ["outer", "inner", "loaded_arc", "free_arc"])
def test_pressure_on_a_tube_is_that_on_its_chords(cell: str, order: int, boundary: str) -> None:
    """Resultant on an arc: pressure times the chord between its ends, whatever the curve; inwards is pressed."""
    mesh = meshes.tube(outer_radius=1.0, inner_radius=0.6, cell=cell, order=order)
    load = pressed(mesh, boundary)
    force, places = load.force(), mesh.points[load.nodes]
    chord = 2 * math.sin(math.pi / 3) if boundary.endswith("arc") else 0.0
    sign = -1.0 if boundary == "loaded_arc" else 1.0
    np.testing.assert_allclose(force.sum(axis=0), [0.0, sign * 7.0 * chord], atol=1e-13)
    if order == 1:  # each node of a regular polygon along its own radius, half a facet on either side
        radial = np.sum(force * places, axis=1) / np.hypot(*places.T)
        whole = np.abs(radial).max()
        r = 0.6 if boundary == "inner" else 1.0
        assert whole == pytest.approx(7.0 * 2 * r * math.sin(math.pi / 30) * math.cos(math.pi / 30), rel=1e-12)
    assert np.all(np.sign(np.sum(force * places, axis=1)) == (1.0 if boundary == "inner" else -1.0))


@pytest.mark.parametrize(("cell", "order"), KINDS)
def test_follower_turns_with_the_shape_and_the_other_does_not(cell: str, order: int) -> None:
    mesh = meshes.tube(outer_radius=1.0, inner_radius=0.6, cell=cell, order=order)
    load, angle = pressed(mesh, "loaded_arc"), 0.8
    places = mesh.points[load.nodes]
    rigid = turned(places, angle) - places + [5.0, 3.0]
    np.testing.assert_allclose(load.force(rigid), turned(load.force(), angle), atol=1e-12)
    body = DiscreteBody(mesh, 1.0)
    pair = [
        LoadVectors(body, [Pressure(boundary="loaded_arc", pressure=7.0, follows=follows)]) for follows in (False, True)
    ]
    everywhere = body.nodes.share(turned(mesh.points, angle) - mesh.points)
    down, along = (loads.resultant(0.0, everywhere) for loads in pair)
    np.testing.assert_allclose(down, [0.0, -7.0 * math.sqrt(3)], atol=1e-12)
    np.testing.assert_allclose(along, turned(down[None, :], angle)[0], atol=1e-12)


@pytest.mark.parametrize(
    ("cell", "order", "element", "expected"),
    [
        ("quadrilateral", 1, "standard", 2.0),
        ("quadrilateral", 1, "enhanced", 2.0),
        ("triangle", 1, "standard", 2.0),
        ("quadrilateral", 2, "standard", 4.0),
        ("triangle", 2, "standard", 3.0),
    ],
)
def test_thick_ring_is_lames(cell: str, order: int, element: str, expected: float, aluminium: PlaneStrain) -> None:
    """``u = (1 + nu)/E ((1 - 2 nu) A r + B/r)``, stresses ``A -+ B/r^2``, under pressure inside and outside."""
    a, b, inside, outside = 0.5, 1.0, 3e6, 1e6
    big_a, big_b = (inside * a**2 - outside * b**2) / (b**2 - a**2), (inside - outside) * (a * b) ** 2 / (b**2 - a**2)
    young, nu = aluminium.youngs_modulus, aluminium.poissons_ratio
    errors, stress = [], []
    for around in (16, 32, 64):
        mesh = meshes.tube(outer_radius=b, inner_radius=a, around=around, layers=around // 8, cell=cell, order=order)
        loads = [Pressure(boundary="inner", pressure=inside), Pressure(boundary="outer", pressure=outside)]
        body = ElasticStructure(mesh, material=aluminium, time_step=1.0, loads=loads, element=element)
        u = body.static_displacement()
        r = np.hypot(*mesh.points.T)
        exact = (1 + nu) / young * ((1 - 2 * nu) * big_a * r + big_b / r)
        radial = np.sum(u * mesh.points, axis=1) / r
        errors.append(np.sqrt(np.mean((radial - exact) ** 2)) / np.abs(exact).max())
        body.set_initial(displacement=u)
        fields = body.fields().point_data
        trace, middle = fields["sigma_xx"] + fields["sigma_yy"], np.isclose(r, 0.75)
        stress.append(np.abs(trace[middle] - 2 * big_a).max() / (abs(big_a) + abs(big_b) / a**2))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    # The polygon and the displacement are of order 2, curved cells of order 3, and 4 in the nodes of quadrilaterals.
    assert rates[-1] == pytest.approx(expected, abs=0.1)
    # sigma_r + sigma_theta = 2 A everywhere; nodal averages inside are of order 2, less on irregular triangles
    assert np.log2(stress[-2] / stress[-1]) > 1.5 and stress[-1] < 0.01


def skewed_bar() -> meshes.StructureMesh:
    """A parallelogram 2 x 0.5 whose upper side lies 0.3 to the right of the lower one."""
    mesh = meshes.beam(length=2.0, height=0.5, along=8, origin=(-1.0, -0.25))
    x, y = mesh.points.T
    return moved(mesh, np.column_stack([x + 0.6 * y, y]))


@pytest.mark.parametrize("follows", [False, True])
def test_pressure_on_a_free_rigid_body(follows: bool) -> None:
    """Against the equations of motion: force p L down on the upper side, 0.15 right of the centroid."""
    pressure, span, turn_rate = 4.0, 1.5, 1.0
    inertia = 3.0 * 1.0 * ((2.0**2 + 0.5**2) / 12 + 0.3**2 / 12)  # parallelogram: sheared in x
    mass, push, lever = 3.0, np.array([0.0, -2.0 * pressure]), np.array([0.15, 0.25])

    def rates(_: float, y: np.ndarray) -> list[float]:
        c, s = np.cos(y[2]), np.sin(y[2])
        q = np.array([[c, -s], [s, c]])
        force, arm = q @ push if follows else push, q @ lever
        return [*y[3:6], *(force / mass), (arm[0] * force[1] - arm[1] * force[0]) / inertia]

    exact = solve_ivp(rates, (0, span), [0, 0, 0, 0, 0, turn_rate], rtol=1e-12, atol=1e-12).y[:, -1]
    errors = []
    for steps in (50, 100, 200):
        load = Pressure(boundary="top", pressure=pressure, follows=follows)
        body = FreeRigid(skewed_bar(), density=3.0, time_step=span / steps, loads=[load])
        body.set_initial(spin=turn_rate)
        before = body.energies()
        for _ in range(steps):
            body.advance(np.zeros_like(body.polyline.points))
        after = body.energies()
        kept = after.kinetic - after.external_work - before.kinetic
        # Turn found to 4 eps each step, at most 200 steps.
        assert abs(kept) < 1e3 * np.finfo(float).eps * after.kinetic
        errors.append(np.array([*body.centroid(), body.mean_rotation()]) - exact[:3])
        heading = turned(push[None, :], body.mean_rotation())[0] if follows else push
        np.testing.assert_allclose(body.external_force(), heading, atol=1e-12)
    errors = np.abs(errors)
    # A constant moment turns exactly, a constant force moves exactly; the rest is of order 2.
    exact_ones = errors[:, 2:] if follows else errors[:, :2]
    assert exact_ones.max() < 1e-10
    errors = errors[:, :2] if follows else errors[:, 2:]
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 2.0, atol=0.1)


def test_a_closed_follower_leaves_a_rigid_body_alone() -> None:
    mesh = meshes.tube(outer_radius=1.0, inner_radius=0.6)
    loads = [Pressure(boundary="inner", pressure=1e3, follows=True, schedule=Ramp(over=0.1))]
    body = FreeRigid(mesh, density=1.0, time_step=0.01, loads=loads)
    body.set_initial(velocity=(1.0, 2.0), spin=30.0)
    for _ in range(100):
        body.advance(np.zeros_like(body.polyline.points))
    # round-off of 1 kPa on 60 facets for a second: 1e3 N/m times 1e-15
    np.testing.assert_allclose(body.momentum(), body.mass * np.array([1.0, 2.0]), rtol=1e-11)
    assert body.mean_rotation() == pytest.approx(30.0, rel=1e-11)


@pytest.mark.parametrize("follows", [False, True])
def test_pressure_on_an_unknown_boundary_is_refused(follows: bool) -> None:
    load = Pressure(boundary="loaded_arc", pressure=1.0, follows=follows)
    with pytest.raises(StructureError, match="'loaded_arc' is not a boundary .* bottom, left, outer, right, top"):
        FreeRigid(meshes.beam(length=1.0, height=0.1), density=1.0, time_step=1.0, loads=[load])
    with pytest.raises(StructureError, match="pressure = inf"):
        Pressure(boundary="top", pressure=math.inf)
