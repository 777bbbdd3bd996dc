"""Where a contact begins and ends: birth with a zero spring, nothing before it, nothing remembered after it."""

import pytest
from discs import FLOOR, by_number, full_law

from particles import Grains

LAW = {"k_n": 2e5, "k_t": 1e4, "mu": 0.5}
R, RHO, DT = 1e-3, 1600.0, 1e-6


def test_contact_is_born_with_zero_spring() -> None:
    # Two discs spin fast for a long time before they meet: no part of the past slip is remembered.
    speed, spin = 0.01, 300.0
    grains = Grains.discs(
        [[0.0, 0.0], [2.0 * R + 2.0 * speed * 100.5 * DT, 0.0]], R, RHO,
        velocity=[[speed, 0.0], [-speed, 0.0]], spin=spin,
    )  # fmt: skip
    system = full_law(grains, **(LAW | {"mu": 1e9}), time_step=DT)
    system.advance(100)
    assert system.look().count == 0
    system.advance(1)
    assert system.look().count == 1
    # Half a step in contact: spring = k_t v_t dt/2 with v_t = -2 r omega, and F on i is along +y t.
    expected = -LAW["k_t"] * 2.0 * R * spin * 0.5 * DT
    assert by_number(system, "fy")[0] == pytest.approx([expected, -expected], rel=1e-3)
    system.advance(1)  # and a whole step more
    assert by_number(system, "fy")[0][0] == pytest.approx(3.0 * expected, rel=1e-3)


def test_contact_forgets_its_spring_when_it_opens() -> None:
    # A bouncing spinning disc meets the floor twice; the second contact starts from nothing as well.
    grains = Grains.discs([[0.0, R + 1e-6]], R, RHO, velocity=[[0.0, -0.1]], spin=50.0)
    system = full_law(grains, **(LAW | {"mu": 1e9}), walls=[FLOOR], gravity=(0.0, -9.81), time_step=DT)
    births, before = [], 0.0
    for _ in range(60_000):
        system.advance(1)
        force = float(system.grains.fx[0])
        if force != 0.0 and before == 0.0:
            births.append(abs(force) / (LAW["k_t"] * R * abs(system.grains.omega[0]) * DT))
        before = force
    assert len(births) >= 2
    assert max(births) < 1.01  # at most one step of slip


def test_no_force_without_overlap() -> None:
    gap = 1e-12
    place, velocity = [[0.0, R + gap], [2.0 * R + gap, R + gap]], [[0.0, 0.0], [-1e-9, 0.0]]
    grains = Grains.discs(place, R, RHO, velocity=velocity, spin=100.0)
    system = full_law(grains, **LAW, c_n=6.0, c_t=1.0, mu_r=0.2, eta_r=0.3, walls=[FLOOR], time_step=DT)
    system.advance(5)
    for name in ("fx", "fy", "torque"):
        assert (getattr(system.grains, name) == 0.0).all()
    assert (system.wall_force == 0.0).all()
