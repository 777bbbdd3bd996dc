"""The surface of a bed: the upper envelope of its discs."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from coupled.errors import QuantityError

Floats = NDArray[np.float64]
PER_DIAMETER = 20  # places per mean diameter at which the envelope is taken


def envelope(x: Floats, y: Floats, radius: Floats, places: Floats) -> Floats:
    """Height of the highest point of any disc above each place, ``max_i y_i + sqrt(r_i^2 - (x_i - s)^2)``.

    Parameters
    ----------
    x, y, radius : (n,)
        Discs [m].
    places : (m,)
        Ascending abscissae s [m].

    Returns
    -------
    (m,) heights [m], minus infinity where no disc is.
    """
    height = np.full(len(places), -np.inf)
    first = np.searchsorted(places, x - radius, side="left")
    last = np.searchsorted(places, x + radius, side="right")
    for shift in range(int((last - first).max(initial=0))):
        above = first + shift < last
        under = (first + shift)[above]
        reach = radius[above] ** 2 - (x[above] - places[under]) ** 2
        np.maximum.at(height, under, y[above] + np.sqrt(np.maximum(reach, 0.0)))
    return height


def surface(x: Floats, y: Floats, radius: Floats, left: float, right: float) -> tuple[Floats, Floats]:
    """Places and heights [m] of the surface between two ends [m], gaps without a disc left out.

    Raises
    ------
    QuantityError
        If fewer than two of the places have a disc.
    """
    if len(radius) == 0:
        raise _nothing_between(left, right)
    count = max(2, math.ceil((right - left) / (2.0 * float(radius.mean())) * PER_DIAMETER))
    places = left + (np.arange(count) + 0.5) * (right - left) / count
    height = envelope(x, y, radius, places)
    covered = np.isfinite(height)
    if np.count_nonzero(covered) < 2:
        raise _nothing_between(left, right)
    return places[covered], height[covered]


def _nothing_between(left: float, right: float) -> QuantityError:
    return QuantityError(f"no grains lie between x = {left:g} and {right:g} m")


def mean_height(x: Floats, y: Floats, radius: Floats, left: float, right: float) -> float:
    """Mean height of the surface [m]."""
    return float(surface(x, y, radius, left, right)[1].mean())


def slope_angle(x: Floats, y: Floats, radius: Floats, left: float, right: float) -> float:
    """Angle of the surface's line of least squares [degrees], positive where it rises to the right."""
    places, height = surface(x, y, radius, left, right)
    slope = np.polynomial.polynomial.polyfit(places - places.mean(), height, 1)[1]
    return math.degrees(math.atan(float(slope)))
