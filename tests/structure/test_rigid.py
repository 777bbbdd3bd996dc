"""Rigid bodies: along a path, and free."""

import meshes
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from structure import BodyForce, BoundaryLoad, FreeRigid, PointLoad, PrescribedRigid, Ramp


@pytest.fixture(scope="module")
def tube() -> meshes.StructureMesh:
    return meshes.tube(outer_radius=0.05, inner_radius=0.04, centre=(0.6, 0.3))


@pytest.fixture(scope="module")
def bar() -> meshes.StructureMesh:
    return meshes.beam(length=2.0, height=0.5, along=8, origin=(-1.0, -0.25))


def test_a_free_body_answers_a_force_as_newton_says(bar: meshes.StructureMesh) -> None:
    body = FreeRigid(bar, density=1000.0, time_step=1e-4)
    at = int(np.argmax(bar.outer_polyline.points @ [1.0, 1.0]))  # the corner (1, 0.25)
    force = np.zeros_like(bar.outer_polyline.points)
    force[at] = [0.0, 5.0]
    # m = 1000, I = m (2^2 + 0.5^2)/12, torque 5 N m at arm 1 m
    spin = 5.0 / (1000.0 * (4.0 + 0.25) / 12.0)
    np.testing.assert_allclose(body.acceleration_by(force)[at], [-0.25 * spin, 5e-3 + 1.0 * spin], rtol=1e-12)


def test_path_is_followed(tube: meshes.StructureMesh) -> None:
    path = [(0, 0, 0), (1, 0, -0.1), (3, 0.2, -0.1)]
    body = PrescribedRigid(tube, path=path, time_step=0.125)
    assert body.mass == 0.0 and not body.acceleration_by(np.ones_like(body.polyline.points)).any()
    silent = np.zeros_like(tube.outer_polyline.points)
    np.testing.assert_allclose(body.boundary_velocity, np.tile([0, -0.1], (30, 1)), atol=1e-15)
    ahead = body.predict(1.5)
    for _ in range(8):
        body.advance(silent)
    np.testing.assert_allclose(body.boundary_displacement, np.tile([0, -0.1], (30, 1)), atol=1e-15)
    np.testing.assert_allclose(body.boundary_velocity, np.tile([0.1, 0], (30, 1)), atol=1e-15)
    for _ in range(4):
        body.advance(silent)
    np.testing.assert_allclose(body.boundary_displacement, ahead, atol=1e-15)
    np.testing.assert_allclose(body.centroid(), [0.65, 0.2], atol=1e-12)
    for _ in range(20):
        body.advance(silent)
    end = np.tile([0.2, -0.1], (30, 1))
    np.testing.assert_allclose(body.boundary_displacement, end, atol=1e-15)
    np.testing.assert_array_equal(body.boundary_velocity, 0)
    assert body.mean_rotation() == 0.0 and body.peaks().von_mises == 0.0
    assert not body.fields().point_data["sigma_xx"].any()


def test_work_on_the_path_is_force_times_way(tube: meshes.StructureMesh) -> None:
    path = [(0, 0, 0), (1, 0, -0.1)]
    body = PrescribedRigid(tube, path=path, time_step=1e-2, density=2700.0)
    push = np.tile([0.0, 2.0], (30, 1))  # 60 N upwards on a body that goes down
    for _ in range(200):
        body.advance(push)
    np.testing.assert_allclose(body.external_force(), [0, -60])
    energies = body.energies()
    # Trapezoid from zero force at the start: half of the first step is missing.
    assert energies.boundary_work == pytest.approx(-60 * (0.1 - 0.5e-3), rel=1e-12)
    start = body.mass * 0.1**2 / 2
    kept = energies.kinetic - energies.external_work - energies.boundary_work
    assert kept == pytest.approx(start, rel=1e-12)


def test_throw_is_a_parabola(tube: meshes.StructureMesh) -> None:
    gravity = BodyForce(acceleration=(0.0, -9.81))
    body = FreeRigid(tube, density=2700.0, time_step=0.01, loads=[gravity])
    body.set_initial(velocity=(2.0, 3.0), spin=50.0)
    start = body.energies()
    ahead = body.predict(1.0)
    for _ in range(100):
        body.advance(np.zeros_like(tube.outer_polyline.points))
    # Average acceleration is exact for a constant force, and so is a steady spin.
    np.testing.assert_allclose(body.centroid(), [2.6, 0.3 + 3.0 - 9.81 / 2], rtol=1e-12)
    assert body.mean_rotation() == pytest.approx(50.0, rel=1e-12)
    np.testing.assert_allclose(ahead, body.boundary_displacement, atol=1e-11)
    np.testing.assert_allclose(body.momentum(), body.mass * np.array([2.0, 3.0 - 9.81]), rtol=1e-12)
    end = body.energies()
    assert end.kinetic - end.external_work == pytest.approx(start.kinetic, rel=1e-12)
    # Every boundary node keeps its distance and moves at right angles to its arm.
    arms = tube.outer_polyline.points + body.boundary_displacement - body.centroid()
    np.testing.assert_allclose(np.hypot(*arms.T), 0.05, rtol=1e-12)
    relative = body.boundary_velocity - body.momentum() / body.mass
    np.testing.assert_allclose(np.sum(arms * relative, axis=1), 0, atol=1e-12)
    np.testing.assert_allclose(np.hypot(*relative.T), 50.0 * 0.05, rtol=1e-10)


def test_mass_and_inertia_of_a_rectangle(bar: meshes.StructureMesh) -> None:
    body = FreeRigid(bar, density=3.0, time_step=1.0)
    assert body.mass == pytest.approx(3.0, rel=1e-12)
    assert body.inertia == pytest.approx(3.0 * (2.0**2 + 0.5**2) / 12, rel=1e-12)


def test_pulled_pendulum_meets_the_differential_equation(bar: meshes.StructureMesh) -> None:
    """A force of fixed direction on one corner: a translating pendulum, order 2 in the step."""
    force, corner = np.array([3.0, -5.0]), np.array([1.0, 0.25])
    inertia, span = 3.0 * (2.0**2 + 0.5**2) / 12, 2.0

    def rates(_: float, y: np.ndarray) -> list[float]:
        c, s = np.cos(y[0]), np.sin(y[0])
        x, z = corner
        return [y[1], ((c * x - s * z) * force[1] - (s * x + c * z) * force[0]) / inertia]

    exact = solve_ivp(rates, (0, span), [0.3, 2.0], rtol=1e-12, atol=1e-12).y[:, -1]
    node = np.argmin(np.hypot(*(bar.outer_polyline.points - corner).T))
    nodal = np.zeros_like(bar.outer_polyline.points)
    nodal[node] = force
    errors = []
    for steps in (50, 100, 200):
        body = FreeRigid(bar, density=3.0, time_step=span / steps)
        body.set_initial(spin=2.0, angle=0.3, boundary_force=nodal)
        for _ in range(steps):
            body.advance(nodal)
        errors.append(abs(body.mean_rotation() - exact[0]))
        same = FreeRigid(
            bar,
            density=3.0,
            time_step=span / steps,
            loads=[PointLoad(point=tuple(corner), force=tuple(force))],
        )
        same.set_initial(spin=2.0, angle=0.3)
        for _ in range(steps):
            same.advance(np.zeros_like(nodal))
        assert same.mean_rotation() == pytest.approx(body.mean_rotation(), rel=1e-10)
    rates_found = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(rates_found, 2.0, atol=0.1)


def test_energy_balance_of_a_tumbling_body(bar: meshes.StructureMesh) -> None:
    loads = [
        BoundaryLoad(boundary="right", total_force=(1.0, 4.0), schedule=Ramp(over=0.5)),
        BodyForce(acceleration=(0.0, -1.0)),
    ]
    body = FreeRigid(bar, density=3.0, time_step=0.01, loads=loads)
    body.set_initial(spin=-3.0)
    start = body.energies().kinetic
    rng = np.random.default_rng(2)
    nodal_work, last = 0.0, np.zeros_like(bar.outer_polyline.points)
    for _ in range(300):
        before, force = body.boundary_displacement, rng.normal(size=last.shape)
        body.advance(force)
        nodal_work += np.vdot(last + force, body.boundary_displacement - before) / 2
        last = force
    energies = body.energies()
    scale = energies.kinetic + abs(energies.external_work) + abs(energies.boundary_work)
    kept = energies.kinetic - energies.external_work - energies.boundary_work
    # Turn found to 4 eps each step, 300 steps.
    assert abs(kept - start) < 1e4 * np.finfo(float).eps * scale
    assert abs(energies.boundary_work - nodal_work) < 1e4 * np.finfo(float).eps * scale


@pytest.mark.parametrize("kind", ["prescribed", "free"])
def test_restored_body_goes_on_with_the_same_bits(kind: str, tube: meshes.StructureMesh) -> None:
    def build() -> PrescribedRigid | FreeRigid:
        if kind == "prescribed":
            return PrescribedRigid(tube, path=[(0, 0, 0), (1, 0.3, -0.1)], time_step=0.01)
        load = BoundaryLoad(boundary="loaded_arc", total_force=(1.0, -4.0), schedule=Ramp(over=0.3))
        return FreeRigid(tube, density=2700.0, time_step=0.01, loads=[load])

    forces = np.random.default_rng(4).normal(size=(40, *tube.outer_polyline.points.shape))
    straight, resumed = build(), build()
    for force in forces[:20]:
        straight.advance(force)
    resumed.restore({name: array.copy() for name, array in straight.state().items()})
    for force in forces[20:]:
        straight.advance(force)
        resumed.advance(force)
    assert resumed.energies() == straight.energies() and resumed.time == straight.time
    for name, array in straight.state().items():
        np.testing.assert_array_equal(resumed.state()[name], array)
    np.testing.assert_array_equal(resumed.boundary_acceleration, straight.boundary_acceleration)
