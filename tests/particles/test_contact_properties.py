"""What holds for every contact: birth, limits, reach and objectivity."""

import numpy as np
import pytest
from discs import FLOOR, by_number, full_law, packing

from particles import Grains, box

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


def test_limits_are_never_passed() -> None:
    # Every pair of contacts of a shaken packing, at several moments; the total includes the dashpots.
    mu, mu_r = 0.3, 0.05
    grains, width, height = packing(400, seed=31, ratio=3.0, squeeze=0.95, speed=0.5)
    system = full_law(
        grains, **(LAW | {"mu": mu}), c_n=4.0, c_t=5.0, mu_r=mu_r, eta_r=1.0, walls=box(width, height),
        gravity=(0.0, -9.81), time_step=DT,
    )  # fmt: skip
    slack = 1.0 + 1e-12
    cut = 0
    for _ in range(20):
        system.advance(20)
        g, pairs = system.grains, system.list.pairs
        for i in range(len(g)):
            slots = slice(pairs.start[i], pairs.start[i + 1])
            j = pairs.partner[slots]
            apart = np.column_stack([g.x[j] - g.x[i], g.y[j] - g.y[i]])
            distance = np.hypot(*apart.T)
            # The dashpot saw the velocity before the kick, which the forces give back.
            delta = g.radius[i] + g.radius[j] - distance
            vx, vy = (v - DT * f / g.mass - DT * a for v, f, a in ((g.vx, g.fx, 0.0), (g.vy, g.fy, -9.81)))
            v_n = (apart[:, 0] * (vx[j] - vx[i]) + apart[:, 1] * (vy[j] - vy[i])) / distance
            f_n = np.where(delta > 0.0, np.maximum(LAW["k_n"] * delta - 4.0 * v_n, 0.0), 0.0)
            f_t = pairs.spring[slots] + pairs.dash_t[slots]
            moment = pairs.moment[slots] + pairs.dash_r[slots]
            reduced = g.radius[i] * g.radius[j] / (g.radius[i] + g.radius[j])
            tiny = 1e-9 * LAW["k_n"] * R  # round-off of the velocities reconstructed here
            assert (np.abs(f_t) <= slack * mu * f_n + tiny).all()
            assert (np.abs(moment) <= slack * mu_r * reduced * f_n + tiny * R).all()
            cut += np.count_nonzero(np.isclose(np.abs(f_t), mu * f_n, rtol=1e-6) & (f_n > 0.0))
    assert cut > 100  # the limit was at work


def turning_pair(radii: tuple[float, float], spins: list[float], orbit: float) -> tuple[float, float]:
    """Repulsion, and largest torque over repulsion times radius, one step after the start.

    Two touching discs of equal mass circle about their middle at `orbit` and spin at `spins` [rad/s].
    """
    reach = sum(radii) * (1.0 - 1e-3)
    density = RHO * np.array([1.0, (radii[0] / radii[1]) ** 2])
    arms = np.array([-0.5, 0.5]) * reach
    along = np.array([np.cos(0.7), np.sin(0.7)])
    velocity = orbit * arms[:, None] * np.array([-along[1], along[0]])
    grains = Grains.discs(arms[:, None] * along, radii, density, velocity=velocity, spin=spins)
    system = full_law(grains, **LAW, c_t=1.0, mu_r=0.2, eta_r=0.3, time_step=DT)
    system.advance(1)
    repulsion = float(np.hypot(*system.force_on(slice(0, 1))[0]))
    return repulsion, float(np.abs(system.grains.torque).max() / (repulsion * radii[0]))


@pytest.mark.parametrize("radii", [(1e-3, 1e-3), (1e-3, 5e-3)])
def test_pair_that_turns_as_one_body_feels_no_moment_and_no_friction(radii: tuple[float, float]) -> None:
    spin = 20.0
    repulsion, torque = turning_pair(radii, [spin, spin], spin)
    assert repulsion > 0.0
    # In one step the repulsion moves the discs and the normal turns by spin dt/2 against the velocities.
    assert torque < 1e-3
    assert turning_pair(radii, [spin, -spin], 0.0)[1] > 2e-2  # a rolling pair does feel one


def test_uniform_translation_changes_nothing() -> None:
    # Galilean invariance: the same packing seen from a moving frame, to round-off.
    results = []
    for shift in (0.0, 0.25):
        grains, _, _ = packing(100, seed=41)
        grains.vx += shift
        system = full_law(grains, **LAW, c_n=4.0, c_t=1.0, mu_r=0.1, eta_r=0.3, time_step=DT)
        system.advance(200)
        vx, vy, spin = by_number(system, "vx", "vy", "omega")
        results.append(np.array([vx - shift, vy, spin * R]))
    # eps of the speeds, through the dashpots and 200 steps of collisions.
    assert np.abs(results[1] - results[0]).max() < 1e-9 * np.abs(results[0]).max()
