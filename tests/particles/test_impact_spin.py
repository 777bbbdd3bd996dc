"""Spinning pairs, benchmarks 7 and 8 of Chung and Ooi (2011): reference solution, sliding limits, gears."""

from dataclasses import replace

import numpy as np
import pytest
from impact_benchmarks import ANVIL, KINDS, TWINS, UNEQUAL, Kind
from impact_runs import compare

STEPS = 2000
SPINS = np.array([0.5, 2.0, 5.0, 20.0])
PAIR = TWINS[1]
DEEP = replace(PAIR, speed=20.0)  # overlaps of 3 % of the radius: the lever arms and the turning normal count


@pytest.mark.parametrize("kind", KINDS)
def test_pairs_agree_with_the_reference(kind: Kind) -> None:
    # Of first order in dt: less than the change within one step of the contact.
    cases = [
        (PAIR, PAIR.impacts(kind, spin=SPINS, partner=SPINS)),
        (PAIR, PAIR.impacts(kind, u_t=0.3, spin=SPINS, partner=-0.5 * SPINS)),
        (DEEP, DEEP.impacts(kind, spin=50.0 * SPINS, partner=50.0 * SPINS)),
        (UNEQUAL, UNEQUAL.impacts(kind, spin=SPINS)),
        (ANVIL, ANVIL.impacts(kind, spin=SPINS)),
    ]
    for benchmark, impacts in cases:
        _, _, deviation = compare(benchmark, kind, impacts, STEPS)
        assert deviation.max() < 1.0 / STEPS


@pytest.mark.parametrize("kind", KINDS)
def test_twins_that_spin_alike_slide_as_rigid_bodies(kind: Kind) -> None:
    # J = m (1 + e) v/2: the surfaces, 2 r omega apart, slide throughout above 3 mu (1 + e) v; each loses
    # the surface speed mu (1 + e) v and is pushed aside at half of that.
    push = PAIR.mu * (1.0 + PAIR.restitution) * PAIR.speed
    spins = push / PAIR.radius * np.array([2.0, 5.0, 20.0])
    impacts = PAIR.impacts(kind, spin=spins, partner=spins)
    _, ours, _ = compare(PAIR, kind, impacts, STEPS)
    # Lever arms r - delta/2, and the pair turns while it touches: first order in delta/r and in 1/steps. The dashpot
    # lets the limit begin at mu c v, to which the tangential spring must first be stretched: an estimate as in
    # the oblique impacts, 2 zeta^2 mu (k_n/k_t) v/(v_t (1 + e)) of the friction, allowed twice.
    law = impacts[0].springs
    close = 4.0 * law.deepest(impacts[0].mass, PAIR.speed) / PAIR.radius + 2.0 / STEPS
    v_t = 2.0 * PAIR.radius * spins
    close += 4.0 * law.zeta**2 * law.mu / law.ratio * PAIR.speed / (v_t * (1.0 + PAIR.restitution))
    lost = (spins[:, None] - ours[:, 2:]) * PAIR.radius
    assert (np.abs(lost / push - 1.0) < close[:, None]).all()
    assert (np.abs(np.abs(ours[:, 1]) / push - 1.0) < close).all()


@pytest.mark.parametrize("kind", KINDS)
def test_gears_do_not_feel_each_other(kind: Kind) -> None:
    # Equal and opposite spins of twins: the surfaces go together, and nothing changes but the normal velocity.
    impacts = PAIR.impacts(kind, spin=SPINS, partner=-SPINS)
    _, ours, _ = compare(PAIR, kind, impacts, STEPS)
    assert ours[:, 2] == pytest.approx(SPINS, rel=1e-14)
    assert ours[:, 3] == pytest.approx(-SPINS, rel=1e-14)
    assert np.abs(ours[:, 1]).max() < 1e-14 * PAIR.speed
