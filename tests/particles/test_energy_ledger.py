"""The energy ledger as a whole: what its sum is kept to, and what moving boundaries put in."""

import hypothesis.strategies as st
import numpy as np
import pytest
from discs import FLOOR, balance, full_law, losses, normal_only, packing, resting_disc
from every_law import EPS, MANY, Pair, any_pair, decades, or_none
from hypothesis import given

from particles import Grains, Wall, box

G = 9.81
STORED = ("kinetic", "rotational", "gravity", "normal_springs", "tangential_springs", "rolling_springs")


@MANY
@given(pair=any_pair(overlap=decades(-4.0, -1.0), zeta=or_none(decades(-4.0, -0.2))), heavy=st.booleans())
def test_balance_of_a_normal_contact_is_exact(pair: Pair, heavy: bool) -> None:
    """A disc let go from an overlapped floor, linear spring and dashpot: every step balances to round-off.

    The works are trapezoidal, and so is the change of a linear spring's energy where the normal does not turn.
    """
    mass, radius = pair.mass[0], pair.radius
    grains = Grains.discs([[0.0, radius - pair.delta]], radius, pair.density)
    weight = 0.1 * pair.k * pair.delta if heavy else 0.0
    c_n = 2.0 * pair.zeta * np.sqrt(mass * pair.k)
    dt = 0.1 * np.sqrt(mass / pair.k)
    system = normal_only(
        grains, k_n=pair.k, c_n=c_n, may_pull=pair.may_pull, walls=[FLOOR], gravity=(0.0, -weight / mass), time_step=dt
    )
    system.start()
    scale = 0.5 * pair.k * pair.delta**2
    start = balance(system)
    rounding = EPS * radius / pair.delta  # of the overlap, felt in its energy
    for step in range(1, 15):  # it opens after 15.7 at least
        system.advance(1)
        assert abs(balance(system) - start) <= 8.0 * step * rounding * scale + 8.0 * EPS * abs(start)


@pytest.mark.parametrize("eta_r", [0.0, 0.3])
@pytest.mark.parametrize("mu", [0.2, 1e6])
def test_balance_of_a_rolling_and_sliding_disc_is_exact(mu: float, eta_r: float) -> None:
    """A disc at its resting overlap on a floor that is suddenly tilted: springs, dashpots, limits and drag of spin."""
    radius, k_n = 0.03, 6.5e5
    grains = resting_disc(radius=radius, mass=0.5, gravity=G, k_n=k_n)
    system = full_law(
        grains, k_n=k_n, k_t=1e5, c_n=10.0, c_t=5.0, mu=mu, mu_r=0.02, eta_r=eta_r, k_r=20.0, alpha_r=0.5,
        walls=[FLOOR], gravity=(0.9 * G, -G), time_step=1e-4,
    )  # fmt: skip
    system.start()
    start, worst = balance(system), 0.0
    steps = 2000
    for _ in range(steps // 50):
        system.advance(50)
        worst = max(worst, abs(balance(system) - start))
    found = losses(system)
    assert found["global_damping"] > 0.0
    assert (found["sliding"] > 0.0) == (mu < 1.0)
    # A few roundings of the turned-over energy at every step.
    assert worst < 4.0 * steps * EPS * system.energies()["kinetic"]


def test_balance_counts_dashpots_from_the_first_moment() -> None:
    """Discs that are given in contact and in motion: the first step balances like all others."""
    radius = 0.01
    grains = Grains.discs([[0.0, 0.99 * radius]], radius, 1000.0, velocity=[0.0, -0.1])
    system = normal_only(grains, k_n=1e5, c_n=20.0, walls=[FLOOR], time_step=5e-6)
    system.start()
    start = balance(system)
    system.advance(1)
    assert balance(system) == pytest.approx(start, rel=1e-13)


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
    assert drifts[0] < 2e-4 * turnover[0]
    # Works and losses are the integrator's own to round-off while a contact lasts; what remains is
    # the turn of the normals, of order 2, and the step in which it is born or opens, where forces of the
    # dashpots jump: order 1, alone in the end (1.6, 1.3, 1.2, 1.15 over four halvings).
    assert np.log2(drifts[1] / drifts[-1]) / 2.0 == pytest.approx(1.0, abs=0.3)


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
