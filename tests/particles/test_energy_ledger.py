"""The energy ledger: its sum is kept, and each channel is checked in a case that has only it."""

import numpy as np
import pytest
from discs import FLOOR, full_law, normal_only, packing, resting_disc

from particles import Grains, ParticleSystem, Wall, box
from particles.contact import recipe

G = 9.81
STORED = ("kinetic", "rotational", "gravity", "normal_springs", "tangential_springs", "rolling_springs")


def balance(system: ParticleSystem) -> float:
    """Stored energies and losses less works [J/m]; constant."""
    return sum(-value if name.startswith("work") else value for name, value in system.energies().items())


def losses(system: ParticleSystem) -> dict[str, float]:
    return {name[5:]: value for name, value in system.energies().items() if name.startswith("loss")}


def only(channel: str, system: ParticleSystem, *, share: float) -> float:
    """The loss of one channel, when the others together are below a share of it."""
    found = losses(system)
    loss = found.pop(channel)
    assert sum(abs(other) for other in found.values()) < share * loss
    return loss


def shaken_packing(dt: float, duration: float) -> tuple[float, float]:
    """Worst drift of the balance and the energy that was turned over, all features at work."""
    grains, width, height = packing(100, seed=3, ratio=2.0, squeeze=0.97, speed=0.2)
    grains = grains.with_prescribed([[0.5 * width, 0.4 * height]], 1e-3, 0)
    grains.vy[-1] = 0.3
    walls = [*box(width, height, ("left", "right")), Wall(point=(0.0, 0.0), normal=(0.0, 1.0), velocity=(0.1, 0.2))]
    system = full_law(
        grains, k_n=2e5, k_t=1e4, c_n=4.0, c_t=1.0, mu=0.4, mu_r=0.1, eta_r=0.3, alpha_t=2.0, alpha_r=3.0,
        walls=walls, gravity=(0.0, -G), time_step=dt,
    )  # fmt: skip
    system.start()
    start, drift = balance(system), 0.0
    for _ in range(20):
        system.advance(round(duration / dt / 20))
        drift = max(drift, abs(balance(system) - start))
    return drift, sum(losses(system).values())


def test_balance_is_kept_and_converges_with_the_time_step() -> None:
    drifts, turnover = zip(*(shaken_packing(dt, 4e-3) for dt in (4e-6, 2e-6, 1e-6, 0.5e-6)), strict=True)
    assert drifts[0] < 1e-3 * turnover[0]
    # Works and losses are the integrator's own to round-off while a contact lasts; what remains is
    # the step in which it is born or opens, where forces of the dashpots jump: order 1.
    assert np.log2(drifts[0] / drifts[-1]) / 3.0 == pytest.approx(1.0, abs=0.3)


def elastic_error(dt: float, seed: int) -> np.ndarray:
    """Error of the balance at 100 moments over the energy, for elastic discs in a closed box."""
    grains, width, height = packing(400, seed=seed, ratio=2.0, squeeze=1.0, speed=0.3)
    walls = box(width, height, ("left", "right", "floor", "lid"))
    system = normal_only(grains, k_n=2e5, walls=walls, gravity=(0.0, -G), time_step=dt)
    system.start()
    start, errors = balance(system), []
    for _ in range(100):
        system.advance(round(2e-5 / dt))
        errors.append(balance(system) / start - 1.0)
    assert all(loss == 0.0 for loss in losses(system).values())
    return np.array(errors)


def test_nothing_is_lost_without_dissipation() -> None:
    steps = 8e-6 * 0.5 ** np.arange(5)
    errors = [np.sqrt(np.mean([elastic_error(dt, seed) ** 2 for seed in (5, 6)])) for dt in steps]
    assert errors[-1] < 1e-6
    # The kinks where contacts begin and end fall anywhere in a step: single refinements scatter.
    assert np.polyfit(np.log2(steps), np.log2(errors), 1)[0] == pytest.approx(2.0, abs=0.2)


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


def test_moving_wall_does_the_work_it_gives() -> None:
    # An elastic piston at speed u sends a resting disc away at 2 u.
    u, dt = 0.5, 1e-5
    wall = Wall(point=(0.0, 0.0), normal=(1.0, 0.0), velocity=(u, 0.0))
    grains = Grains.discs([[0.02, 0.0]], 0.01, 1600.0)
    system = normal_only(grains, k_n=1e4, walls=[wall], time_step=dt)
    system.advance(8000)
    mass = system.grains.mass[0]
    assert system.energies()["work_walls"] == pytest.approx(0.5 * mass * (2.0 * u) ** 2, rel=1e-5)
    assert system.energies()["kinetic"] == pytest.approx(0.5 * mass * (2.0 * u) ** 2, rel=1e-5)


def test_prescribed_disc_does_the_work_it_gives() -> None:
    u = 0.5
    grains = Grains.discs([[0.03, 0.0]], 0.01, 1600.0).with_prescribed([[0.0, 0.0]], 0.01, 0)
    grains.vx[1] = u
    system = normal_only(grains, k_n=1e4, time_step=1e-5)
    system.advance(8000)
    mass = system.grains.mass[0]
    energies = system.energies()
    assert energies["work_prescribed"] == pytest.approx(0.5 * mass * (2.0 * u) ** 2, rel=1e-5)
    assert energies["kinetic"] == pytest.approx(energies["work_prescribed"], rel=1e-5)
    assert system.work_by(slice(1, 2)) == pytest.approx(energies["work_prescribed"], rel=1e-12)


def test_ledger_does_not_touch_the_motion() -> None:
    motions = []
    for ledger in (True, False):
        grains, width, height = packing(100, seed=3)
        system = full_law(
            grains, k_n=2e5, k_t=1e4, c_n=4.0, mu=0.4, mu_r=0.1, walls=box(width, height), time_step=1e-6, ledger=ledger
        )
        system.advance(500)
        motions.append(system.grains.position)
    assert np.array_equal(*motions)
    assert {name for name in system.energies()} == set(STORED)
