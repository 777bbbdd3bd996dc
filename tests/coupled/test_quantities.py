"""Numbers of interest out of curves and beds whose answer is known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coupled.errors import QuantityError
from coupled.quantities.curve import Curve
from coupled.quantities.frequency import frequency_of
from coupled.quantities.surface import mean_height, slope_angle


def parabola() -> Curve:
    time = np.linspace(0.0, 2.0, 2001)
    return Curve(name="height", time=time, value=1.0 - time**2 / 2)


def test_window_of_a_parabola() -> None:
    """Linear pieces of 1e-3 s miss ``1 - t^2/2`` by 1e-6/8 at most; the window's ends lie between rows."""
    part = parabola().between(0.50005, 1.50005)
    third = (1.50005**3 - 0.50005**3) / 6
    assert part.mean() == pytest.approx(1.0 - third, abs=2e-7)
    assert part.value[0] - part.value[-1] == pytest.approx((1.50005**2 - 0.50005**2) / 2, abs=2e-7)
    assert part.time[0] == 0.50005 and part.time[-1] == 1.50005


def test_first_time_of_a_fall() -> None:
    """A fall of 1 takes sqrt 2 s; the linear piece misses it by 1e-6/8 over the slope."""
    assert parabola().first_time_at(0.0) == pytest.approx(math.sqrt(2.0), abs=1.5e-7)


def test_the_first_of_several_times_and_an_exact_row() -> None:
    time = np.arange(5.0)
    there_and_back = Curve(name="depth", time=time, value=np.array([0.0, 1.0, 2.0, 1.0, 0.0]))
    assert there_and_back.first_time_at(1.0) == 1.0
    assert there_and_back.first_time_at(1.5) == 1.5
    assert there_and_back.first_time_at(0.0) == 0.0


def test_the_end_of_a_run_that_is_not_a_whole_number_of_steps_long() -> None:
    """Steps of 0.3 s end at 0.9 s where 1 s is asked for; rows of every step."""
    time = 0.3 * np.arange(4)
    curve = Curve(name="a", time=time, value=2.0 * time)
    assert curve.at(1.0) == pytest.approx(1.8) and curve.between(0.3, 1.0).mean() == pytest.approx(1.2)
    with pytest.raises(QuantityError, match="t = 1.1 s is outside the run"):
        curve.at(1.1)


def test_what_a_run_does_not_have() -> None:
    with pytest.raises(QuantityError, match="never reaches -2: it stays between -1 and 1"):
        parabola().first_time_at(-2.0)
    with pytest.raises(QuantityError, match="t = 3 s is outside the run"):
        parabola().at(3.0)
    with pytest.raises(QuantityError, match="does not oscillate"):
        frequency_of(parabola().time, parabola().value, "height")


@pytest.mark.parametrize(("frequency", "decay"), [(279.0, 0.0), (13.7, 0.0), (13.7, 2.0)])
def test_frequency_of_a_damped_sine(frequency: float, decay: float) -> None:
    """Samples of what is fitted give its frequency to round-off of the fit, at 20 samples per period or 2.5."""
    for per_period in (20.0, 2.5):
        time = np.arange(0.0, 12.3 / frequency, 1.0 / (per_period * frequency))
        value = 3.0 + 0.1 * np.exp(-decay * time) * np.cos(2 * np.pi * frequency * time - 0.4)
        assert frequency_of(time, value, "sine") == pytest.approx(frequency, rel=1e-9)


def test_frequency_with_noise_is_as_good_as_samples_allow() -> None:
    """Cramer and Rao: the deviation is at least ``sqrt(6/N)/(pi T) s/A``; least squares come near it."""
    frequency, count, duration, noise = 5.0, 2000, 4.0, 0.2
    time = np.linspace(0.0, duration, count)
    rng = np.random.default_rng(3)
    found = [
        frequency_of(time, np.sin(2 * np.pi * frequency * time) + noise * rng.standard_normal(count), "noisy")
        for _ in range(40)
    ]
    bound = math.sqrt(6.0 / count) / (math.pi * duration) * noise
    # the sample deviation of 40 draws is known to 11 %; three of these above the bound
    assert np.std(found) < 1.35 * bound * 1.05
    assert abs(np.mean(found) - frequency) < 4 * bound / math.sqrt(40)


def test_surface_of_equal_discs_in_a_row() -> None:
    """Touching discs of radius r: their envelope has the mean ``pi r/4`` above the centres."""
    r = 0.5
    x = np.arange(40) * 2 * r + r
    height = mean_height(x, np.full(40, 2.0), np.full(40, r), 0.0, 40.0 * 2 * r)
    # the midpoint rule with 20 places per diameter on the ends of half circles, vertical there
    assert height == pytest.approx(2.0 + math.pi * r / 4, abs=2e-3)


@pytest.mark.parametrize("angle", [0.0, 21.0, -28.0])
def test_slope_of_a_pile(angle: float) -> None:
    """Rows of discs whose tops lie on a line; steps of a lattice leave half a diameter at the ends."""
    r, slope = 0.5, math.tan(math.radians(angle))
    x, y = (a.ravel() for a in np.meshgrid(np.arange(400) * 2 * r, np.arange(-240, 240) * 2 * r))
    below = y < slope * x
    found = slope_angle(x[below], y[below], np.full(below.sum(), r), 0.0, 399.0)
    assert found == pytest.approx(angle, abs=math.degrees(2 * r / 399))


def test_surface_without_grains() -> None:
    with pytest.raises(QuantityError, match="no grains lie between x = 5 and 6 m"):
        mean_height(np.zeros(1), np.zeros(1), np.ones(1), 5.0, 6.0)
