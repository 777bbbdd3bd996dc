"""Each dissipation channel in a case that has only it, against a closed form of the energy lost."""

import math

import hypothesis.strategies as st
import numpy as np
import pytest
from discs import FLOOR, full_law, losses, normal_only, only, resting_disc
from driven_pair import turned, turntable
from every_law import EPS, MANY, Pair, any_pair, contact_of, decades, system_of
from hypothesis import given, settings

from particles import ContactModel, Grains, HertzSpringDashpot, MindlinFriction, ParticleSystem
from particles.contact import recipe

G = 9.81
FEW = settings(MANY, max_examples=10)


def test_normal_dashpot_takes_what_the_bounce_lacks() -> None:
    mass, speed, k_n, e = 0.08, 0.2, 6.5e4, 0.5
    c_n = recipe.damping_from_restitution(restitution=e, effective_mass=mass, stiffness=k_n, may_pull=False)
    grains = Grains.discs([[0.0, 0.005]], 0.005, mass / (np.pi * 0.005**2), velocity=[[0.0, -speed]])
    system = normal_only(grains, k_n=k_n, c_n=c_n, walls=[FLOOR], time_step=1e-6)
    system.advance(8000)
    assert system.look().count == 0
    # omega_0 dt = 9e-4: the lag of the dashpot is of order 1.
    assert only("normal_dashpot", system, share=1e-12) == pytest.approx(0.5 * mass * speed**2 * (1 - e**2), rel=1e-3)


SLIDER = {"radius": 0.03, "mass": 0.5, "gravity": G, "k_n": 6.5e7}
SLIP = 0.2  # initial slip velocity of the contact point


def slider(**law: float) -> ParticleSystem:
    """A resting disc that is set to spin: it slips, then rolls on. Its slip has the mass m/3."""
    grains = resting_disc(**SLIDER, spin=-SLIP / SLIDER["radius"])
    return full_law(grains, k_n=SLIDER["k_n"], **law, walls=[FLOOR], gravity=(0.0, -G), time_step=2e-6)


def test_sliding_takes_friction_times_distance() -> None:
    mu, mass = 0.3, SLIDER["mass"]
    system = slider(k_t=4e6, mu=mu)
    duration = 0.5 * SLIP / (3.0 * mu * G)  # half the time to rolling
    system.advance(round(duration / 2e-6))
    distance = SLIP * duration - 0.5 * 3.0 * mu * G * duration**2
    # The spring keeps mu m g/k_t = 4e-7 m of the distance, 1e-4 of it; lever arm 1e-6.
    assert only("sliding", system, share=1e-9) == pytest.approx(mu * mass * G * distance, rel=3e-4)


def test_tangential_dashpot_takes_the_energy_of_the_slip() -> None:
    mass = SLIDER["mass"]
    k_t = 1e4
    system = slider(k_t=k_t, c_t=2.0 * np.sqrt(k_t * mass / 3.0), mu=1e6)
    system.advance(60_000)
    # Kinetic energy (m/3) s^2/2 of the slip; omega dt = 5e-4, order 1.
    assert only("tangential_dashpot", system, share=1e-6) == pytest.approx(mass / 6.0 * SLIP**2, rel=1e-3)


def test_rolling_dashpot_takes_the_energy_of_a_slow_roll() -> None:
    radius, mass, v0 = 0.005, 0.083, 0.002
    grains = resting_disc(radius=radius, mass=mass, gravity=G, k_n=6.5e6, vx=v0, spin=-v0 / radius)
    system = full_law(
        grains, k_n=6.5e6, k_t=3e5, mu=1e6, mu_r=1e6, eta_r=0.5, k_r=8.1e-2, walls=[FLOOR], gravity=(0.0, -G),
        time_step=5e-6,
    )  # fmt: skip
    system.advance(round(0.5 / 5e-6))
    assert only("rolling_dashpot", system, share=1e-6) == pytest.approx(0.75 * mass * v0**2, rel=1e-3)


def test_rolling_slip_takes_the_limit_moment_times_the_angle() -> None:
    radius, mass, v0, mu_r = 0.005, 0.083, 0.3, 0.2
    grains = resting_disc(radius=radius, mass=mass, gravity=G, k_n=6.5e6, vx=v0, spin=-v0 / radius)
    system = full_law(
        grains, k_n=6.5e6, k_t=3e5, mu=0.8, mu_r=mu_r, k_r=8.1, walls=[FLOOR], gravity=(0.0, -G), time_step=5e-6
    )
    system.advance(round(0.1 / 5e-6))
    angle = -system.grains.theta[0]
    # All of the angle but M/k_r = 1e-4 rad of some 4 rad; lever arm 1e-5.
    assert only("rolling_slip", system, share=1e-6) == pytest.approx(mu_r * radius * mass * G * angle, rel=1e-3)


def test_global_damping_takes_energy_exponentially() -> None:
    alpha_t, alpha_r, v0, spin, duration = 3.0, 5.0, 2.0, 40.0, 0.2
    errors = []
    for dt in (4e-4, 2e-4, 1e-4):
        grains = Grains.discs([[0.0, 0.0]], 0.01, 1600.0, velocity=[[v0, 0.0]], spin=spin)
        system = full_law(grains, k_n=1e4, k_t=1e3, mu=0.5, alpha_t=alpha_t, alpha_r=alpha_r, time_step=dt)
        system.advance(round(duration / dt))
        mass, inertia = system.grains.mass[0], system.grains.inertia[0]
        expected = 0.5 * mass * v0**2 * (1.0 - np.exp(-2.0 * alpha_t * duration))
        expected += 0.5 * inertia * spin**2 * (1.0 - np.exp(-2.0 * alpha_r * duration))
        errors.append(abs(only("global_damping", system, share=1e-12) / expected - 1.0))
    # The drag takes the velocity of half a step before: order 1.
    assert errors[-1] < alpha_r * 1e-4
    assert -np.diff(np.log2(errors)) == pytest.approx(np.ones(2), abs=0.1)


@pytest.mark.parametrize("speed", [1e-3, 1.0])
@pytest.mark.parametrize("restitution", [0.2, 0.8])
def test_tsuji_dashpot_takes_what_the_bounce_lacks(restitution: float, speed: float) -> None:
    """The same share at any speed: two discs of unlike mass, ``m_eff v^2 (1 - e^2) / 2``."""
    pair = Pair(radius=0.01, other=3.0, k=1e6, mu=0.0)
    model = ContactModel(
        normal=HertzSpringDashpot(stiffness=1e8, restitution=restitution),
        tangential=MindlinFriction(stiffness_ratio=0.8, friction=0.0),
    )
    grains = Grains.discs(
        [[0.0, 0.0], [pair.radii.sum(), 0.0]], pair.radii, pair.density, velocity=[[speed, 0.0], [0.0, 0.0]]
    )
    deepest = (1.25 * pair.reduced_mass * speed**2 / 1e8) ** 0.4
    dt = 2e-4 * deepest / speed
    system = system_of("Mindlin", grains, model, dt=dt)
    system.advance(round(6.0 * deepest / speed / dt))  # an elastic contact lasts 2.94, a damped one longer
    assert system.look().count == 0
    expected = 0.5 * pair.reduced_mass * speed**2 * (1.0 - restitution**2)
    # The lag of the dashpot by half a step, 1e-4 of the time of the contact, at zeta up to 0.6.
    assert only("normal_dashpot", system, share=1e-12) == pytest.approx(expected, rel=3e-4)


@pytest.mark.parametrize("other", [1.0, 10.0])
def test_every_pair_loses_what_its_restitution_says(other: float) -> None:
    pair = Pair(other=other, zeta=0.3, mu=0.0, mu_r=0.0)
    speed, dt = 0.1, 1e-4 / pair.omega_0
    grains = Grains.discs(
        [[0.0, 0.0], [pair.radii.sum(), 0.0]], pair.radii, pair.density, velocity=[[speed, 0.0], [0.0, 0.0]]
    )
    system = system_of("constant torque", grains, contact_of("constant torque", pair), dt=dt)
    system.advance(round(4.0 / pair.omega_0 / dt))
    lost = 1.0 - recipe.restitution_without_tension(0.3) ** 2
    # The lag of the dashpot: 2 zeta omega_0 dt of the speed.
    assert only("normal_dashpot", system, share=1e-12) == pytest.approx(
        0.5 * pair.reduced_mass * speed**2 * lost, rel=3e-4
    )


def hertz_slider(mu: float, damping_ratio: float) -> ParticleSystem:
    """`slider` on Hertz's spring, which carries the weight at an overlap of 1e-4 radii, with Mindlin's friction."""
    radius, mass = SLIDER["radius"], SLIDER["mass"]
    delta = 1e-4 * radius
    model = ContactModel(
        normal=HertzSpringDashpot(stiffness=mass * G / delta**1.5),
        tangential=MindlinFriction(stiffness_ratio=0.8, friction=mu, damping_ratio=damping_ratio),
    )
    density = mass / (math.pi * radius**2)
    grains = Grains.discs([[0.0, radius - delta]], radius, density, spin=-SLIP / radius)
    return ParticleSystem(grains, model, walls=[FLOOR], gravity=(0.0, -G), time_step=2e-6)


def test_sliding_of_mindlins_spring_takes_friction_times_distance() -> None:
    mu, mass = 0.3, SLIDER["mass"]
    system = hertz_slider(mu, 0.0)
    duration = 0.5 * SLIP / (3.0 * mu * G)
    system.advance(round(duration / 2e-6))
    distance = SLIP * duration - 0.5 * 3.0 * mu * G * duration**2
    stretch = mu * 1e-4 * SLIDER["radius"] / (1.5 * 0.8)  # mu m g/k_t, with k_t = 0.8 of 1.5 m g/delta
    # Lever arm delta/2 = 5e-5 of the radius.
    assert only("sliding", system, share=1e-9) == pytest.approx(mu * mass * G * (distance - stretch), rel=1e-4)


def test_dashpot_of_mindlins_spring_takes_the_energy_of_the_slip() -> None:
    mass = SLIDER["mass"]
    system = hertz_slider(1e6, 1.0 / math.sqrt(3.0))  # critical for the slip's mass m/3
    system.advance(20_000)
    # omega = sqrt(3 k_t/m) = 3500 1/s; the dashpot lags by half a step, from the first step on: 2 omega dt.
    assert only("tangential_dashpot", system, share=1e-6) == pytest.approx(mass / 6.0 * SLIP**2, rel=2.0 * 3500 * 2e-6)


def test_constant_torque_takes_the_limit_moment_times_the_angle() -> None:
    """A disc rolls on and is slowed by ``2 mu_r g/3``, as the work of the moment says."""
    mass, radius, v0, mu_r = 0.5, 0.03, 0.3, 0.05
    k = 6.5e7
    pair = Pair(radius=radius, density=mass / (math.pi * radius**2), k=k, shear=0.1, mu=1e6, mu_r=mu_r)
    grains = resting_disc(radius=radius, mass=mass, gravity=G, k_n=k, vx=v0, spin=-v0 / radius)
    system = ParticleSystem(
        grains, contact_of("constant torque", pair), walls=[FLOOR], gravity=(0.0, -G), time_step=2e-6
    )
    duration = 0.5 * v0 / (2.0 / 3.0 * mu_r * G)
    system.advance(round(duration / 2e-6))
    angle = -system.grains.theta[0]
    # Half a step at the beginning, 3e-6 of the angle.
    assert only("rolling_dashpot", system, share=1e-9) == pytest.approx(mu_r * radius * mass * G * angle, rel=1e-5)
    # The friction that slows the centre swings about m a in its spring: m a/k_t = 1e-7 m of 0.03 m; arm 1e-6.
    assert angle * radius == pytest.approx(0.75 * v0 * duration, rel=1e-4)


TURNING = pytest.mark.parametrize("kind", ["damped rolling", "elastic rolling", "Mindlin", "constant torque", "table"])


def parted(system: ParticleSystem, overlap: float, steps: int) -> None:
    """Move the second disc of a turntable outward by `overlap` [m] and a little, in some steps."""
    system.set_velocity(slice(2, 3), (1.01 * overlap / (steps * system.time_step), 0.0))
    system.advance(steps)
    system.set_velocity(slice(2, 3), (0.0, 0.0))


@TURNING
@pytest.mark.parametrize("steps", [1, 40])
@FEW
@given(pair=any_pair(overlap=decades(-4.0, -1.5), mu=st.just(1e12), mu_r=st.just(1e12), other=decades(-1.0, 1.0)))
def test_opening_takes_what_the_springs_held(kind: str, steps: int, pair: Pair) -> None:
    """Sheared and rolled at a fixed overlap, then opened, at once or over many steps whose limits fall."""
    system = turntable(kind, pair, 1e3 / pair.omega_0)
    turned(system, pair, path=0.1 * pair.delta, roll=0.1 * pair.overlap)
    turned(system, pair, path=0.0, roll=0.0)
    stored, before = system.energies(), losses(system)
    parted(system, pair.delta, steps)
    assert system.look().count == 0
    lost = {name: value - before[name] for name, value in losses(system).items()}
    # The overlap, and with it Hertz's slope, is known to eps d over itself.
    noise = 1e2 * EPS * pair.distance / pair.delta + 1e-12
    assert lost["sliding"] == pytest.approx(stored["tangential_springs"], rel=noise)
    assert lost["rolling_slip"] == pytest.approx(stored["rolling_springs"], rel=noise)
    assert stored["tangential_springs"] > 0.0


@FEW
@given(pair=any_pair(overlap=decades(-3.0, -2.0), mu=st.just(1e12), shear_zeta=st.just(0.0)), depth=st.floats(1.5, 4.0))
def test_mindlins_spring_lets_go_what_its_stiffness_gains(pair: Pair, depth: float) -> None:
    """A sheared contact is pressed to `depth` times its overlap and back; no slip, so nothing else is lost.

    Pressed, the force stays and the stretch falls: ``E_0 (1 - k_0/k_1)`` is lost. Unloaded, the stretch
    stays and the force falls: ``E_1 (1 - k_0/k_1)``, with ``E_1 = E_0 k_0/k_1``.
    """
    system = turntable("Mindlin", pair, 1e3 / pair.omega_0)
    turned(system, pair, path=0.1 * pair.delta, roll=0.0)
    start, soft = system.energies()["tangential_springs"], 1.0 / math.sqrt(depth)
    expected = [start * (1.0 - soft), start * soft * (1.0 - soft)]
    found, before = [], losses(system)["sliding"]
    for sign in (-1.0, 1.0):
        system.set_velocity(slice(2, 3), (sign * (depth - 1.0) * pair.delta / (20 * system.time_step), 0.0))
        system.advance(20)
        found.append(losses(system)["sliding"] - before)
        before += found[-1]
    assert found == pytest.approx(expected, rel=1e3 * EPS * pair.distance / pair.delta + 1e-11)
    assert system.energies()["tangential_springs"] == pytest.approx(start * soft**2, rel=1e-9)
