"""Two discs meet obliquely without friction (G 3.2.1): the path against an independent ODE solution."""

import numpy as np
import pytest
from discs import by_number, normal_only
from scipy.integrate import solve_ivp

from particles import Grains

MASS, RADII, IMPACT, SPEED, K_N = 0.5, (0.03, 0.05), 0.03, 1.0, 4.9e4
REACH = sum(RADII)
APPROACH = float(np.sqrt(REACH**2 - IMPACT**2))
PHASES = 16  # copies that touch at different moments within a step


def ode_angles() -> tuple[np.ndarray, float]:
    """Directions (degrees) of both discs after the collision and how long they touch (s).

    From the equation of relative motion.
    """
    reduced = 0.5 * MASS

    def rate(_: float, s: np.ndarray) -> np.ndarray:
        distance = np.hypot(s[0], s[1])
        push = K_N * (REACH - distance) / distance / reduced
        return np.array([s[2], s[3], push * s[0], push * s[1]])

    def apart(_: float, s: np.ndarray) -> float:
        return float(np.hypot(s[0], s[1]) - REACH)

    apart.terminal, apart.direction = True, 1.0
    start = [APPROACH - 1e-15, -IMPACT, -SPEED, 0.0]
    solution = solve_ivp(rate, (0.0, 1.0), start, "DOP853", events=apart, rtol=1e-13, atol=1e-15)
    relative = solution.y_events[0][-1][2:]
    centre = np.array([0.5 * SPEED, 0.0])
    angles = np.degrees([np.arctan2(v[1], v[0]) for v in (centre - 0.5 * relative, centre + 0.5 * relative)])
    return angles, float(solution.t_events[0][-1])


def collide(dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Directions (2, PHASES) in degrees and kinetic energy over its initial value (PHASES,)."""
    gap = SPEED * dt * (2.0 + (np.arange(PHASES) + 0.5) / PHASES)
    up = 0.3 * np.arange(PHASES)
    first = np.column_stack([-APPROACH - gap, IMPACT + up])
    second = np.column_stack([np.zeros(PHASES), up])
    radius = np.repeat(RADII, PHASES)
    velocity = np.zeros((2 * PHASES, 2))
    velocity[:PHASES, 0] = SPEED
    grains = Grains.discs(np.vstack([first, second]), radius, MASS / (np.pi * radius**2), velocity=velocity)
    system = normal_only(grains, k_n=K_N, time_step=dt)
    system.advance(int(0.02 / dt))  # the contact lasts 7 ms
    vx, vy = (v.reshape(2, PHASES) for v in by_number(system, "vx", "vy"))
    return np.degrees(np.arctan2(vy, vx)), (vx**2 + vy**2).sum(axis=0) / SPEED**2


def test_ode_gives_the_angles_of_the_source() -> None:
    # The source's corrected angles, known to their printed digits.
    assert ode_angles()[0] == pytest.approx([66.993, -23.007], abs=5e-4)


def test_angles_agree_with_the_ode() -> None:
    angles, energy = collide(5e-6)
    assert np.abs(angles - ode_angles()[0][:, None]).max() < 1e-4
    # Same error source: (omega dt)^2 with omega = 443 1/s.
    assert np.abs(energy - 1.0).max() < 5e-6


def test_order_two_in_the_time_step() -> None:
    # The force has a kink where the contact begins and ends, so the error depends on where in a
    # step these fall: the copies begin at all phases, and the contact time over dt keeps its
    # fractional part 1/3 through the refinements.
    exact, duration = ode_angles()
    angle_error, energy_error = [], []
    for whole_steps in (24, 48, 96, 192, 384):
        angles, energy = collide(duration / (whole_steps + 1.0 / 3.0))
        angle_error.append(np.sqrt(np.mean((angles - exact[:, None]) ** 2)))
        energy_error.append(np.sqrt(np.mean((energy - 1.0) ** 2)))
    for errors in (angle_error, energy_error):
        orders = -np.diff(np.log2(errors))
        assert orders == pytest.approx(np.full(4, 2.0), abs=0.1)
