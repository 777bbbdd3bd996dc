"""Periodic sides: distances to the nearest image."""

import numpy as np

from particles.kernels.jit import by_law


@by_law
def nearest(period, distance):
    """Distance to the nearest image. Positions are never folded back, so any number of periods may lie between."""


@nearest.of(None)
def _(period, distance):
    return distance


@nearest.of(float)
def _(period, distance):
    if abs(distance) < 0.5 * period:  # all but those across a seam
        return distance
    return distance - period * np.floor(distance / period + 0.5)
