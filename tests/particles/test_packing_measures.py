"""Packing fractions against closed forms, a raster, and sums that cannot change."""

import math

import numpy as np
import pytest

from particles import ParticleError
from particles.measures import Cells, area_below, area_in_quadrant, fraction_in_cells, fraction_in_strips

EPS = np.finfo(float).eps


def random_discs(seed: int, n: int, width: float, height: float):
    rng = np.random.default_rng(seed)
    return width * rng.random(n), height * rng.random(n), 0.05 + 0.3 * rng.random(n)


def hexagonal(columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Touching discs of diameter 1; periods `columns` and ``rows sqrt(3)/2``, rows even."""
    row, column = np.divmod(np.arange(columns * rows), columns)
    return column + 0.5 * (row % 2), 0.5 * math.sqrt(3.0) * row


@pytest.mark.parametrize(
    ("height", "area"),
    [
        (-1.0, 0.0),
        (-0.5, math.pi / 3.0 - math.sqrt(3.0) / 4.0),  # a segment of 120 degrees
        (0.0, math.pi / 2.0),
        (math.sqrt(0.5), 0.75 * math.pi + 0.5),  # all but a segment of 90 degrees
        (2.0, math.pi),
    ],
)
def test_area_below_a_line(height, area):
    assert area_below(3.0 * height, 3.0) == pytest.approx(9.0 * area, abs=20 * EPS)


@pytest.mark.parametrize(
    ("a", "b", "area"),
    [
        (0.0, 0.0, math.pi / 4.0),
        (1.0, 0.0, math.pi / 2.0),
        (0.0, 5.0, math.pi / 2.0),
        (math.sqrt(0.5), math.sqrt(0.5), 0.5 * math.pi + 1.0),  # on the circle: all but two segments of 90 degrees
        (0.5, -0.5, math.pi / 4.0 - 0.25),  # the corner in the disc; by symmetry with (-0.5, 0.5)
        (-0.8, 0.8, 0.0 + math.acos(0.8) - 0.48),  # the corner outside: a whole segment
        (-0.9, -0.9, 0.0),
    ],
)
def test_area_in_a_quadrant(a, b, area):
    assert area_in_quadrant(a, b, 1.0) == pytest.approx(area, abs=20 * EPS)


def test_area_in_a_quadrant_is_the_integral_of_chords():
    rng = np.random.default_rng(3)
    x = -1.0 + (np.arange(40_000) + 0.5) / 20_000
    chord = np.sqrt(1.0 - x * x)
    for a, b in rng.uniform(-1.3, 1.3, (40, 2)):
        height = np.clip(b, -chord, chord) + chord
        # midpoint rule on a function with roots at its ends: error of order h^1.5, h = 5e-5
        assert area_in_quadrant(a, b, 1.0) == pytest.approx(height[x < a].sum() / 20_000, abs=6e-5)


def test_cells_of_a_periodic_plane_hold_all_area_wherever_the_seam_lies():
    x, y, radius = random_discs(1, 60, 4.0, 3.0)
    cells = Cells(width=4.0, height=3.0, columns=8, rows=5, period=(4.0, 3.0))
    found = fraction_in_cells(x, y, radius, cells)
    assert found.mean() * 12.0 == pytest.approx((math.pi * radius**2).sum(), rel=1e3 * EPS)
    moved = fraction_in_cells(x + 1.5 - 8.0, y + 3 * 0.6, radius, cells)  # three cells and two periods; three rows
    np.testing.assert_allclose(moved, np.roll(found, (3, 3), axis=(0, 1)), atol=1e3 * EPS)


def test_cells_with_edges_agree_with_a_raster():
    x, y, radius = random_discs(2, 25, 4.0, 3.0)
    cells = Cells(left=0.7, bottom=0.4, width=2.4, height=1.8, columns=4, rows=3)
    px, py = 0.7 + 2.4 * (np.arange(400) + 0.5) / 400, 0.4 + 1.8 * (np.arange(300) + 0.5) / 300
    discs = zip(x, y, radius, strict=True)
    cover = sum(((px - a) ** 2 + (py[:, None] - b) ** 2 < r * r).astype(int) for a, b, r in discs)
    raster = cover.reshape(3, 100, 4, 100).mean(axis=(1, 3))
    # outlines of all discs cross some 2000 of the 10 000 pixels of a cell, each off by half a pixel of random sign
    np.testing.assert_allclose(fraction_in_cells(x, y, radius, cells), raster, atol=8e-3)


def test_strips_of_a_crystal():
    x, y = hexagonal(6, 8)
    period = 4.0 * math.sqrt(3.0)
    half = np.full(len(x), 0.5)
    cells = Cells(width=6.0, height=period, columns=1, rows=8, period=(6.0, period))
    dense = math.pi / (2.0 * math.sqrt(3.0))
    np.testing.assert_allclose(fraction_in_cells(x, y, half, cells), dense, rtol=1e3 * EPS)
    inner = np.array([1.0, 1.5, 2.0]) * math.sqrt(3.0)  # between centres of rows: half a row above, half below
    np.testing.assert_allclose(fraction_in_strips(y, half, inner, 6.0), dense, rtol=1e3 * EPS)


def test_one_row_cut_by_thin_strips():
    radius, edges = np.full(10, 0.5), np.array([0.0, 0.25, 0.5, 1.0, 1.5])
    found = fraction_in_strips(np.full(10, 0.5), radius, edges, 10.0)
    low = (math.pi / 3.0 - math.sqrt(3.0) / 4.0) / 4.0
    np.testing.assert_allclose(found, [low / 0.25, (math.pi / 8.0 - low) / 0.25, math.pi / 4.0, 0.0], atol=1e2 * EPS)


def test_refusals():
    with pytest.raises(ParticleError, match="rising heights"):
        fraction_in_strips(np.zeros(1), np.ones(1), [0.0, 0.0, 1.0], 1.0)
    with pytest.raises(ParticleError, match="width of the strips = 0"):
        fraction_in_strips(np.zeros(1), np.ones(1), [0.0, 1.0], 0.0)
    with pytest.raises(ParticleError, match="hold a grain twice"):
        Cells(width=5.0, height=1.0, columns=2, rows=2, period=(4.0, None))
    with pytest.raises(ParticleError, match="columns of the cells = 0"):
        Cells(width=5.0, height=1.0, columns=0, rows=2)
