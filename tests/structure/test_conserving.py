"""The steps of the theories that are not linear: energy, momenta, order, small motion, resumption, refusals."""

import numpy as np
import pytest
from moving import Scales, balance, exchanged, quarter

import meshes
from structure import (
    BodyForce,
    BoundaryLoad,
    ElasticStructure,
    Newmark,
    PlaneStrain,
    PointLoad,
    Pressure,
    Ramp,
    Rayleigh,
    StructureError,
)

NONLINEAR = ("corotational", "large_strain")


@pytest.fixture(scope="module")
def tube() -> meshes.StructureMesh:
    return meshes.tube(outer_radius=0.05, inner_radius=0.04)


def thrown(body: ElasticStructure, *, spin: float, shake: float, seed: int = 7) -> None:
    """Set free with a spin [rad/s], a velocity, and nodal velocities at random [m/s]."""
    points = body.mesh.points
    noise = np.random.default_rng(seed).normal(size=points.shape)
    body.set_initial(velocity=spin * quarter(points) + [0.3, -0.2] + shake * noise)


@pytest.mark.parametrize("theory", NONLINEAR)
@pytest.mark.parametrize(("cell", "order"), [("quadrilateral", 1), ("triangle", 2)])
def test_energy_balance_closes_to_round_off(theory: str, cell: str, order: int, soft: PlaneStrain) -> None:
    """Random forces, loads, damping, turns beyond a whole one."""
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, around=16, layers=1, cell=cell, order=order)
    loads = [
        BoundaryLoad(boundary="loaded_arc", total_force=(3.0, -10.0), schedule=Ramp(over=0.02)),
        BodyForce(acceleration=(0.0, -9.81), schedule=Ramp(over=0.03)),
        Pressure(boundary="inner", pressure=100.0, follows=True, schedule=Ramp(over=0.02)),
        PointLoad(point=(0.0, -0.05), force=(0.0, 15.0), schedule=Ramp(over=0.01)),
    ]
    damping = Rayleigh(mass_factor=2.0, stiffness_factor=2e-4)
    body = ElasticStructure(tube, material=soft, time_step=5e-4, damping=damping, loads=loads, theory=theory)
    thrown(body, spin=40.0, shake=0.02)
    before = balance(body.energies())
    rng = np.random.default_rng(3)
    for _ in range(400):
        body.advance(rng.normal(size=body.polyline.points.shape))
    after = body.energies()
    assert abs(body.mean_rotation()) > 5.0
    assert after.rayleigh_loss > 1e-2 * exchanged(after)
    assert abs(after.external_work) > 1e-2 * exchanged(after)
    # 400 steps of sums over some hundred terms, each solved to round-off.
    assert abs(balance(after) - before) < 1e4 * np.finfo(float).eps * exchanged(after)


@pytest.mark.parametrize("theory", NONLINEAR)
def test_a_thousand_steps_keep_energy_and_momenta(theory: str, soft: PlaneStrain) -> None:
    """Steps of 60 over the fastest mode's frequency [1/s] and 0.1 rad of spin: far from resolved, yet kept."""
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, around=12, layers=1)
    body = ElasticStructure(tube, material=soft, time_step=2e-3, theory=theory, element="standard")
    assert 2 * np.pi * body.frequencies(20)[-1] * body.time_step > 10
    thrown(body, spin=50.0, shake=0.3)
    scales = Scales(body)
    start = body.energies()
    turning, momentum = scales.angular_momentum(), body.momentum()
    silent, strains = np.zeros_like(body.polyline.points), []
    for _ in range(1000):
        body.advance(silent)
        strains.append(body.energies().strain)
    # A good part of the shaking is strain, and keeps coming and going.
    assert np.ptp(strains[500:]) > 1e-3 * start.kinetic
    assert body.mean_rotation() > 10 * 2 * np.pi
    # 1000 steps, each solved to some tens of round-offs.
    noise = 1e5 * np.finfo(float).eps
    assert abs(balance(body.energies()) - balance(start)) < noise * start.kinetic
    np.testing.assert_allclose(body.momentum(), momentum, rtol=noise)
    # The arm of the momentum is the way of the body, half a metre by now.
    assert scales.angular_momentum() == pytest.approx(turning, rel=noise)


def spun(theory: str, material: PlaneStrain, tube: meshes.StructureMesh, per_step: float) -> ElasticStructure:
    """A tube that spins by so many radians a step, slowly enough to stay round."""
    body = ElasticStructure(tube, material=material, time_step=per_step, theory=theory, element="standard")
    body.set_initial(velocity=quarter(tube.points))
    return body


@pytest.mark.parametrize("theory", NONLINEAR)
def test_a_turn_lags_by_a_twelfth_of_the_square_of_that_of_a_step(
    theory: str, soft: PlaneStrain, tube: meshes.StructureMesh
) -> None:
    """The mean of two velocities is shorter than each, the chord of a turn too: together ``1 - (omega dt)^2/12``."""
    lags, turns = [], np.array([0.1, 0.2, 0.3])
    for per_step in turns:
        body = spun(theory, soft, tube, per_step)
        for _ in range(20):
            body.advance(np.zeros_like(body.polyline.points))
        lags.append(1.0 - body.mean_rotation() / (20 * per_step))
    # The next term of the series is (omega dt)^4/80: 1.4 % of the first at 0.3 rad; the tube is wider by 1e-6.
    np.testing.assert_allclose(np.array(lags) / (turns**2 / 12), 1.0, atol=0.02)


@pytest.mark.parametrize("theory", NONLINEAR)
def test_a_step_that_turns_too_far_is_refused_with_one_that_does_not(
    theory: str, soft: PlaneStrain, tube: meshes.StructureMesh
) -> None:
    body = spun(theory, soft, tube, 0.4)
    # 2 atan(0.2) = 0.3948 rad
    with pytest.raises(StructureError, match=r"turns by 0.395 rad .* above 0.35, .* lags behind by 1.3 %: .* 0.35 s"):
        body.advance(np.zeros_like(body.polyline.points))


@pytest.mark.parametrize("theory", NONLINEAR)
def test_order_in_time_is_two(theory: str, soft: PlaneStrain) -> None:
    """Differences of successive halvings, all modes resolved, of a tube that is bent and turns by 0.1 rad."""
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, around=8, layers=1)
    ends = []
    for steps in (100, 200, 400, 800):
        body = ElasticStructure(tube, material=soft, time_step=5e-4 / steps, theory=theory, element="standard")
        body.release_from_mode(1, 2e-3)
        shape = body.fields().point_data["displacement"]
        body.set_initial(displacement=shape, velocity=200.0 * quarter(tube.points + shape))
        for _ in range(steps):
            body.advance(np.zeros_like(body.polyline.points))
        ends.append(np.concatenate([body.boundary_displacement, 1e-3 * body.boundary_velocity]))
    gaps = [np.linalg.norm(ends[k + 1] - ends[k]) for k in range(3)]
    np.testing.assert_allclose(np.log2(np.divide(gaps[:-1], gaps[1:])), 2.0, atol=0.1)


@pytest.mark.parametrize("theory", NONLINEAR)
def test_small_motion_is_that_of_the_linear_theory(theory: str, soft: PlaneStrain) -> None:
    """The difference falls with the square of the amplitude."""
    beam = meshes.beam(length=1.0, height=0.1, along=10)
    damping = Rayleigh(mass_factor=2.0, stiffness_factor=1e-4)
    rng = np.random.default_rng(5)
    pushes = rng.normal(size=(40, *beam.outer_polyline.points.shape))
    gaps = []
    for amplitude in (40.0, 20.0, 10.0):
        ends = []
        for name in ("linear", theory):
            body = ElasticStructure(
                beam, material=soft, time_step=1e-3, damping=damping, theory=name, element="standard"
            )
            for push in pushes:
                body.advance(amplitude * push)
            ends.append((body.boundary_displacement, body.boundary_acceleration))
        gaps.append([np.abs(b - a).max() for a, b in zip(*ends, strict=True)])
    assert gaps[0][0] > 1e-8
    rates = np.log2(np.divide(gaps[:-1], gaps[1:]))
    np.testing.assert_allclose(rates, 2.0, atol=0.1)


@pytest.mark.parametrize("theory", NONLINEAR)
def test_prediction_does_not_ring(theory: str, soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    """A tube spun up in no time, its breathing over-damped: after the shock the predictor sees the turning alone."""
    body = ElasticStructure(tube, material=soft, time_step=1e-3, damping=Rayleigh(stiffness_factor=2e-3), theory=theory)
    spin, silent = 50.0, np.zeros_like(body.polyline.points)
    body.set_initial(velocity=spin * quarter(tube.points))
    for _ in range(600):
        body.advance(silent)
    ahead = body.predict(body.time_step)
    body.advance(silent)
    # u + dt v + dt^2 a/2 leaves the third order of a turn by 0.05 rad; a ringing acceleration left 5e-5 m.
    third = 0.05 * (spin * body.time_step) ** 3 / 6
    assert np.hypot(*(ahead - body.boundary_displacement).T).max() < 4 * third


@pytest.mark.parametrize("theory", NONLINEAR)
def test_motion_does_not_know_where_space_points(theory: str, soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    """Turned, and pushed by turned forces, the body moves as before, turned."""
    turn = np.array([[np.cos(2.0), -np.sin(2.0)], [np.sin(2.0), np.cos(2.0)]])
    damping = Rayleigh(stiffness_factor=1e-4)
    bodies = [ElasticStructure(tube, material=soft, time_step=2e-4, damping=damping, theory=theory) for _ in range(2)]
    start = 1e-4 * np.random.default_rng(1).normal(size=tube.points.shape)
    bodies[0].set_initial(displacement=start)
    bodies[1].set_initial(displacement=(tube.points + start) @ turn.T - tube.points)
    rng = np.random.default_rng(2)
    for _ in range(100):
        push = 3.0 * rng.normal(size=bodies[0].polyline.points.shape)
        bodies[0].advance(push)
        bodies[1].advance(push @ turn.T)
    outer = tube.outer_polyline.points
    expected = (outer + bodies[0].boundary_displacement) @ turn.T - outer
    # 100 steps of round-off of places, of 0.05 m.
    np.testing.assert_allclose(bodies[1].boundary_displacement, expected, rtol=0, atol=1e-12 * 0.05)
    assert bodies[1].peaks().strain == pytest.approx(bodies[0].peaks().strain, rel=1e-8)


@pytest.mark.parametrize("theory", NONLINEAR)
def test_state_continues_with_the_same_bits(theory: str, soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    options = {
        "material": soft,
        "time_step": 1e-3,
        "theory": theory,
        "damping": Rayleigh(mass_factor=0.1, stiffness_factor=1e-4),
        "loads": [
            BodyForce(acceleration=(0.0, -9.81), schedule=Ramp(over=0.3)),
            Pressure(boundary="inner", pressure=100.0, follows=True),
        ],
    }
    straight, resumed = (ElasticStructure(tube, **options) for _ in range(2))
    thrown(straight, spin=60.0, shake=0.02)
    rng = np.random.default_rng(4)
    pushes = rng.normal(size=(180, *straight.polyline.points.shape))
    for push in pushes[:150]:
        straight.advance(push)
    assert straight.mean_rotation() > 2 * np.pi  # the whole turns are part of the state
    resumed.restore(straight.state())
    for push in pushes[150:]:
        straight.advance(push)
        resumed.advance(push)
    for name, array in straight.state().items():
        np.testing.assert_array_equal(resumed.state()[name], array, err_msg=name)
    assert resumed.mean_rotation() == straight.mean_rotation()


def test_what_a_theory_is_not_for_is_refused(soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    def made(**options) -> ElasticStructure:
        return ElasticStructure(tube, material=soft, **({"time_step": 1e-3} | options))

    for refused, words in (
        (lambda: made(theory="cubic"), "theory = 'cubic' is not known: use one of linear, corotational, large_strain"),
        (lambda: made(theory="corotational", scheme=Newmark(beta=0.3025, gamma=0.6)), "leave the scheme out"),
        (lambda: made(theory="large_strain", element="enhanced"), "element = 'enhanced' is not for theory"),
        (lambda: made(theory="corotational").static_displacement(), "let the body come to rest"),
        (lambda: made(theory="large_strain").static_displacement(), "let the body come to rest"),
    ):
        with pytest.raises(StructureError) as refusal:
            refused()
        assert words in str(refusal.value)
        assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("theory", NONLINEAR)
def test_a_step_too_long_is_refused_with_its_time(theory: str, soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    body = ElasticStructure(tube, material=soft, time_step=0.01, theory=theory)
    body.set_initial(velocity=300.0 * quarter(tube.points))  # 3 rad within a step
    with pytest.raises(StructureError, match=r"t = 0.01 s: .* take a (smaller step|step of at most)"):
        body.advance(np.zeros_like(body.polyline.points))
