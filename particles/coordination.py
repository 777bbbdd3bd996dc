"""How many neighbours a disc can have, and how strongly they can line up."""

import math
from dataclasses import dataclass

import numpy as np

from particles.state import Floats

FIXED_WEIGHT = 0.5  # of a prescribed neighbour, which has no mass to share
DIRECTIONS = 2.0 * math.pi * (np.arange(3600) + 0.5) / 3600


@dataclass(frozen=True, kw_only=True)
class Neighbours:
    """Whatever may surround a disc of a packing.

    Attributes
    ----------
    smallest : float
        Radius of the smallest free disc [m].
    prescribed : float or None
        Radius of the smallest prescribed disc [m]; None without any.
    rows : tuple of (radius, spacing)
        Of the prescribed discs of each body that has several [m].
    overlap : float
        Largest overlap of a contact, over the smaller radius. Prescribed discs do not overlap
        unless their spacing says so.
    """

    smallest: float
    prescribed: float | None
    rows: tuple[tuple[float, float], ...]
    overlap: float


def crowd(radius: float, around: Neighbours) -> tuple[float, float]:
    """Most contacts of a disc of `radius`, and the largest eigenvalue of the sum of ``n n^T`` over them.

    Upper bounds over all packings; a prescribed neighbour counts by `FIXED_WEIGHT`, a wall as a
    free disc. Neighbours keep an angle between them. If all are free, `side_by_side` is exact. With
    prescribed ones every neighbour gets a sector of its own, such that two sectors make no more
    than twice the smallest angle between their neighbours; the rest is `in_sectors`, at the better
    of two ways to cut.
    """
    e, small = around.overlap, around.smallest
    free = _angle(radius, (small, small), (2.0 - e) * small, e)
    if around.prescribed is None:
        return side_by_side(free)
    fixed = around.prescribed
    beside = [(fixed, 2.0 * fixed), *around.rows]
    own = min(_angle(radius, (r, r), apart, e) for r, apart in beside)
    mixed = _angle(radius, (small, fixed), small + fixed - e * min(small, fixed), e)
    if min(own, 2.0 * mixed - free) >= free:  # they take more place than free ones and count for less
        return side_by_side(free)
    cuts = [(free, min(own, 2.0 * mixed - free)), (min(free, 2.0 * mixed - own), own)]
    bounds = [in_sectors(*cut) for cut in cuts if min(cut) > 0.0]
    most, aligned = np.min(bounds, axis=0)
    return float(most), float(aligned)


def side_by_side(angle: float) -> tuple[float, float]:
    """Most contacts that keep an angle [rad], and largest eigenvalue of their sum of ``n n^T``.

    The eigenvalue is the largest sum of cos^2 of their directions from an axis: side by side around
    either end of it, p contacts have ``(p + cos(2 a) sin(p angle)/sin(angle))/2``, a the turn of their
    middle from the axis, with none of them beyond the perpendicular.
    """
    most = int(2.0 * math.pi / angle * (1.0 + 1e-9))
    side = np.arange(int(math.pi / angle * (1.0 + 1e-9)) + 2)
    spread = np.sin(side * angle) / math.sin(angle)
    turned = np.maximum(math.pi - (side - 1) * angle, 0.0)  # 2 a at most; tried where a turn is better
    held = 0.5 * (side + np.where(spread < 0.0, spread * np.cos(turned), spread))
    one = side[side <= most]
    other = np.maximum.accumulate(held)[np.minimum(most - one, len(held) - 1)]
    return float(most), float((held[one] + other).max())


def in_sectors(free: float, fixed: float) -> tuple[float, float]:
    """The same with free and prescribed contacts that have sectors [rad] of their own, by their weights.

    Of a contact in the middle of a sector s, cos^2 is the integral over it of ``(1 + c cos 2 psi)/(2 s)``,
    ``c = s/sin(s)``: the sum is at most the integral over all directions of the largest density.
    """
    number = np.arange(int(2.0 * math.pi / free * (1.0 + 1e-9)) + 1)
    left = np.floor(np.maximum(2.0 * math.pi - number * free, 0.0) / fixed * (1.0 + 1e-9))
    most = float((number + FIXED_WEIGHT * left).max())
    densities = [_density(free), FIXED_WEIGHT * _density(fixed), np.zeros(len(DIRECTIONS))]
    return most, float(2.0 * math.pi * np.max(densities, axis=0).mean())


def _density(sector: float) -> Floats:
    return (1.0 + sector / math.sin(sector) * np.cos(2.0 * DIRECTIONS)) / (2.0 * sector)


def _angle(radius: float, neighbours: tuple[float, float], apart: float, overlap: float) -> float:
    """Smallest angle [rad] at a disc between the centres of two neighbours (radii) that are `apart` at least."""
    cosines = []
    for lost in ((0.0, 0.0), (overlap, 0.0), (0.0, overlap)):
        a, b = (radius + r * (1.0 - depth) for r, depth in zip(neighbours, lost, strict=True))
        cosines.append((a * a + b * b - apart * apart) / (2.0 * a * b))
    return math.acos(min(max(*cosines, -1.0), 1.0))
