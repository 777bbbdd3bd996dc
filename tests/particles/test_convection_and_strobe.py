"""Convection of flows in closed form, and one look per period."""

import math

import numpy as np
import pytest

from particles import ParticleError
from particles.measures import Cells, convection, portrait, strobe

PERIOD = 8.0


def rolls(x: np.ndarray, y: np.ndarray, height: float = 4.0) -> np.ndarray:
    """Steps of two rolls side by side in a period, stream function ``0.1 sin(2 pi x/8) sin(pi y/4)``."""
    a, b = 2.0 * math.pi / PERIOD, math.pi / height
    return 0.1 * np.column_stack([b * np.sin(a * x) * np.cos(b * y), -a * np.cos(a * x) * np.sin(b * y)])


def lattice_of_middles(fine: int) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(PERIOD * (np.arange(2 * fine) + 0.5) / (2 * fine), 4.0 * (np.arange(fine) + 0.5) / fine)
    return x.ravel(), y.ravel()


def mean_of_rolls(cells: Cells) -> np.ndarray:
    """Exact averages over the cells: differences of the stream function along their sides."""
    a, b, (wide, high) = 2.0 * math.pi / PERIOD, math.pi / 4.0, cells.size
    west, south = wide * np.arange(cells.columns), high * np.arange(cells.rows)[:, None]

    def over_x(y):  # integral of sin(a x) along a side
        return 0.1 * (np.cos(a * west) - np.cos(a * (west + wide))) / a * np.sin(b * y)

    def over_y(x):
        return 0.1 * np.sin(a * x) * (np.cos(b * south) - np.cos(b * (south + high))) / b

    across = (over_x(south + high) - over_x(south)) / (wide * high)
    up = -(over_y(west + wide) - over_y(west)) / (wide * high)
    return np.stack([across, up], axis=-1)


@pytest.mark.parametrize("seam", [0.0, 2.0, -19.0])
def test_rolls_are_found_wherever_the_seam_lies(seam):
    cells = Cells(left=seam, width=PERIOD, height=4.0, columns=8, rows=4, period=(PERIOD, None))
    x, y = lattice_of_middles(64)
    step = rolls(x, y)
    middle = np.column_stack([x, y])
    found = convection([middle - 0.5 * step, middle + 0.5 * step], cells)
    expected = np.roll(mean_of_rolls(cells), -round(seam), axis=1)
    # midpoint rule with 16 x 16 points in a cell: (pi/4)^2 (1/16)^2/24 = 1e-4 of the field per direction
    np.testing.assert_allclose(found.displacement, expected, atol=3e-4 * 0.1)
    assert (found.count == 256).all()


def test_a_shift_of_all_grains_is_a_constant_field_over_many_periods():
    rng = np.random.default_rng(1)
    place = np.column_stack([PERIOD * rng.random(300), 4.0 * rng.random(300)])
    cells = Cells(width=PERIOD, height=100.0, columns=4, rows=1, period=(PERIOD, None))
    found = convection((place + k * np.array([1.3, 0.25]) for k in range(40)), cells)
    np.testing.assert_allclose(found.displacement, np.broadcast_to([1.3, 0.25], (1, 4, 2)), rtol=1e-12)
    assert found.count.sum() == 39 * 300 and len(found.roll) == 39
    np.testing.assert_allclose(found.roll, 0.0, atol=1e-13)


def test_the_roll_is_positive_where_the_middle_rises():
    x, y = lattice_of_middles(32)
    cells = Cells(width=PERIOD, height=4.0, columns=8, rows=4)
    middle, step = np.column_stack([x, y]), rolls(x, y)
    found = convection([middle - 0.5 * step, middle + 0.5 * step], cells)
    # rise -0.1 a cos(a x) sin(b y): its mean over the middle half is 0.1 a (2/pi)(2/pi),
    # over the outer half the opposite
    expected = 2.0 * 0.1 * (2.0 * math.pi / PERIOD) * (2.0 / math.pi) ** 2
    assert found.roll[0] == pytest.approx(expected, rel=1e-2)


def test_a_cell_without_grains_has_no_number():
    cells = Cells(width=2.0, height=1.0, columns=2, rows=1)
    found = convection([np.array([[0.5, 0.5]]), np.array([[0.6, 0.5]])], cells)
    assert np.isnan(found.displacement[0, 1]).all() and found.count.tolist() == [[1, 0]]


def test_no_roll_is_known_of_grains_that_stay_on_one_side():
    cells = Cells(width=4.0, height=1.0, columns=4, rows=1)
    places = np.array([[[0.5, 0.5], [3.5, 0.5]], [[0.5, 0.6], [3.5, 0.5]], [[1.9, 0.6], [3.5, 0.4]]])
    # the first period has both at the sides; in the second one goes through the middle, and the other sinks
    np.testing.assert_allclose(convection(places, cells).roll, [np.nan, 0.1])


def test_convection_refuses_one_moment_and_other_grains():
    cells = Cells(width=2.0, height=1.0, columns=2, rows=1)
    with pytest.raises(ParticleError, match="two moments"):
        convection([np.zeros((3, 2))], cells)
    with pytest.raises(ParticleError, match="same grains"):
        convection([np.zeros((3, 2)), np.zeros((2, 2))], cells)


@pytest.mark.parametrize("phase", [0.0, 0.25, 0.37, 0.9])
def test_rise_per_period_does_not_see_the_shaking(phase):
    time = 0.2 * np.arange(501)  # 20 rows a period of 4
    height = 3.0 + 0.05 * time + 0.8 * np.sin(2.0 * math.pi * (time - 2.0) / 4.0)
    found = strobe(time, height, period=4.0, start=2.0, phase=phase)
    np.testing.assert_allclose(found.rise, 0.2, atol=1e-12)
    np.testing.assert_allclose((found.time - 2.0) / 4.0 % 1.0, phase, atol=1e-12)
    assert found.time[0] == pytest.approx(2.0 + 4.0 * phase) and found.time[-1] > time[-1] - 4.0


def test_looks_fall_on_the_rows_at_both_ends():
    time = np.arange(9.0)
    found = strobe(time, time**2, period=4.0)
    assert found.value.tolist() == [0.0, 16.0, 64.0] and found.rise.tolist() == [16.0, 48.0]


def test_a_record_without_a_whole_period_is_refused():
    with pytest.raises(ParticleError, match="run longer"):
        strobe(np.arange(5.0), np.arange(5.0), period=4.0, start=1.0)
    with pytest.raises(ParticleError, match="period = 0"):
        strobe(np.arange(5.0), np.arange(5.0), period=0.0)


def test_portrait_over_the_phase():
    time = 1.0 + 0.003 * np.arange(40_000)
    found = portrait(time, np.cos(2.0 * math.pi * (time - 1.0) / 3.0), period=3.0, start=1.0, bins=12)
    centre = np.arange(12) / 12.0
    dulled = math.sin(math.pi / 12.0) / (math.pi / 12.0)  # the mean of a cosine over a bin
    # a bin's points sample it at steps of 1e-3 of the period: the mean is off by 2 pi 1e-3/2 at most
    np.testing.assert_allclose(found.mean, dulled * np.cos(2.0 * math.pi * centre), atol=4e-3)
    assert found.deviation.max() < 2.0 * math.pi / 12.0 / math.sqrt(12.0) * 1.01
    # ten rows a period: each has a bin of its own, although round-off puts phases on either side of it
    rows = 4.0 + 0.4 * np.arange(2001)
    assert (portrait(rows, np.arange(2001) % 10, period=4.0, start=4.0, bins=10).deviation == 0.0).all()
    late = portrait(time, time, period=3.0, start=50.0)
    assert late.value.min() >= 50.0 and ((late.phase >= 0.0) & (late.phase < 1.0)).all()
