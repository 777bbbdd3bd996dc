"""Which points of a polyline a disc meets, and that their forces make one smooth field."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings
from polylines import closed, ground, normal_force, standing, star

from particles import Facets, Grains, ParticleError, ParticleSystem

EPS = np.finfo(float).eps
SOME = settings(deadline=None, derandomize=True, max_examples=25, print_blob=False)
FINE = 3000  # samples of each facet


def extrema(corners: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points of a closed polygon where its distance to `place` has a local minimum, and a local maximum."""
    along = np.arange(FINE) / FINE
    points = (corners[:, None] + along[:, None] * (np.roll(corners, -1, axis=0) - corners)[:, None]).reshape(-1, 2)
    d = np.hypot(*(points - place).T)
    before, after = np.roll(d, 1), np.roll(d, -1)
    return points[(d < before) & (d <= after)], points[(d > before) & (d >= after)]


def by_extrema(corners: np.ndarray, place: np.ndarray, radius: float) -> np.ndarray:
    """Springs of stiffness 1 at all minima of the distance below the radius, less those at maxima."""
    force = np.zeros(2)
    for sign, points in zip((1.0, -1.0), extrema(corners, place), strict=True):
        away = place - points
        d = np.hypot(*away.T)
        near = d < radius
        force += sign * ((radius - d[near]) / d[near]) @ away[near]
    return force


@SOME
@given(n=st.integers(3, 12), roughness=st.floats(0.0, 0.6), seed=st.integers(0, 999), radius=st.floats(0.02, 0.5))
def test_forces_are_those_of_the_extrema_of_the_distance(n: int, roughness: float, seed: int, radius: float) -> None:
    """Random polygons with corners and notches against a search along their finely sampled sides."""
    corners = star(n, roughness, seed)
    random = np.random.default_rng(seed)
    side = random.integers(0, n, 30)
    on = corners[side] + random.uniform(0.0, 1.0, (30, 1)) * (np.roll(corners, -1, axis=0) - corners)[side]
    place = on * (1.0 + random.uniform(0.3, 1.2, (30, 1)) * radius / np.hypot(*on.T)[:, None])
    nearest = np.array([np.hypot(*(extrema(corners, p)[0] - p).T).min() for p in place])
    place = place[nearest > 0.05 * radius]  # outside: pressed in by less than the radius
    expected = np.array([by_extrema(corners, p, radius) for p in place])
    # A sampled extremum lies within half a spacing of the true one: h^2/8d in distance, h/2d in direction.
    spacing, least = 2.0 / FINE, 0.05 * radius
    error = radius * spacing / least
    np.testing.assert_allclose(normal_force(place, radius, closed(corners)), expected, atol=4.0 * error)


@pytest.mark.parametrize("turn", [0.7, 0.1, 1e-3, 1e-6, 0.0, -1e-6, -1e-3, -0.1, -0.7])
def test_force_has_no_jump_on_the_way_over_a_node(turn: float) -> None:
    """A corner (turn > 0) or a notch: the jump between neighbouring places falls with their distance."""
    facets = ground(np.array([-3.0, 0.0, 3.0]), np.array([-3.0, 0.0, -3.0]) * np.tan(turn / 2))
    jumps = []
    for n in (2001, 4001, 8001):
        x = min(0.5, abs(turn) or 0.5) * np.linspace(-1.0, 1.0, n)  # a wedge is as wide as its node turns
        high = 0.9 if turn < 0.0 else 0.9 - 0.2 * x**2
        force = normal_force(np.column_stack([x, np.broadcast_to(high, n)]), 1.0, facets)
        jumps.append(np.abs(np.diff(force, axis=0)).max())
    assert jumps[1] <= 0.55 * jumps[0] + 8.0 * EPS
    assert jumps[2] <= 0.55 * jumps[1] + 8.0 * EPS


def work_around(corners: np.ndarray, n: int) -> float:
    """Work of the normal forces on a closed path of n steps around a polygon, over the sum of its magnitudes."""
    turn = 2.0 * np.pi * np.arange(n) / n
    path = (1.22 + 0.05 * np.cos(5.0 * turn))[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    force = normal_force(path, 0.3, closed(corners))
    assert (np.hypot(*force.T) > 0.0).all()
    terms = 0.5 * (force * (np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0))).sum(axis=1)
    return abs(terms.sum()) / np.abs(terms).sum()


def test_normal_forces_have_a_potential() -> None:
    """No work on a path that leads a disc over corners and shallow notches, deep enough to cover several nodes."""
    polygons = [star(40, 0.02, seed) for seed in range(6)]
    coarse, fine = (np.mean([work_around(corners, n) for corners in polygons]) for n in (500, 8000))
    # Kinks of the force leave order 2, 1/256; a jump would leave order 1, 1/16.
    assert fine < 1e-5
    assert fine < coarse / 64.0


@pytest.mark.parametrize("n", [1, 2, 7, 100])
def test_nodes_on_a_straight_line_are_not_felt(n: int) -> None:
    """Flat ground of n facets, discs anywhere, above nodes too: force k delta upwards, to round-off."""
    node = np.linspace(-1.0, 1.0, n + 1)
    x = np.concatenate([np.linspace(-0.9, 0.9, 77), node[1:-1], np.nextafter(node[1:-1], 9.0)])
    force = normal_force(np.column_stack([x, np.full_like(x, 0.45)]), 0.5, ground(node))
    np.testing.assert_allclose(force, np.tile([0.0, 0.05], (len(x), 1)), atol=8.0 * EPS)


def test_count_of_contacts_on_a_shallow_notch_is_one() -> None:
    system = standing(np.array([[0.0, 0.9], [0.9, 0.9]]), 1.0, ground(np.array([-2.0, 0.0, 2.0]), [1e-3, 0.0, 1e-3]))
    assert system.look().contacts.tolist() == [1, 1]
    sharp = standing(np.array([[0.0, 1.3]]), 1.0, ground(np.array([-2.0, 0.0, 2.0]), [2.0, 0.0, 2.0]))
    assert sharp.look().contacts.tolist() == [2]


def test_open_end_is_a_tip() -> None:
    """Beyond the end, below its level too, the last node is a point."""
    place = np.array([[1.3, 0.4], [1.45, -0.1], [1.05, -0.45]])
    force = normal_force(place, 0.5, ground(np.linspace(0.0, 1.0, 4)))
    away = place - [1.0, 0.0]
    d = np.hypot(*away.T)[:, None]
    np.testing.assert_allclose(force, np.maximum(0.5 - d, 0.0) * away / d, atol=4.0 * EPS)


@pytest.mark.parametrize("inside", [0.0, 0.2, 0.4])
def test_centre_inside_is_pushed_out(inside: float) -> None:
    """Up to half a radius behind a facet the spring goes on; a square of side 2."""
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    force = normal_force(np.array([[0.1, 1.0 - inside * 0.5]]), 0.5, closed(square))
    np.testing.assert_allclose(force, [[0.0, 0.5 * (1.0 + inside)]], atol=8.0 * EPS)


def test_disc_lost_inside_is_seen() -> None:
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    grains = Grains.discs([[0.0, 0.4], [3.0, 0.0]], 0.1, 1.0)
    system = ParticleSystem(grains, standing(grains.position, 0.1, closed(square)).contact, time_step=1e-3,
                            facets=closed(square))  # fmt: skip
    look = system.look()
    assert look.count == 0
    assert look.deepest == pytest.approx(7.0) and system.grains.number[look.deepest_at] == 0


def test_thin_body_has_one_side_for_each_disc() -> None:
    """A plate thinner than a tenth of the radius: the far face is not felt."""
    plate = np.array([[-2.0, 0.0], [2.0, 0.0], [2.0, 0.04], [-2.0, 0.04]])
    force = normal_force(np.array([[0.3, 0.5], [0.3, -0.46]]), 0.5, closed(plate))
    np.testing.assert_allclose(force, [[0.0, 0.04], [0.0, -0.04]], atol=8.0 * EPS)


@pytest.mark.parametrize(
    ("facets", "said"),
    [
        ({"points": [[0.0, 0.0], [1.0, np.nan]], "facets": [[0, 1]]}, "node 1 .* not finite"),
        ({"points": [[0.0, 0.0], [1.0, 0.0]], "facets": [[0, 2]]}, "nodes 0 to 2, but there are 2"),
        ({"points": [[0.0, 0.0], [0.0, 0.0]], "facets": [[0, 1]]}, "facet 0 has no length"),
        ({"points": [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], "facets": [[0, 1], [0, 2]]}, "node 0 begins two facets"),
        ({"points": [[0.0, 0.0], [1.0, 0.0]], "facets": []}, "at least one pair"),
    ],
)
def test_bad_facets_are_refused(facets: dict[str, list], said: str) -> None:
    with pytest.raises(ParticleError, match=said):
        Facets(**facets)


def test_facets_and_periodic_sides_are_refused() -> None:
    grains = Grains.discs([[0.5, 1.0]], 0.1, 1.0)
    contact = standing(grains.position, 0.1, ground(np.array([0.0, 1.0]))).contact
    with pytest.raises(ParticleError, match="facets do not go together with periodic sides"):
        ParticleSystem(grains, contact, time_step=1e-3, period=(1.0, None), facets=ground(np.array([0.0, 1.0])))
