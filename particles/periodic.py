"""Periodic sides: what lies across a seam is found through copies of the grains near it."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from particles.errors import ParticleError, require
from particles.state import Floats

Period: TypeAlias = tuple[float | None, float | None]

SHIFTS = ((1, 0), (0, 1), (1, 1), (1, -1))  # one of each pair of opposite images
LEAST_RADII = 5.0  # in a period: with the largest skin, two grains then meet across one side only


def checked_period(period: Sequence[float | None], radius: Floats) -> Period:
    """The period as a pair, or a refusal.

    Raises
    ------
    ParticleError
        If a period is not finite, or shorter than 5 of the largest radii.
    """
    for name, length in zip("xy", period, strict=True):
        if length is not None:
            require(f"period in {name}", length)
            if not length >= LEAST_RADII * radius.max():
                raise ParticleError(
                    f"period in {name} = {length:g} m must be at least {LEAST_RADII:g} of the largest radii, "
                    f"{LEAST_RADII * radius.max():g} m: widen it"
                )
    x, y = period
    return (None if x is None else float(x), None if y is None else float(y))


def folded(coordinate: Floats, period: float | None) -> Floats:
    """Coordinates [m] between 0 and the period, or as they are without one."""
    return coordinate if period is None else coordinate - period * np.floor(coordinate / period)


def nearest_image(distance: Floats, period: float | None) -> Floats:
    """Distances [m] to the nearest image, between minus and plus half a period; as they are without one."""
    return distance if period is None else folded(distance + 0.5 * period, period) - 0.5 * period


def with_images(x: Floats, y: Floats, radius: Floats, skin: float, period: Period) -> tuple[Floats, Floats, np.ndarray]:
    """Folded positions (n + k,), and behind them the images that others may reach across a seam.

    Of the images of two grains that meet across a seam, one and only one stands beside the other
    original. Returns x, y [m] and (n + k,) the grain that each of them is.
    """
    place = np.column_stack([folded(x, period[0]), folded(y, period[1])])
    reach = radius + radius.max() + skin
    places, of = [place], [np.arange(len(x))]
    for shift in SHIFTS:
        if any(s != 0 and length is None for s, length in zip(shift, period, strict=True)):
            continue
        near = np.ones(len(x), bool)
        for axis, (s, length) in enumerate(zip(shift, period, strict=True)):
            if s > 0:
                near &= place[:, axis] < reach
            elif s < 0:
                near &= place[:, axis] > length - reach
        image = np.nonzero(near)[0]
        offset = [0.0 if length is None else s * length for s, length in zip(shift, period, strict=True)]
        places.append(place[image] + offset)
        of.append(image)
    place = np.concatenate(places)
    return place[:, 0].copy(), place[:, 1].copy(), np.concatenate(of)
