"""A disc thrown along the floor with too little spin slides, then rolls (G table 3.2).

With the moment of inertia of a disc, m r^2/2, the slip V + omega r falls at 3 mu g and V at mu g;
the corner comes at t* = (V0 + omega0 r)/(3 mu g), and the disc rolls on at constant speed.
"""

import numpy as np
import pytest
from discs import FLOOR, full_law, resting_disc

MASS, RADIUS, V0, SPIN0, MU, G = 0.5, 0.03, 1.0, -27.78, 0.57, 9.81
# Stiff enough that the lever arm r - delta/2 is the radius to 1e-6.
K_N, DT, DURATION = 6.5e7, 2e-6, 0.04
CORNER = (V0 + SPIN0 * RADIUS) / (3.0 * MU * G)


def closed_form(time: np.ndarray) -> np.ndarray:
    """Velocity and spin (2, n) of the rigid disc."""
    sliding = np.minimum(time, CORNER)
    return np.array([V0 - MU * G * sliding, SPIN0 - 2.0 * MU * G / RADIUS * sliding])


def roll(k_t: float, *, damping_ratio: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Times of the velocities, and velocity and spin (2, n), every 20 steps."""
    c_t = damping_ratio * 2.0 * np.sqrt(k_t * MASS / 3.0)  # slip feels the mass m/3
    grains = resting_disc(radius=RADIUS, mass=MASS, gravity=G, k_n=K_N, vx=V0, spin=SPIN0)
    system = full_law(grains, k_n=K_N, k_t=k_t, c_t=c_t, mu=MU, walls=[FLOOR], gravity=(0.0, -G), time_step=DT)
    times, motion = [], []
    for _ in range(int(DURATION / (20 * DT))):
        system.advance(20)
        times.append(system.time + 0.5 * DT)
        motion.append([system.grains.vx[0], system.grains.omega[0]])
    return np.array(times), np.array(motion).T


def test_velocity_and_spin_follow_the_closed_form() -> None:
    k_t = 4e6
    times, motion = roll(k_t, damping_ratio=0.5)
    error = np.abs(motion - closed_form(times))
    # At the corner the spring still holds mu m g: velocity swings by mu g/omega_t, spin by 2/r of it.
    swing = MU * G / np.sqrt(3.0 * k_t / MASS)
    assert error[0].max() < 1.1 * swing
    assert error[1].max() < 1.1 * swing * 2.0 / RADIUS
    late = times > CORNER + 0.01
    assert motion[0, late] == pytest.approx(np.full(late.sum(), V0 - MU * G * CORNER), rel=1e-5)
    assert motion[1, late] == pytest.approx(-motion[0, late] / RADIUS, rel=1e-5)


def test_time_of_the_corner() -> None:
    times, (velocity, _) = roll(4e6, damping_ratio=0.5)
    rolling = velocity[times > CORNER + 0.01].mean()
    early = (times > 0.001) & (times < 0.8 * CORNER)
    slope, start = np.polyfit(times[early], velocity[early], 1)
    assert slope == pytest.approx(-MU * G, rel=1e-5)
    # The spring needs mu m g/k_t of slip before it slides: 4e-6 s later at this stiffness.
    assert (rolling - start) / slope == pytest.approx(CORNER, rel=1e-3)


def test_error_falls_with_the_root_of_the_tangential_stiffness() -> None:
    errors = []
    for k_t in (6.25e4, 2.5e5, 1e6, 4e6):
        times, motion = roll(k_t)
        errors.append(np.abs(motion - closed_form(times))[0].max())
    assert -np.diff(np.log2(errors)) / 2.0 == pytest.approx(np.full(3, 0.5), abs=0.1)
