"""A disc bounces on the floor against spring and dashpot: restitution with and without tension."""

import math

import numpy as np
import pytest
from discs import FLOOR, by_number, normal_only
from scipy.integrate import solve_ivp

from particles import Grains
from particles.contact import recipe

K_N, C_N, RADIUS, SPEED = 4.0, 2.0, 1.0, 1e-3
# One dashpot serves all discs: their damping ratios differ by mass, m = c^2 / (4 k zeta^2).
RATIOS = np.array([0.05, 0.2, 0.5, 0.9, 1.0, 1.3, 3.0])


def restitution_by_ode(ratio: float, *, may_pull: bool) -> float:
    """Rebound over impact speed of x'' = -x - 2 zeta x', released at x = 0 or at zero force."""

    def rate(_: float, s: np.ndarray) -> list[float]:
        return [s[1], -s[0] - 2.0 * ratio * s[1]]

    def release(t: float, s: np.ndarray) -> float:
        force = -s[0] if may_pull else -s[0] - 2.0 * ratio * s[1]
        return float(force) if t > 1e-6 else 1.0

    release.terminal, release.direction = True, -1.0
    end = solve_ivp(rate, (0.0, 200.0), [0.0, -1.0], "DOP853", events=release, rtol=1e-12, atol=1e-14)
    return float(end.y_events[0][0, 1]) if len(end.t_events[0]) else float(end.y[1, -1])


def bounce(dt: float, *, may_pull: bool) -> np.ndarray:
    """Rebound over impact speed of one disc per damping ratio, all touching the floor at t = 0."""
    mass = C_N**2 / (4.0 * K_N * RATIOS**2)
    place = np.column_stack([3.0 * np.arange(len(RATIOS)), np.full(len(RATIOS), RADIUS)])
    grains = Grains.discs(place, RADIUS, mass / (np.pi * RADIUS**2), velocity=[0.0, -SPEED])
    system = normal_only(grains, k_n=K_N, c_n=C_N, may_pull=may_pull, walls=[FLOOR], time_step=dt)
    # Half a period of the heaviest (omega_0 = 2 k zeta / c), or the slow creep 2 zeta/omega_0 of the
    # over-damped, 40 times.
    system.advance(int(40.0 / dt))
    return by_number(system, "vy")[0] / SPEED


@pytest.mark.parametrize("ratio", [*RATIOS, 8.0])
def test_closed_forms_agree_with_the_ode(ratio: float) -> None:
    # 1e-9: the tolerance of the ODE over one contact, and the rest of its creep where it never ends.
    assert recipe.restitution_without_tension(ratio) == pytest.approx(
        restitution_by_ode(ratio, may_pull=False), abs=1e-9
    )
    expected = restitution_by_ode(ratio, may_pull=True)
    assert recipe.restitution_with_tension(ratio) == pytest.approx(expected, abs=1e-5 if ratio > 1.0 else 1e-9)


def test_critical_damping_leaves_e_to_the_minus_two() -> None:
    assert recipe.restitution_without_tension(1.0) == pytest.approx(math.exp(-2.0), rel=1e-12)
    near = [recipe.restitution_without_tension(1.0 + shift) for shift in (-1e-6, 1e-6)]
    assert near == pytest.approx([math.exp(-2.0)] * 2, rel=2e-6)


@pytest.mark.parametrize("may_pull", [False, True])
def test_bounce_has_the_restitution_of_the_closed_form(may_pull: bool) -> None:
    closed = recipe.restitution_with_tension if may_pull else recipe.restitution_without_tension
    dt = 2e-3
    error = bounce(dt, may_pull=may_pull) - [closed(ratio) for ratio in RATIOS]
    # One step of the dashpot force at touching, c v dt / (m v) = 2 zeta omega_0 dt: it takes the
    # velocity of half a step before, and begins (and with tension ends) somewhere within a step.
    omega_0 = 2.0 * K_N * RATIOS / C_N
    assert (np.abs(error) < 2.0 * RATIOS * omega_0 * dt).all()


def test_error_of_the_bounce_is_of_order_one() -> None:
    # Without tension the force ends at zero, so that only the lag of the dashpot is left; with it
    # the jump at the end falls anywhere in a step.
    expected = np.array([recipe.restitution_without_tension(ratio) for ratio in RATIOS])
    coarse, middle, fine = (bounce(dt, may_pull=False) - expected for dt in (4e-3, 2e-3, 1e-3))
    assert np.log2(coarse / middle) == pytest.approx(np.ones(len(RATIOS)), abs=0.1)
    assert np.log2(middle / fine) == pytest.approx(np.ones(len(RATIOS)), abs=0.1)


@pytest.mark.parametrize("may_pull", [False, True])
@pytest.mark.parametrize("restitution", [1e-3, 0.1, 0.446, 0.9, 1.0])
def test_damping_from_restitution_inverts_the_closed_forms(restitution: float, may_pull: bool) -> None:
    mass, stiffness = 0.02, 1.98e6
    damping = recipe.damping_from_restitution(
        restitution=restitution, effective_mass=mass, stiffness=stiffness, may_pull=may_pull
    )
    closed = recipe.restitution_with_tension if may_pull else recipe.restitution_without_tension
    assert closed(damping / (2.0 * math.sqrt(mass * stiffness))) == pytest.approx(restitution, rel=1e-10)


def test_stiffness_recipes_give_the_overlap_asked_for() -> None:
    gravity, height, overlap, mass = 9.81, 0.1, 1e-4, 0.02
    stiffness = recipe.stiffness_from_drop_height(
        mass=mass, gravity=gravity, drop_height=height, largest_overlap=overlap
    )
    # All kinetic energy of the fall is in the spring at the deepest point.
    assert 0.5 * stiffness * overlap**2 == pytest.approx(mass * gravity * height, rel=1e-12)
