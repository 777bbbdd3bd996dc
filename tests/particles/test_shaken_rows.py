"""Prescribed grains that move with the shaken walls: the same chain, on a grain that is held instead of on a floor."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from discs import FLOOR, balance, by_number
from test_shaken_chain import (
    AMPLITUDE,
    DENSITY,
    GRAVITY,
    K_N,
    MASS,
    PERIOD,
    RADIUS,
    N,
    damped_chain,
    elastic_chain,
    orders,
)

from particles import CoulombFriction, Grains, LinearSpringDashpot, ParticleError, ParticleSystem, Shaking
from particles.contact import ContactModel

ROW = 0
MOTION = Shaking(amplitude=AMPLITUDE, period=PERIOD, bodies=(ROW,))


def system_of(grains: Grains, motion: Shaking, dt: float, *, c_n: float = 0.0, **options: Any) -> ParticleSystem:
    """With friction, and repeating in x, so that one loop is compiled for all tests."""
    law = ContactModel(
        normal=LinearSpringDashpot(stiffness=K_N, damping=c_n),
        tangential=CoulombFriction(stiffness=500.0, friction=0.5, damping=0.0),
    )
    options = {"gravity": (0.0, -GRAVITY), "period": (30.0, None)} | options
    return ParticleSystem(grains, law, time_step=dt, shaking=motion, **options)


def column(dt: float, *, c_n: float = 0.0, scheme: str = "leapfrog") -> ParticleSystem:
    """N discs at rest on each other, the first on a held one whose top is at height 0."""
    overlap = MASS * GRAVITY / K_N * np.arange(N, 0, -1)
    height = RADIUS + 2 * RADIUS * np.arange(N) - np.cumsum(overlap)
    grains = Grains.discs(np.column_stack([np.zeros(N), height]), RADIUS, DENSITY)
    grains = grains.with_prescribed([[0.0, -RADIUS]], RADIUS, ROW)
    return system_of(grains, MOTION, dt, c_n=c_n, scheme=scheme)


def errors(scheme: str, c_n: float, exact: np.ndarray, end: float) -> np.ndarray:
    """Largest error of a displacement at the end over A, for steps that are halved."""
    found = []
    for steps in (2000, 4000, 8000):
        system = column(end / steps, c_n=c_n, scheme=scheme)
        (start,) = by_number(system, "y")
        system.advance(steps)
        assert system.look().count == N, "no contact has opened"
        (height,) = by_number(system, "y")
        found.append(np.abs((height - start)[:N] - exact).max() / AMPLITUDE)
    return np.array(found)


def test_column_on_a_held_grain_follows_its_modes_with_order_two() -> None:
    end = 0.4 * PERIOD
    np.testing.assert_allclose(orders(errors("leapfrog", 0.0, elastic_chain(end), end)), 2.0, atol=0.1)


def test_dashpots_see_the_velocity_of_the_row() -> None:
    """Of the present in velocity Verlet, order 2; of half a step before in the leapfrog, order 1."""
    end, c_n = 0.4 * PERIOD, 3.0
    exact = damped_chain(end, c_n)
    np.testing.assert_allclose(orders(errors("velocity_verlet", c_n, exact, end)), 2.0, atol=0.1)
    np.testing.assert_allclose(orders(errors("leapfrog", c_n, exact, end)), 1.0, atol=0.1)


def test_work_of_the_row_is_the_energy_of_the_chain() -> None:
    """Elastic: what the row has done is what is stored, to round-off, whatever the calls of `advance` are."""
    system = column(1e-3)
    start = balance(system)
    for steps in (1, 2, 417, 1000, 80):
        system.advance(steps)
        # sums of some thousand terms of the size of the work
        assert abs(balance(system) - start) < 1e-11 * K_N * AMPLITUDE**2
    assert system.energies()["work_prescribed"] > 1e-3 * K_N * AMPLITUDE**2
    assert system.energies()["work_walls"] == 0.0


def test_row_is_where_the_floor_is_after_any_number_of_steps() -> None:
    """Ten million steps on it stands as far from its place as a floor, to the last bit."""
    floor = replace(FLOOR, shaken=True)
    motion = Shaking(amplitude=0.3, period=25_000 * 1e-3, bodies=(ROW,))
    for done in (0, 9_999_999):
        grains = Grains.discs([[0.0, 50.0]], RADIUS, DENSITY).with_prescribed([[3.0, 0.0], [4.5, 0.0]], RADIUS, ROW)
        grains = grains.with_prescribed([[9.0, 0.0]], RADIUS, ROW + 1)
        system = system_of(grains, motion, 1e-3, walls=[floor], gravity=(0.0, 0.0))
        system.start()
        system.steps_done = done
        system.advance(6_000)
        system.advance(250)
        walls = system.list.walls
        assert walls.py[0] > 0.1 and np.all(system.grains.y[1:3] == walls.py[0])
        assert np.all(system.grains.vy[1:3] == walls.vy[0])
        assert (system.grains.y[3], system.grains.vy[3]) == (0.0, 0.0), "another row stays"


def test_rough_floor_carries_grains_along_by_friction() -> None:
    """A heap on a floor of held grains that moves sideways: it is dragged along, and the ledger's error has order 2."""
    motion = Shaking(amplitude=1.0, period=8.0, direction=(1.0, 0.0), bodies=(ROW,))
    x, y = np.meshgrid(0.5 + 1.05 * np.arange(28), 1.0 + 1.02 * np.arange(24))
    held = np.column_stack([0.5 + np.arange(30), np.zeros(30)])
    lost = []
    for dt in (4e-3, 2e-3, 1e-3):
        grains = Grains.discs(np.column_stack([x.ravel(), y.ravel()]), RADIUS, DENSITY)
        grains = grains.with_prescribed(held, 0.5, ROW)
        system = system_of(grains, motion, dt, c_n=5.0)
        system.start()
        start = balance(system)
        system.advance(round(3.6 / dt))
        lost.append(abs(balance(system) - start))
        # everything rests on the floor, and the heap is soft: it lags a little
        speed = system.momentum()[0] / system.grains.mass.sum()
        assert 0.8 * system.grains.vx[-1] < speed < 1.1 * system.grains.vx[-1]
    assert system.energies()["work_prescribed"] > 100 * lost[-1]
    # grains that fall on each other hit in between steps: the order is that of a mean over many impacts
    np.testing.assert_allclose(orders(np.array(lost)), 2.0, atol=0.2)


def test_body_that_is_not_there_is_refused() -> None:
    grains = Grains.discs([[0.0, 5.0]], RADIUS, DENSITY)
    with pytest.raises(ParticleError, match="shaking moves body 0, which no prescribed grain has"):
        system_of(grains, MOTION, 1e-3)
