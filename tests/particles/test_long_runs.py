"""Ten million steps and more: what is not to drift does not, and no number of steps is too large to go on from."""

import math
from fractions import Fraction

import numpy as np
import pytest
from discs import by_number
from numpy.typing import NDArray

from particles import ContactModel, CoulombFriction, Grains, LinearSpringDashpot, ParticleSystem, Shaking, Wall

DENSITY = 1.0 / math.pi
FLOOR = Wall(point=(0.0, 0.0), normal=(0.0, 1.0), name="floor", shaken=True)
GROOVE = (
    Wall(point=(8.0, 0.0), normal=(1.0, 1.0), name="left", shaken=True),
    Wall(point=(8.0, 0.0), normal=(-1.0, 2.0), name="right", shaken=True),
)
MOTION = ("x", "y", "vx", "vy", "omega", "fx", "fy", "torque")


def shaken(
    place: NDArray[np.float64], radius: NDArray[np.float64], *, gamma: float, period: float, dt: float,
    walls: tuple[Wall, ...], width: float, friction: float = 0.5,
) -> ParticleSystem:  # fmt: skip
    """Discs on shaken walls, gravity 1, sides that repeat after `width`: the compiled code of the shaken scenes."""
    law = ContactModel(
        normal=LinearSpringDashpot(stiffness=1000.0, restitution=0.135),
        tangential=CoulombFriction(stiffness=750.0, damping=5.0, friction=friction),
    )
    motion = Shaking(amplitude=gamma * (period / (2.0 * math.pi)) ** 2, period=period)
    return ParticleSystem(
        Grains.discs(place, radius, DENSITY), law, time_step=dt, walls=walls, shaking=motion, gravity=(0.0, -1.0),
        period=(width, None),
    )  # fmt: skip


def bed() -> ParticleSystem:
    """A tumbling bed; step and period are powers of two, so that t and t/period have no round-off."""
    rng, k = np.random.default_rng(1), np.arange(35)
    place = np.column_stack([0.6 + 1.125 * (k % 7), 0.75 + 1.25 * (k // 7)]) + rng.uniform(-0.05, 0.05, (35, 2))
    radius = rng.uniform(0.45, 0.55, 35)
    return shaken(place, radius, gamma=1.5, period=4.0, dt=2.0**-9, walls=(FLOOR,), width=8.0)


def groove(amplitude: float = 1.0, *, finer: int = 1, friction: float) -> ParticleSystem:
    """Two discs that rest in a groove, no contact slides, period 1; the seam is far away."""
    place = np.array([[8.3, 1.0], [8.1, 2.2]])
    return shaken(
        place, np.array([0.5, 0.7]), gamma=0.3 * amplitude, period=1.0, dt=2.0**-8 / finer, walls=GROOVE,
        width=1024.0, friction=friction,
    )  # fmt: skip


def place_of(system: ParticleSystem) -> NDArray[np.float64]:
    return np.concatenate(by_number(system, "x", "y", "theta"))


def test_bits_do_not_depend_on_what_lies_behind() -> None:
    """10^12 steps, 10^6 lists and 10^9 turns of every grain ago, or none of them: the same motion to the bit."""
    young, old = bed(), bed()
    young.advance(2 * 2048)
    saved = young.state()
    steps, lists, _ = saved["counters"]
    behind = 2048 * 2**29
    assert behind > 1e12
    old.restore(saved | {"counters": np.array([steps + behind, lists + 2**20, 1])})
    old.grains.theta += 2e9 * math.pi
    for system in (young, old):
        system.advance(3 * 2048 + 100)
    assert young.rebuilds > lists + 20 and young.look().tangential_energy > 0.0
    assert old.steps_done == young.steps_done + behind
    for name in MOTION:
        np.testing.assert_array_equal(getattr(old.grains, name), getattr(young.grains, name), err_msg=name)
    assert old.energies() == young.energies()
    for name in ("spring", "partner"):
        np.testing.assert_array_equal(getattr(old.list.pairs, name), getattr(young.list.pairs, name), err_msg=name)


@pytest.mark.parametrize("steps", [10**7, 10**9, 10**12])
def test_floor_keeps_its_phase(steps: int) -> None:
    """Against exact arithmetic, with the step and the period of the source, which are no round numbers."""
    dt, motion = 1.5811388e-4, Shaking(amplitude=0.435, period=3.952847, start=31.622776)
    speed = motion.amplitude * 2.0 * math.pi / motion.period
    for step in range(steps, steps + 25_000, 1_237):
        turns = (step * Fraction(dt) - Fraction(motion.start)) / Fraction(motion.period)
        exact = motion.amplitude * 2.0 * math.sin(math.pi * float(turns % 1)) ** 2
        # the product t, the difference from the start and the quotient are rounded once each, the sine costs some eps
        round_off = 3 * speed * np.spacing(step * dt) + 10 * np.finfo(float).eps
        assert abs(motion.displacement(step * dt) - exact) < round_off, step


def test_resting_discs_without_friction_come_back_to_the_bit() -> None:
    """Normal springs have a potential: what a period does to the grains it does again, without a trace of the last."""
    system = groove(friction=0.0)
    system.advance(100 * 256)
    before, moments = place_of(system), system.state()
    assert system.look().count >= 3
    system.advance(400 * 256)
    np.testing.assert_array_equal(place_of(system), before)
    for name in ("vx", "vy", "fx", "fy"):
        np.testing.assert_array_equal(system.state()[f"grains.{name}"], moments[f"grains.{name}"], err_msg=name)


def creep(amplitude: float = 1.0, *, finer: int = 1, friction: float = 0.5) -> NDArray[np.float64]:
    """Displacements and turns of one period, from 60 and from the 60 after them, (2, 6)."""
    system, places = groove(amplitude, finer=finer, friction=friction), []
    system.advance(60 * 256 * finer)
    slid = system.energies()["loss_sliding"]
    for _ in range(3):
        places.append(place_of(system))
        system.advance(60 * 256 * finer)
    assert system.energies()["loss_sliding"] == slid, "nothing slides"
    return np.diff(places, axis=0) / 60


def test_friction_creeps_by_its_law_and_not_by_round_off() -> None:
    """A tangential spring has no potential: a closed path of overlap and turn leaves a force in it, an area.

    (McNamara, Garcia-Rojo and Herrmann 2008.) So grains that stick creep under a shaking: by the same in each
    period, by the square of the amplitude, and by a limit that the step tends to in its first order.
    """
    found = [creep(finer=finer) for finer in (1, 2, 4)]
    for first, then in found:
        assert 1e-11 < np.abs(first).min() and np.abs(first).max() < 1e-8
        # a place is known to eps 8, 60 periods of it are divided by 60; a period adds up some hundred roundings
        np.testing.assert_allclose(then, first, atol=1e-13)
    changes = [found[1][0] - found[0][0], found[2][0] - found[1][0]]
    order = np.log2(np.abs(changes[0]) / np.abs(changes[1]))
    np.testing.assert_allclose(order, 1.0, atol=0.1)
    limit = found[2][0] + changes[1]
    assert np.abs(limit).min() > 2e-11, "it does not go away with the step"
    # twice the amplitude turns the contacts by twice as much; the groove stays what it is to some 1e-3
    np.testing.assert_allclose(found[0][0], 4.0 * creep(0.5)[0], rtol=0.02)
