"""The limit of the time step that holds in every packing."""

import math

import numpy as np
import pytest
from discs import full_law
from networks import DASHPOTS, DENSITY, HERTZ, K_N, NO_FRICTION, RADIUS, bed, cluster, crystal

from particles import (
    ContactModel,
    GlobalDamping,
    Grains,
    LinearSpringDashpot,
    ParticleError,
    ParticleSystem,
    crowding,
    packing_limit,
    sharp_limit,
)


@pytest.mark.parametrize("degrees", [119.0, 100.0, 80.0, 72.0, 63.0, 60.0, 58.0, 51.5, 45.0, 33.3, 20.0, 7.0])
def test_neighbours_of_a_grain_are_counted_right(degrees: float) -> None:
    """Largest sum of cos^2 over directions that keep an angle, by dynamic programming over a grid of directions."""
    number, angle = 1440, math.radians(degrees)
    weight = np.cos(2.0 * math.pi * np.arange(number) / number) ** 2
    gap = math.ceil(angle * number / (2.0 * math.pi) - 1e-9)
    best = 0.0
    for first in range(gap + 1):
        last = first + number - gap
        tail = np.zeros(last + gap + 2)  # best from a direction on
        for k in range(last, first + gap - 1, -1):
            tail[k] = max(tail[k + 1], weight[k % number] + tail[min(k + gap, last + 1)])
        best = max(best, weight[first] + tail[first + gap])
    most, aligned = crowding._crowd(angle)
    assert most == math.floor(360.0 / degrees + 1e-9)
    # each of the contacts gives up less than a grid step, 0.0044 rad, to the grid
    assert best <= aligned + 1e-12
    assert best == pytest.approx(aligned, abs=0.0044 * most)


def flower(ratio: float, *, squeeze: float, inside: bool) -> Grains:
    """One disc with as many around it as there is place, of `ratio` times its radius or the inverse, overlapping."""
    centre, around = (1.0, ratio) if inside else (ratio, 1.0)
    smaller = min(centre, around)
    distance = centre + around
    number = int(math.pi / math.asin((1.0 - 0.5 * squeeze) * around / distance))
    turn = 2.0 * math.pi * np.arange(number) / number
    place = np.vstack([[[0.0, 0.0]], (distance - 1e-6 * smaller) * np.column_stack([np.cos(turn), np.sin(turn)])])
    return Grains.discs(RADIUS * place, RADIUS * np.array([centre] + [around] * number), DENSITY)


LAWS = {
    "no friction": NO_FRICTION,
    "soft shear": {"k_n": K_N, "k_t": 0.05 * K_N, "mu": 0.5, "mu_r": 0.2},
    "stiff shear": {"k_n": K_N, "k_t": 2.0 * K_N, "mu": 0.5, "mu_r": 0.2},
    "damped": {"k_n": K_N, "k_t": 0.3 * K_N, "mu": 0.5, "mu_r": 0.2} | DASHPOTS,
}


@pytest.mark.parametrize("law", LAWS)
def test_no_packing_has_a_smaller_limit(law: str) -> None:
    grains = [flower(ratio, squeeze=0.05, inside=inside) for ratio in (1.0, 1.3, 3.0, 10.0) for inside in (True, False)]
    grains += [cluster(40, smallest=smallest, seed=seed) for smallest in (0.9, 0.3) for seed in (1, 2)]
    systems = [full_law(discs, **LAWS[law], time_step=1e-6) for discs in grains]
    systems += [crystal(6, 6, **LAWS[law]), bed(**LAWS[law])]
    for system in systems:
        bound = packing_limit(system.grains, system.contact, damping=system.damping)
        assert bound <= sharp_limit(system).step


def test_it_is_close_to_the_hexagonal_packing() -> None:
    """With 5 % of overlap allowed, neighbours may stand at 58.4 instead of 60 degrees: 3 % of omega^2."""
    system = crystal(**NO_FRICTION)
    share = packing_limit(system.grains, system.contact) / sharp_limit(system).step
    assert 0.975 < share < 1.0


def test_hertz_and_restitution_in_every_packing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Slopes at the overlap allowed, 5 % of the smaller radius; sizes within 1 % are put together, on the safe side."""
    law, ratio = HERTZ, 0.3
    many = np.random.default_rng(3).uniform(ratio, 1.0, 300) * RADIUS
    many[:2] = ratio * RADIUS, RADIUS
    grains = Grains.discs(np.arange(600.0).reshape(-1, 2), many, DENSITY)
    bound = packing_limit(grains, law)
    for seed in range(3):
        system = ParticleSystem(cluster(30, smallest=ratio, seed=seed), law, time_step=1e-7)
        assert bound < sharp_limit(system).step
    monkeypatch.setattr(crowding, "ALIKE", 1e-9)
    each = packing_limit(grains, law)
    assert each * 0.98 < bound <= each * (1.0 + 1e-12)  # 1 % of mass and radius, and neighbours of a size 1 % off


def test_prescribed_grains_count_by_their_spacing() -> None:
    free, law = Grains.discs([[0.0, 0.0]], RADIUS, DENSITY), ContactModel(normal=LinearSpringDashpot(stiffness=K_N))

    def beside(radius: float, spacing: float) -> float:
        row = np.column_stack([np.full(5, 1.0), spacing * np.arange(5)])
        return packing_limit(free.with_prescribed(row, radius, 0), law)

    alone = packing_limit(free, law)
    assert beside(RADIUS, 2.0 * RADIUS) == pytest.approx(alone), "no nearer than the grains themselves"
    assert beside(0.25 * RADIUS, 0.5 * RADIUS) < 0.9 * alone, "more small ones find place around it"
    assert beside(RADIUS, RADIUS) < 0.9 * alone, "more that overlap, too"
    with pytest.raises(ParticleError, match="body 0 lie 1e-05 m apart.*space them out, or give a time step"):
        beside(RADIUS, 1e-2 * RADIUS)
    assert packing_limit(Grains.discs(np.zeros((0, 2)), 1.0, 1.0), law) == math.inf


def test_global_damping_counts() -> None:
    grains, law = Grains.discs([[0.0, 0.0]], RADIUS, DENSITY), ContactModel(normal=LinearSpringDashpot(stiffness=1e-9))
    damping = GlobalDamping(translational=40.0)
    assert packing_limit(grains, law, damping=damping) == pytest.approx(
        2.0 / 40.0, rel=1e-3
    )  # the spring is next to nothing
