"""A disc that bounces on a vibrating floor: thresholds in closed form.

The contact is so stiff that an impact takes a thousandth of the period; the map from one impact to the next,
with the exact flight between them, then holds. With the floor at ``A sin(W t)``, ``Gamma = A W^2/g``, units g = 1 and
period 1, and a disc that leaves at time t with velocity v and lands at t':

    A sin(W t) + v (t' - t) - (t' - t)^2/2 = A sin(W t'),   v' = -e (v - (t' - t)) + (1 + e) A W cos(W t')

One impact per period asks for v = 1/2 and ``Gamma cos(phi) = pi (1 - e)/(1 + e)``. About it
``dt' = dt + (1 + e) dv`` and ``dv' = e^2 dv - (1 + e) Gamma sin(phi) dt'``: the determinant is e^2, the trace
``1 + e^2 - (1 + e)^2 Gamma sin(phi)``. An eigenvalue passes -1 where ``Gamma sin(phi) = 2 (1 + e^2)/(1 + e)^2``, and 1
where ``sin(phi) = 0``. (Luck and Mehta 1993 have the same limits.) Hertz's spring is taken, as the force of its dashpot
does not jump at the moment of touching: a linear one scatters the rebounds by the part of a step that is left.
"""

import numpy as np
import pytest
from numpy.typing import NDArray

from particles import ContactModel, Grains, HertzSpringDashpot, ParticleSystem, Shaking, Wall

RADIUS, MASS = 100.0, 1.0
DENSITY = MASS / (np.pi * RADIUS**2)
SHAKEN = Wall(point=(0.0, 0.0), normal=(0.0, 1.0), name="floor", shaken=True)
IMPACT = 1e-3  # of a period: how long a contact lasts
STIFFNESS = MASS * (2.94 / IMPACT) ** 2.5
STEPS = 20_000  # in a period: 20 in an impact
OMEGA = 2 * np.pi


def disc(gamma: float, e: float, *, phase: float, launch: float, steps: int = STEPS) -> ParticleSystem:
    """A disc that leaves the floor with a velocity, the phase of the sine being what it then is."""
    motion = Shaking(amplitude=gamma / OMEGA**2, period=1.0, from_rest=False)
    grains = Grains.discs([[0.0, RADIUS]], RADIUS, DENSITY)
    law = ContactModel(normal=HertzSpringDashpot(stiffness=STIFFNESS, restitution=e))
    system = ParticleSystem(
        grains, law, time_step=1.0 / steps, walls=[SHAKEN], shaking=motion, gravity=(0.0, -1.0),
        scheme="velocity_verlet", ledger=False,
    )  # fmt: skip
    system.start()
    done = round(phase / (2 * np.pi) * steps)
    system.steps_done = done
    grains.y[0] = RADIUS + motion.displacement(done / steps)
    grains.vy[0] = launch - 0.5 / steps
    return system


def heights_of(system: ParticleSystem, periods: int) -> NDArray[np.float64]:
    """Heights above the floor once in each period, away from the impacts, which tell one orbit from another."""
    heights = []
    system.advance(2 * STEPS // 5)
    for _ in range(periods):
        system.advance(STEPS)
        heights.append(float(system.grains.y[0]) - RADIUS - system.shaking.displacement(system.time))
    return np.array(heights)


def limits(e: float) -> tuple[float, float]:
    """Gamma between which one impact per period is stable."""
    least, flip = np.pi * (1 - e) / (1 + e), 2 * (1 + e**2) / (1 + e) ** 2
    return least, float(np.hypot(least, flip))


def periodic_orbit(gamma: float, e: float) -> ParticleSystem:
    return disc(gamma, e, phase=np.arccos(limits(e)[0] / gamma), launch=0.5)


@pytest.mark.parametrize("e", [0.3, 0.6])
def test_period_doubles_at_its_threshold(e: float) -> None:
    """Below it one height repeats every period, above it two heights take turns."""
    flip = limits(e)[1]
    below = heights_of(periodic_orbit(0.95 * flip, e), 40)[-4:]
    above = heights_of(periodic_orbit(1.04 * flip, e), 40)[-4:]
    # a flight is 1/8 high; a step of 1/20 of an impact scatters heights by 2e-3
    assert np.ptp(below) < 0.01
    assert np.ptp(above[::2]) < 0.01 and np.ptp(above[1::2]) < 0.01
    assert abs(above[0] - above[1]) > 0.03


@pytest.mark.parametrize("e", [0.3, 0.6])
def test_one_impact_per_period_needs_its_least_gamma(e: float) -> None:
    """Above it the disc goes on flying a period at a time, at the height of the closed form; below it does not."""
    least = limits(e)[0]
    for share, flies in ((1.05, True), (0.95, False)):
        gamma, phase = share * least, np.arccos(min(1.0, 1.0 / share))
        floor = gamma / OMEGA**2 * np.sin(phase + np.array([0.0, 0.4 * OMEGA]))
        height = floor[0] + 0.5 * 0.4 - 0.5 * 0.4**2 - floor[1]
        off = np.abs(heights_of(disc(gamma, e, phase=phase, launch=0.5), 40)[-10:] - height)
        assert (off.max() < 0.01) if flies else (off.max() > 0.03), off


def flight_without_rebound(gamma: float) -> float:
    """Time in the air [periods] of a disc that lies on the floor until its acceleration is that of gravity."""
    leave = np.arcsin(1 / gamma)
    x = np.linspace(1e-3, 2 * np.pi, 200_000)
    gap = np.sin(leave) + np.cos(leave) * x - x**2 / (2 * gamma) - np.sin(leave + x)
    landed = np.nonzero(gap[1000:] < 0)[0]
    return float(x[1000 + landed[0]]) / (2 * np.pi) if len(landed) else 1.0


def airborne(gamma: float) -> float:
    """Share of the time in the air of a disc without rebound, over four periods."""
    steps = 50_000  # the dashpot is strong
    system = disc(gamma, 0.02, phase=0.0, launch=gamma / OMEGA, steps=steps)
    system.advance(2 * steps)
    away = 0
    for _ in range(8000):
        system.advance(steps // 2000)
        away += system.look().count == 0
    return away / 8000


@pytest.mark.parametrize("gamma", [1.2, 2.0, 2.5])
def test_disc_without_rebound_flies_as_long_as_it_should(gamma: float) -> None:
    """It leaves where ``Gamma sin(phi) = 1``, flies in a parabola, lands and stays."""
    # a contact of e = 0.02 rests after some hundredths of a period
    assert airborne(gamma) == pytest.approx(flight_without_rebound(gamma), abs=0.02)


def test_disc_without_rebound_never_leaves_below_gravity() -> None:
    assert airborne(0.98) == 0.0


def test_disc_without_rebound_flies_a_whole_period_from_its_threshold_on() -> None:
    """``Gamma = sqrt(1 + pi^2)``: from there on it lands where it is thrown up again, and is never seen to lie."""
    threshold = np.hypot(1.0, np.pi)
    assert flight_without_rebound(0.99 * threshold) < 0.998
    assert flight_without_rebound(1.01 * threshold) == 1.0
    assert airborne(1.05 * threshold) > 0.985
