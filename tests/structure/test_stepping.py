"""Newmark: order of the period, energy and momentum balances with loads and damping, state."""

import meshes
import numpy as np
import pytest
from moving import balance, exchanged
from structure import (
    BodyForce,
    BoundaryLoad,
    ElasticStructure,
    PlaneStrain,
    PointLoad,
    Ramp,
    Rayleigh,
    StructureError,
)


def test_period_error_is_of_order_two(aluminium: PlaneStrain) -> None:
    beam = meshes.beam(length=1.0, height=0.05, along=20)
    omega = 2 * np.pi * ElasticStructure(beam, material=aluminium, time_step=1.0).frequencies(1)[0]
    errors = []
    steps = np.array([20, 40, 80])
    for per_period in steps:
        dt = 2 * np.pi / omega / per_period
        body = ElasticStructure(beam, material=aluminium, time_step=dt)
        body.release_from_mode(1, 1e-3)
        swing = []
        for _ in range(3 * per_period):
            swing.append(body.boundary_displacement[0, 1])
            body.advance(np.zeros_like(body.polyline.points))
        turns = np.array(swing)
        # Of a discrete oscillation x_n: (x_{n+1} + x_{n-1})/2 = cos(w dt) x_n; least squares.
        inner = turns[1:-1]
        cosine = inner @ (turns[2:] + turns[:-2]) / 2 / (inner @ inner)
        errors.append(1 - np.arccos(cosine) / dt / omega)
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(rates, 2.0, atol=0.1)
    # Average acceleration lengthens the period by (w dt)^2/12, to the next order.
    np.testing.assert_allclose(errors, (2 * np.pi / steps) ** 2 / 12, rtol=0.05)


@pytest.mark.parametrize(
    ("cell", "order", "element"),
    [("quadrilateral", 1, "standard"), ("quadrilateral", 1, "enhanced"), ("triangle", 2, "standard")],
)
def test_energy_balance_closes_to_round_off(cell: str, order: int, element: str, soft: PlaneStrain) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, cell=cell, order=order)
    loads = [
        BoundaryLoad(boundary="loaded_arc", total_force=(3.0, -10.0), schedule=Ramp(over=0.02)),
        BoundaryLoad(boundary="inner", total_force=(-2.0, 1.0)),
        BodyForce(acceleration=(0.0, -9.81), schedule=Ramp(over=0.03)),
        PointLoad(point=(0.0, -0.05), force=(0.0, 15.0), schedule=Ramp(over=0.01)),
    ]
    body = ElasticStructure(
        tube,
        material=soft,
        time_step=1e-4,
        damping=Rayleigh(mass_factor=5.0, stiffness_factor=2e-4),
        loads=loads,
        element=element,
    )
    rng = np.random.default_rng(7)
    start = 1e-5 * rng.normal(size=tube.points.shape)
    body.set_initial(displacement=start, velocity=100 * start)
    before = balance(body.energies())
    for _ in range(500):
        body.advance(rng.normal(size=body.polyline.points.shape))
    after = body.energies()
    assert after.rayleigh_loss > 1e-3 * exchanged(after)
    assert abs(after.external_work) > 1e-3 * exchanged(after)
    # 500 steps of sums over some hundred terms.
    assert abs(balance(after) - before) < 1e4 * np.finfo(float).eps * exchanged(after)


def test_impulse_is_the_change_of_momentum(soft: PlaneStrain) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04)
    dt, gravity, ramp_time = 1e-4, np.array([1.0, -9.81]), 95.5e-4  # ends between two steps
    fall = BodyForce(acceleration=tuple(gravity), schedule=Ramp(over=ramp_time))
    body = ElasticStructure(tube, material=soft, time_step=dt, loads=[fall])
    rng = np.random.default_rng(3)
    last = np.zeros_like(body.polyline.points)
    impulse = np.zeros(2)
    for step in range(200):
        force = rng.normal(size=last.shape)
        body.advance(force)
        mean_ramp = np.minimum(np.array([step, step + 1]) * dt / ramp_time, 1.0).mean()
        impulse += dt * (mean_ramp * body.mass * gravity + (last + force).sum(axis=0) / 2)
        last = force
    # Round-off of K u, with E u = 7e6 N/m^2 times 1e-3 m, over 200 steps.
    np.testing.assert_allclose(body.momentum(), impulse, rtol=1e-11, atol=1e-11)


def test_free_fall_of_the_loaded_body_is_exact(soft: PlaneStrain) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04)
    fall = BodyForce(acceleration=(0.0, -9.81))
    body = ElasticStructure(tube, material=soft, time_step=1e-3, loads=[fall])
    np.testing.assert_allclose(body.external_force(), [0, -9.81 * body.mass], rtol=1e-12)
    expected = -9.81 * 0.1**2 / 2
    before = body.predict(0.1)
    for _ in range(100):
        body.advance(np.zeros_like(body.polyline.points))
    assert body.time == pytest.approx(0.1)
    # Constant acceleration is followed exactly; what is left is the round-off of the solves.
    np.testing.assert_allclose(body.centroid()[1], expected, rtol=1e-10)
    np.testing.assert_allclose(body.boundary_displacement[:, 1], expected, rtol=1e-8)
    np.testing.assert_allclose(before[:, 1], expected, rtol=1e-8)
    np.testing.assert_array_equal(body.predict(0.5, order=1), body.boundary_displacement + 0.5 * body.boundary_velocity)


def test_restored_structure_goes_on_with_the_same_bits(soft: PlaneStrain) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04)

    def build() -> ElasticStructure:
        load = BoundaryLoad(boundary="loaded_arc", total_force=(0.0, -10.0), schedule=Ramp(over=0.01))
        damping = Rayleigh(mass_factor=0.1, stiffness_factor=1e-4)
        return ElasticStructure(tube, material=soft, time_step=1e-4, damping=damping, loads=[load])

    rng = np.random.default_rng(5)
    forces = rng.normal(size=(160, *tube.outer_polyline.points.shape))
    straight, stopped = build(), build()
    for force in forces[:80]:
        straight.advance(force)
        stopped.advance(force)
    state = {name: array.copy() for name, array in stopped.state().items()}
    resumed = build()
    resumed.restore(state)
    for force in forces[80:]:
        straight.advance(force)
        resumed.advance(force)
    assert resumed.time == straight.time
    assert resumed.energies() == straight.energies()
    for name, array in straight.state().items():
        np.testing.assert_array_equal(resumed.state()[name], array, err_msg=name)
    np.testing.assert_array_equal(resumed.boundary_velocity, straight.boundary_velocity)


def test_release_from_mode_swings_in_that_mode_alone(aluminium: PlaneStrain) -> None:
    beam = meshes.beam(length=1.0, height=0.05, along=20)
    body = ElasticStructure(beam, material=aluminium, time_step=1e-5)
    frequencies = body.frequencies(3)
    assert (np.diff(frequencies) > 0).all() and frequencies[0] > 100
    body.release_from_mode(2, -2e-3)
    shape = body.fields().point_data["displacement"]
    assert np.hypot(*shape.T).max() == pytest.approx(2e-3)
    np.testing.assert_allclose(body.momentum(), 0, atol=1e-15)
    np.testing.assert_allclose(body.centroid(), [0.5, 0.025], atol=1e-12)
    # In equilibrium with M a = -omega^2 M u.
    square = (2 * np.pi * frequencies[1]) ** 2
    np.testing.assert_allclose(
        body.boundary_acceleration, -square * body.boundary_displacement, atol=1e-8 * square * 2e-3
    )


def test_ledger_can_be_left_out(soft: PlaneStrain) -> None:
    beam = meshes.beam(length=1.0, height=0.1, along=4)
    silent = ElasticStructure(beam, material=soft, time_step=1e-4, ledger=False)
    full = ElasticStructure(beam, material=soft, time_step=1e-4)
    push = np.ones_like(beam.outer_polyline.points)
    for body in (silent, full):
        body.advance(push)
    np.testing.assert_array_equal(silent.boundary_displacement, full.boundary_displacement)
    with pytest.raises(StructureError, match="ledger"):
        silent.energies()
