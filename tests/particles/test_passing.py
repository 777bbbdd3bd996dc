"""Grains that pass through each other are met on their way, whatever their speed and size."""

import numpy as np
import pytest
from discs import FLOOR, normal_only

from particles import Grains, ParticleSystem, Wall

R, DENSITY, DT = 1e-3, 1600.0, 1e-6
SOFT = 1e-9  # N/m: nothing is turned back
THREE_STEPS = 3


def crossing(ratio: float, share: float, *, period: float | None = None) -> ParticleSystem:
    """A disc of radius R flies through the middle of one `ratio` times as large, `share` of R in a step."""
    middle = 0.0 if period is None else 0.999 * period
    rows = [[middle - R * (1.0 + ratio) - 1.3 * share * R, 0.0], [middle, 0.0]]
    grains = Grains.discs(rows, [R, ratio * R], DENSITY, velocity=[[share * R / DT, 0.0], [0.0, 0.0]])
    return normal_only(grains, k_n=SOFT, time_step=DT, period=(period, None))


@pytest.mark.parametrize("share", [0.003, 0.03, 0.3, 0.9, 3.0, 40.0, 1e6])
@pytest.mark.parametrize("ratio", [1.0, 7.0, 1000.0])
def test_a_passage_is_deeper_than_half_where_a_list_is_made(ratio: float, share: float) -> None:
    system = crossing(ratio, share)
    system.advance(int(np.ceil(min(4.0 / share, 2000.0))) + THREE_STEPS)
    assert system.passage.depth > 0.5
    assert {system.passage.grain, system.passage.partner} == {0, 1} and system.passage.wall is None
    assert system.passage.stride == pytest.approx(share, rel=1e-9)


def test_across_a_seam() -> None:
    system = crossing(1.0, 0.9, period=20 * R)
    system.advance(8)
    assert system.passage.depth > 0.5


@pytest.mark.parametrize("share", [0.03, 3.0, 1e6])
def test_through_a_wall(share: float) -> None:
    grains = Grains.discs([[0.0, 1.5 * R]], R, DENSITY, velocity=[[0.0, -share * R / DT]])
    lid = Wall(point=(0.0, 1.0), normal=(0.0, -1.0), name="lid")
    system = normal_only(grains, k_n=SOFT, time_step=DT, walls=[lid, FLOOR])
    system.advance(int(np.ceil(2.0 / share)) + THREE_STEPS)
    assert system.passage.depth > 0.5 and system.passage.wall == 1 and system.passage.partner is None


def test_depth_is_that_of_the_closest_approach_within_the_step() -> None:
    """Discs cast about at up to 50 radii a step, against their distances along the way, sampled."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        n = 12
        place, radius = 60 * R * rng.uniform(-1, 1, (n, 2)), R * rng.uniform(1.0, 4.0, n)
        speed = 50 * R / DT * rng.uniform(-1, 1, (n, 2))
        apart = np.hypot(*(place[:, None] - place[None]).transpose(2, 0, 1)) + 1e3 * np.eye(n)
        if (apart < radius[:, None] + radius).any():
            continue  # the forces of those would change the velocities
        system = normal_only(Grains.discs(place, radius, DENSITY, velocity=speed), k_n=SOFT, time_step=DT)
        system.advance(1)
        deepest = 0.0
        for part in np.linspace(0.0, 1.0, 4001):
            now = place + part * DT * speed
            distance = np.hypot(*(now[:, None] - now[None]).transpose(2, 0, 1)) + 1e3 * np.eye(n)
            depth = (radius[:, None] + radius - distance) / np.minimum(radius[:, None], radius)
            deepest = max(deepest, float(depth.max()))
        if deepest <= 1.0:  # a search ends at the first that is deeper
            # relative ways of up to 140 radii in 4000 parts, half of one off the closest
            assert system.passage.depth == pytest.approx(deepest, abs=0.02)
        else:
            assert system.passage.depth > 1.0 - 0.02


def test_free_flight_is_no_passage_however_fast() -> None:
    rows = [[0.0, 0.0], [0.0, 2.001 * R], [0.5, 0.5]]
    speed = 1e3 * R / DT
    grains = Grains.discs(rows, R, DENSITY, velocity=[[speed, 0.0], [-speed, 0.0], [0.0, 0.0]])
    system = normal_only(grains, k_n=1e4, time_step=DT)
    system.advance(5)
    assert system.passage.depth == 0.0 and system.passage.grain == -1


def test_a_snapshot_goes_back_before_it() -> None:
    system = crossing(1.0, 0.9)
    before = system.snapshot()
    system.advance(8)
    assert system.passage.depth > 0.5
    before.rewind()
    assert system.passage.depth == 0.0
