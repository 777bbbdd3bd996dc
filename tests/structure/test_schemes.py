"""Generalised alpha and the alpha method: chosen damping of stiff modes, order 2, a ledger that closes."""

import meshes
import numpy as np
import pytest
from structure import (
    BodyForce,
    BoundaryLoad,
    ElasticStructure,
    GeneralizedAlpha,
    HilberHughesTaylor,
    Newmark,
    PlaneStrain,
    Ramp,
    Rayleigh,
    StructureError,
)
from structure.schemes import Scheme

LOSING: list[Scheme] = [
    GeneralizedAlpha(spectral_radius=0.0),
    GeneralizedAlpha(spectral_radius=0.5),
    GeneralizedAlpha(spectral_radius=0.9),
    HilberHughesTaylor(alpha=-0.05),
    HilberHughesTaylor(alpha=-0.3),
    Newmark(beta=0.3025, gamma=0.6),
]
SECOND_ORDER = LOSING[:-1]


def amplification(scheme: Scheme, omega_dt: float, damping_ratio: float = 0.0) -> np.ndarray:
    """From (u, dt v, dt^2 a) to the same a step later, for one free mode, from the equations of the scheme."""
    k, c = omega_dt**2, 2 * damping_ratio * omega_dt
    am, af, b, g = scheme.alpha_m, scheme.alpha_f, scheme.beta, scheme.gamma
    new = np.array([[1, 0, -b], [0, 1, -g], [k * (1 - af), c * (1 - af), 1 - am]])
    old = np.array([[1, 1, 0.5 - b], [0, 1, 1 - g], [-k * af, -c * af, -am]])
    return np.linalg.solve(new, old)


def swing(scheme: Scheme, material: PlaneStrain, omega_dt: float, steps: int) -> np.ndarray:
    """(u, dt v, dt^2 a) of a beam kicked in its first mode, at every step: (steps + 1, 3).

    u is the sag between ends and middle: round-off sets the body as a whole in motion.
    """
    beam = meshes.beam(length=1.0, height=0.1, along=10)
    omega = 2 * np.pi * ElasticStructure(beam, material=material, time_step=1.0).frequencies(1)[0]
    dt = omega_dt / omega
    body = ElasticStructure(beam, material=material, time_step=dt, scheme=scheme)
    body.release_from_mode(1, 1e-3)
    body.set_initial(velocity=body.fields().point_data["displacement"] / dt)
    x, y = body.polyline.points.T
    ends, middle = (y == 0.0) & ((x == 0.0) | (x == 1.0)), (y == 0.0) & (np.abs(x - 0.5) < 1e-9)
    rows = []
    for step in range(steps + 1):
        parts = (body.boundary_displacement, dt * body.boundary_velocity, dt**2 * body.boundary_acceleration)
        rows.append([part[ends, 1].sum() - 2 * part[middle, 1].sum() for part in parts])
        if step < steps:
            body.advance(np.zeros_like(body.polyline.points))
    return np.array(rows)


@pytest.mark.parametrize("radius", [0.0, 0.3, 0.5, 0.8])
def test_stiff_modes_shrink_by_the_chosen_radius(radius: float, soft: PlaneStrain) -> None:
    rows = swing(GeneralizedAlpha(spectral_radius=radius), soft, 1e4, 6)
    # Each part of its own size: the three grow apart as the mode gets stiffer.
    rows /= np.abs(rows).max(axis=0)
    step = np.linalg.lstsq(rows[:-1], rows[1:], rcond=None)[0]
    # At infinity the three eigenvalues coincide, at omega dt = 1e4 they lie (omega dt)^(-2/3) = 2e-3 apart.
    assert np.abs(np.linalg.eigvals(step)).max() == pytest.approx(radius, abs=5e-3)


@pytest.mark.parametrize("scheme", [GeneralizedAlpha(spectral_radius=0.5), HilberHughesTaylor(alpha=-0.2)])
@pytest.mark.parametrize("omega_dt", [0.3, 3.0, 300.0])
def test_a_mode_moves_as_the_scheme_of_one_degree_of_freedom(
    scheme: Scheme, omega_dt: float, soft: PlaneStrain
) -> None:
    rows = swing(scheme, soft, omega_dt, 20)
    matrix, expected = amplification(scheme, omega_dt), [rows[0]]
    for _ in range(20):
        expected.append(matrix @ expected[-1])
    # The mode itself is good to 1e-12 of the eigensolver; what lies beside it, up to 1e3 stiffer, is scaled by that.
    assert (np.abs(rows - expected).max(axis=0) < 1e-8 * np.abs(expected).max(axis=0)).all()


def test_low_modes_are_hardly_damped() -> None:
    """At 60 steps a period generalised alpha takes less than either Newmark or the alpha method of equal radius."""

    def ratio(scheme: Scheme, omega_dt: float) -> float:
        pair = np.linalg.eigvals(amplification(scheme, omega_dt))
        value = np.log(pair[np.argmax(np.abs(pair.imag))])
        return -value.real / abs(value)

    radius = 0.8
    general = ratio(GeneralizedAlpha(spectral_radius=radius), 0.1)
    by_alpha = ratio(HilberHughesTaylor(alpha=(radius - 1) / (radius + 1)), 0.1)
    gamma = (3 - radius) / (2 * radius + 2)
    by_newmark = ratio(Newmark(beta=(gamma + 0.5) ** 2 / 4, gamma=gamma), 0.1)
    assert 0 < general < by_alpha < by_newmark
    assert general < 1e-5
    assert by_newmark > 1e-3


@pytest.mark.parametrize("scheme", SECOND_ORDER, ids=repr)
def test_error_is_of_order_two(scheme: Scheme, soft: PlaneStrain) -> None:
    """Damped, under a load, a weight and a boundary force that all change in time."""
    beam = meshes.beam(length=1.0, height=0.1, along=10)
    omega = 2 * np.pi * ElasticStructure(beam, material=soft, time_step=1.0).frequencies(1)[0]
    end = 2 * np.pi / omega
    pattern = np.sin(beam.outer_polyline.points * [3.0, 5.0])
    tops = []
    for steps in 80, 160, 320, 640:
        dt = end / steps
        body = ElasticStructure(
            beam,
            material=soft,
            time_step=dt,
            scheme=scheme,
            damping=Rayleigh(mass_factor=0.02 * omega, stiffness_factor=0.02 / omega),
            loads=[BoundaryLoad(boundary="top", total_force=(1.0, -3.0), schedule=Ramp(over=2 * end))],
        )
        for step in range(steps):
            body.advance(np.sin(1.3 * omega * dt * (step + 1)) ** 2 * pattern)
        tops.append(body.boundary_displacement)
    gaps = [np.abs(fine - coarse).max() for coarse, fine in zip(tops, tops[1:])]
    rates = np.log2(np.array(gaps[:-1]) / gaps[1:])
    assert rates[-1] == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("scheme", LOSING, ids=repr)
def test_ledger_closes_with_the_loss_of_the_scheme(scheme: Scheme, soft: PlaneStrain) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04)
    body = ElasticStructure(
        tube,
        material=soft,
        time_step=1e-4,
        scheme=scheme,
        damping=Rayleigh(mass_factor=0.5, stiffness_factor=2e-5),
        loads=[
            BoundaryLoad(boundary="loaded_arc", total_force=(3.0, -10.0), schedule=Ramp(over=0.02)),
            BodyForce(acceleration=(0.0, -9.81), schedule=Ramp(over=0.03)),
        ],
    )
    rng = np.random.default_rng(7)
    start = 1e-5 * rng.normal(size=tube.points.shape)
    body.set_initial(displacement=start, velocity=100 * start)
    first = body.energies()
    for _ in range(300):
        body.advance(rng.normal(size=body.polyline.points.shape))
    last = body.energies()
    exchanged = sum(abs(value) for value in vars(last).values())
    assert abs(last.scheme_loss) > 1e-5 * exchanged
    stored = last.kinetic + last.strain - first.kinetic - first.strain
    error = stored + last.rayleigh_loss + last.scheme_loss - last.external_work - last.boundary_work
    # 300 steps of sums over some hundred terms.
    assert abs(error) < 1e4 * np.finfo(float).eps * exchanged


@pytest.mark.parametrize("scheme", LOSING, ids=repr)
def test_energy_of_free_vibration_never_passes_its_start(scheme: Scheme, soft: PlaneStrain) -> None:
    beam = meshes.beam(length=1.0, height=0.1, along=10)
    rng = np.random.default_rng(2)
    start = rng.normal(size=beam.points.shape)
    for step in 1e-4, 1e-3, 1e-2:  # omega dt of the stiffest mode from 0.4 to 40
        body = ElasticStructure(beam, material=soft, time_step=step, scheme=scheme)
        body.set_initial(velocity=start)
        energy = []
        for _ in range(200):
            now = body.energies()
            energy.append(now.kinetic + now.strain)
            body.advance(np.zeros_like(body.polyline.points))
        assert max(energy) <= energy[0] * (1 + 1e-12)
        assert energy[-1] < energy[0]


def test_alpha_zero_is_newmark_and_radius_one_keeps_the_energy(soft: PlaneStrain) -> None:
    beam = meshes.beam(length=1.0, height=0.1, along=10)
    rng = np.random.default_rng(4)
    velocity, forces = rng.normal(size=beam.points.shape), rng.normal(size=(50, *beam.outer_polyline.points.shape))
    plain, zero, middle = (
        ElasticStructure(beam, material=soft, time_step=1e-3, scheme=scheme)
        for scheme in (Newmark(), HilberHughesTaylor(alpha=0.0), GeneralizedAlpha(spectral_radius=1.0))
    )
    for body in plain, zero, middle:
        body.set_initial(velocity=velocity)
        before = body.energies()
        for force in forces:
            body.advance(force)
        after = body.energies()
        assert after.scheme_loss == 0.0
        gain = after.kinetic + after.strain - before.kinetic - before.strain
        assert gain == pytest.approx(after.boundary_work, abs=1e-12 * before.kinetic)
    np.testing.assert_array_equal(zero.boundary_displacement, plain.boundary_displacement)
    np.testing.assert_array_equal(zero.boundary_acceleration, plain.boundary_acceleration)


@pytest.mark.parametrize("scheme", [GeneralizedAlpha(), GeneralizedAlpha(spectral_radius=1.0), LOSING[-1]], ids=repr)
def test_resumed_run_has_the_same_bits(scheme: Scheme, soft: PlaneStrain) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04)

    def build() -> ElasticStructure:
        load = BoundaryLoad(boundary="loaded_arc", total_force=(0.0, -10.0), schedule=Ramp(over=0.01))
        damping = Rayleigh(mass_factor=0.1, stiffness_factor=1e-4)
        return ElasticStructure(tube, material=soft, time_step=1e-4, damping=damping, loads=[load], scheme=scheme)

    forces = np.random.default_rng(5).normal(size=(60, *tube.outer_polyline.points.shape))
    straight, resumed = build(), build()
    for step, force in enumerate(forces):
        if step == 30:
            resumed.restore({name: array.copy() for name, array in straight.state().items()})
        straight.advance(force)
        if step >= 30:
            resumed.advance(force)
    for name, array in straight.state().items():
        np.testing.assert_array_equal(resumed.state()[name], array, err_msg=name)
    assert resumed.energies() == straight.energies()


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: GeneralizedAlpha(spectral_radius=1.1), "spectral_radius = 1.1 must lie from 0"),
        (lambda: GeneralizedAlpha(spectral_radius=float("nan")), "spectral_radius = nan"),
        (lambda: HilberHughesTaylor(alpha=-0.4), "alpha = -0.4 must lie from -1/3 to 0"),
        (lambda: HilberHughesTaylor(alpha=0.1), "alpha = 0.1"),
    ],
)
def test_schemes_refuse_what_is_not_stable(build, words: str) -> None:
    with pytest.raises(StructureError) as refusal:
        build()
    assert words in str(refusal.value)
