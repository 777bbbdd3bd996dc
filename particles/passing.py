"""Grains that were deep in each other or in a wall between two looks, or passed through within one step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from particles.kernels import passing
from particles.kernels.layout import GrainArrays
from particles.neighbours import ContactList
from particles.state import Grains

THROUGH = 1.0  # overlap over the smaller radius at which a search for passages may end


@dataclass(frozen=True, kw_only=True)
class Passage:
    """The deepest overlap that was met on the way.

    Attributes
    ----------
    depth : float
        Overlap over the smaller radius, the largest within a step.
    grain : int
        Number that the grain had at the beginning.
    partner : int or None
        Number of the other grain; None at a wall.
    wall : int or None
        Number of the wall; None at a grain.
    stride : float
        Way against the partner in that step, over the smaller radius.
    """

    depth: float = 0.0
    grain: int = -1
    partner: int | None = None
    wall: int | None = None
    stride: float = 0.0


def deepest_passage(grains: Grains, arrays: GrainArrays, listed: ContactList, dt: float, before: Passage) -> Passage:
    """The deepest passage of the step `dt` [s] that ends with a new list, or `before` if that was deeper.

    The list is made anew before a grain has gone half the smallest radius. A pair that is deeper than half
    of that one is met at least once before its centres have passed each other; what goes too far in a
    step to be listed at its end is looked for among all grains.
    """
    depth, at, other, in_wall, grain, wall = passing.deepest_listed(arrays, listed.pairs, listed.walls, dt)
    fast = _fast(grains, listed.skin, dt)
    if len(fast):
        found = passing.deepest_of(fast, arrays, grains.body, THROUGH, dt)
        if found[0] > depth:
            depth, at, other = found
    if max(depth, in_wall) <= before.depth:
        return before
    if in_wall > depth:
        ways = np.array([[grains.vx[grain] - listed.walls.vx[wall], grains.vy[grain] - listed.walls.vy[wall]]])
        return Passage(
            depth=in_wall, grain=int(grains.number[grain]), wall=int(wall),
            stride=float(np.hypot(*ways[0]) * dt / grains.radius[grain]),
        )  # fmt: skip
    smaller = min(grains.radius[at], grains.radius[other])
    way = np.hypot(grains.vx[at] - grains.vx[other], grains.vy[at] - grains.vy[other]) * dt
    return Passage(
        depth=depth, grain=int(grains.number[at]), partner=int(grains.number[other]), stride=float(way / smaller)
    )


def _fast(grains: Grains, skin: float, dt: float) -> NDArray[np.int64]:
    """Grains one of which takes part in every pair that may pass in a step and stand beyond the skin at its end."""
    least = 0.5 * (skin + 0.5 * float(grains.radius.min()))
    if not dt * float(np.sqrt(np.max(grains.vx**2 + grains.vy**2))) > least:
        return np.zeros(0, np.int64)
    ux, uy = grains.vx - np.median(grains.vx), grains.vy - np.median(grains.vy)
    return np.nonzero(dt * np.hypot(ux, uy) > least)[0]
