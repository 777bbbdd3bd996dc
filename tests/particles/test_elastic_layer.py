"""A single layer of elastic discs on a shaken floor: small deviations from one bounce per period, in closed form.

A disc that meets the floor at its top once per period, ``u = g T/2``, deviates by ``du`` in velocity and ``dt`` in
time. The next flight is longer by ``2 du/g``, the next blow adds twice the floor's velocity there, ``-2 Gamma g dt``: a
map of determinant 1, no energy being lost, and of half trace ``1 - 2 Gamma``. Below Gamma = 1 deviations turn by
``arccos(1 - 2 Gamma)`` per period for ever; above they grow, with alternating sign. The discs lie side by side, with a
gap: each is a sample.
"""

import numpy as np
import pytest
from discs import by_number

from particles import ContactModel, Grains, HertzSpringDashpot, ParticleSystem, Shaking, Wall

RADIUS, MASS = 100.0, 1.0
DISCS = 6
IMPACT = 2e-3  # of a period
PER_CONTACT = 40  # steps


def deviations(gamma: float, periods: int, size: float) -> np.ndarray:
    """Velocities (periods + 1, DISCS) over u at the tops of the flights.

    Units: g = 1, period 1.
    """
    amplitude = gamma / (2.0 * np.pi) ** 2
    start = 0.5 * size * np.linspace(-1.0, 1.0, DISCS)
    place = np.column_stack([2.2 * RADIUS * (np.arange(DISCS) + 0.5), np.full(DISCS, RADIUS + 2.0 * amplitude + 0.125)])
    grains = Grains.discs(place, RADIUS, MASS / (np.pi * RADIUS**2), velocity=np.column_stack([np.zeros(DISCS), start]))
    steps = round(PER_CONTACT / IMPACT)
    layer = ParticleSystem(
        grains,
        ContactModel(normal=HertzSpringDashpot(stiffness=MASS * (2.94 / IMPACT) ** 2.5)),
        time_step=1.0 / steps,
        walls=[Wall(point=(0.0, 0.0), normal=(0.0, 1.0), name="floor", shaken=True)],
        shaking=Shaking(amplitude=amplitude, period=1.0),
        gravity=(0.0, -1.0),
        period=(2.2 * RADIUS * DISCS, None),
    )
    found = [start]
    for _ in range(periods):
        layer.advance(steps)
        assert layer.look().count == 0
        (speed,) = by_number(layer, "vy")
        found.append(speed + 0.5 * layer.time_step)  # from half a step later
    return 2.0 * np.array(found)


@pytest.mark.parametrize("gamma", [0.25, 0.5, 0.75, 1.05])
def test_deviations_turn_below_gamma_1_and_grow_above(gamma: float) -> None:
    stable = gamma < 1.0
    found = deviations(
        gamma, *((8, 0.01) if stable else (6, 1e-3))
    )  # those that grow stay below 2 %, where squares enter
    own = 0.5 * (found - found[:, ::-1])  # of opposite starts: what the length of impacts moves the orbit by is common
    # d(j+1) + d(j-1) = trace d(j), by least squares
    half = float((own[1:-1] * (own[2:] + own[:-2])).sum() / (2.0 * (own[1:-1] ** 2).sum()))
    # a flight and a blow are each uncertain by the part of the period that an impact takes
    assert half == pytest.approx(1.0 - 2.0 * gamma, abs=4.0 * IMPACT)
    if stable:
        assert np.abs(own).max() < 0.02
        area = (own[1:] ** 2 + own[:-1] ** 2 - 2.0 * half * own[1:] * own[:-1]).sum(axis=1)
        # determinant 1: nothing is lost or gained. Touching is told to a step of 5e-5, deviations in time are 1e-2
        np.testing.assert_allclose(area, area[0], rtol=0.02)
