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
from particles.coordination import FIXED_WEIGHT, Neighbours, crowd, side_by_side


def best_around(gaps: np.ndarray, weights: np.ndarray, number: int = 720) -> float:
    """Largest sum of w cos^2 over neighbours on a grid of `number` directions, by dynamic programming.

    `gaps` (kinds, kinds) [rad] is the least angle between neighbours of two kinds next to each other.
    """
    kinds = range(len(weights))
    worth = weights[:, None] * np.cos(2.0 * math.pi * np.arange(number) / number) ** 2
    steps = np.ceil(gaps * number / (2.0 * math.pi) - 1e-9).astype(int)
    best = 0.0
    for first in range(int(steps.max()) + 1):
        for kind in kinds:
            end = first + number
            after = np.zeros((len(weights), end + number))  # best of all that may follow one at a direction
            onward = np.zeros_like(after)  # best from a direction on, beginning with one of a kind
            for k in range(end, first - 1, -1):
                for a in kinds:
                    after[a, k] = max(onward[b, k + steps[a, b]] for b in kinds)
                for a in kinds:
                    fits = worth[a, k % number] + after[a, k] if k <= end - steps[a, kind] else 0.0
                    onward[a, k] = max(onward[a, k + 1], fits)
            best = max(best, worth[kind, first % number] + after[kind, first])
    return best


@pytest.mark.parametrize("degrees", [119.0, 100.0, 72.0, 60.0, 58.0, 51.5, 33.3, 7.0])
def test_free_neighbours_line_up_at_most_so_far(degrees: float) -> None:
    angle = math.radians(degrees)
    most, aligned = side_by_side(angle)
    best = best_around(np.array([[angle]]), np.ones(1))
    assert most == math.floor(360.0 / degrees + 1e-9)
    # each contact may be pushed off by half a degree, a step of the grid; cos^2 changes at most as fast as the angle
    assert best <= aligned + 1e-12
    assert best == pytest.approx(aligned, abs=math.radians(0.5) * most)


def test_a_million_free_neighbours_are_counted() -> None:
    """So many lie all around: cos^2 is 1/2 in the mean, and the grid of directions adds less than one."""
    most, aligned = side_by_side(2.0 * math.pi / 1e6)
    assert most == 1e6
    assert 0.5 * most <= aligned <= 0.5 * most + 1.0


@pytest.mark.parametrize("prescribed", [0.9, 0.5, 0.2])
def test_prescribed_neighbours_line_up_no_farther(prescribed: float) -> None:
    """Around a disc of radius 1 free ones as large and smaller prescribed ones, all touching and not overlapping."""
    half = np.sqrt([1.0 / 2.0, prescribed / (1.0 + prescribed)])  # sin^2(angle/2) = r_j r_k/((r + r_j) (r + r_k))
    gaps = 2.0 * np.arcsin(half[:, None] * half)
    around = Neighbours(smallest=1.0, prescribed=prescribed, rows=(), overlap=0.0)
    most, aligned = crowd(1.0, around)
    best = best_around(gaps, np.array([1.0, FIXED_WEIGHT]), 360)
    assert best <= aligned < 1.2 * best  # sectors give some away
    assert 2.0 * best <= 1.2 * most


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


def ring(partner: float, *, half: bool) -> Grains:
    """A disc among prescribed ones of radius `partner` (in RADIUS) all around, or on one half and free ones below."""
    grains = Grains.discs([[0.0, 0.0]], RADIUS, DENSITY)
    step = 2.0 * math.asin(partner / (1.0 + partner)) * 1.000001
    turn = step * np.arange(int((math.pi if half else 2.0 * math.pi) / step))
    reach = (1.0 + partner - 1e-6) * RADIUS
    if half:
        free = np.append(0.0, -np.radians([30.0, 90.0, 150.0]))
        place = (2.0 - 1e-6) * RADIUS * np.column_stack([np.cos(free), np.sin(free)])
        place[0] = 0.0
        grains = Grains.discs(place, RADIUS, DENSITY)
    return grains.with_prescribed(reach * np.column_stack([np.cos(turn), np.sin(turn)]), partner * RADIUS, 0)


@pytest.mark.parametrize("law", LAWS)
def test_no_packing_has_a_smaller_limit(law: str) -> None:
    grains = [flower(ratio, squeeze=0.05, inside=inside) for ratio in (1.0, 1.3, 3.0, 10.0) for inside in (True, False)]
    grains += [cluster(40, smallest=smallest, seed=seed) for smallest in (0.9, 0.3) for seed in (1, 2)]
    grains += [ring(partner, half=half) for partner in (0.1, 0.5, 1.0) for half in (True, False)]
    systems = [full_law(discs, **LAWS[law], time_step=1e-6) for discs in grains]
    systems += [crystal(6, 6, **LAWS[law]), bed(**LAWS[law])]
    for system in systems:
        bound = packing_limit(system.grains, system.contact, damping=system.damping)
        limit = sharp_limit(system)
        assert limit.contacts > 0
        assert bound <= limit.step


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
    one = free.with_prescribed([[1.0, 0.0]], RADIUS, 0)
    assert packing_limit(one, law) == pytest.approx(alone)
    assert beside(RADIUS, 2.0 * RADIUS) == pytest.approx(alone), "no nearer than the grains themselves"
    assert beside(0.25 * RADIUS, 0.5 * RADIUS) < 0.9 * alone, "more small ones find place around it"
    assert beside(RADIUS, 0.4 * RADIUS) < 0.9 * alone, "more that overlap, too"
    with pytest.raises(ParticleError, match="body 0 lie 1e-05 m apart.*space them out, or give a time step"):
        beside(RADIUS, 1e-2 * RADIUS)
    assert packing_limit(Grains.discs(np.zeros((0, 2)), 1.0, 1.0), law) == math.inf


def test_global_damping_counts() -> None:
    grains, law = Grains.discs([[0.0, 0.0]], RADIUS, DENSITY), ContactModel(normal=LinearSpringDashpot(stiffness=1e-9))
    damping = GlobalDamping(translational=40.0)
    assert packing_limit(grains, law, damping=damping) == pytest.approx(
        2.0 / 40.0, rel=1e-3
    )  # the spring is next to nothing
