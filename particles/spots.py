"""Single contacts and grains of a system, found for messages: slow and plain."""

from dataclasses import dataclass

import numpy as np

from particles.periodic import nearest_image
from particles.state import Floats
from particles.system import ParticleSystem


@dataclass(frozen=True, kw_only=True)
class Touch:
    """A contact of one grain.

    Attributes
    ----------
    grain : int
        Place of the grain in the arrays.
    partner : int or None
        Place of the other grain; None at a wall or a facet.
    wall : int or None
        Number of the wall; None at another grain or a facet.
    depth : float
        Overlap over the smaller radius.
    approach : float
        Speed [m/s] at which the two centres (the centre and the wall or facet) come closer; negative where they part.
    """

    grain: int
    partner: int | None
    wall: int | None
    depth: float
    approach: float


def deepest_touch(system: ParticleSystem, grain: int) -> Touch | None:
    """The deepest contact of the grain at a place with another grain, a wall or a facet; None if it has none."""
    g, listed = system.grains, system.list
    found = [_touch_of_pair(system, grain, int(j)) for j in _partners(system, grain)]
    for w in listed.walls.wall[listed.walls.grain == grain]:
        normal = np.array([listed.walls.nx[w], listed.walls.ny[w]])
        gap = normal @ [g.x[grain] - listed.walls.px[w], g.y[grain] - listed.walls.py[w]]
        approach = -float(normal @ [g.vx[grain] - listed.walls.vx[w], g.vy[grain] - listed.walls.vy[w]])
        depth = float((g.radius[grain] - gap) / g.radius[grain])
        found.append(Touch(grain=grain, partner=None, wall=int(w), depth=depth, approach=approach))
    if system.facets is not None:
        for place, _, delta, nx, ny, vx, vy in system.facets.touching(g):
            if place == grain:
                approach = float(nx * (g.vx[grain] - vx) + ny * (g.vy[grain] - vy))
                depth = float(delta / g.radius[grain])
                found.append(Touch(grain=grain, partner=None, wall=None, depth=depth, approach=approach))
    return max((touch for touch in found if touch.depth > 0.0), key=lambda touch: touch.depth, default=None)


def velocities_before(system: ParticleSystem) -> Floats:
    """Velocities (n_free, 2) [m/s] of the free grains half a step before the present, without global damping."""
    g, free = system.grains, slice(system.grains.n_free)
    after, force = np.column_stack([g.vx, g.vy])[free], np.column_stack([g.fx, g.fy])[free]
    return after - system.time_step * (force * g.inverse_mass[free, None] + system.gravity)


def alternating(system: ParticleSystem, least: float = 0.5) -> np.ndarray:
    """Places of the free grains whose velocity turns about within the step, ``v(n-1/2) . v(n+1/2) < 0``.

    The fastest mode of a network does so at every step when the step is above 71 % of its limit,
    and grows above it. A grain counts if the product is at least `least` of the larger square: one
    that is hit once turns about, too, but in one step only.
    """
    before = velocities_before(system)
    after = np.column_stack([system.grains.vx, system.grains.vy])[: system.grains.n_free]
    larger = np.maximum(np.sum(before**2, axis=1), np.sum(after**2, axis=1))
    return np.nonzero(np.sum(before * after, axis=1) < -least * larger)[0]


def touching_bodies(system: ParticleSystem) -> np.ndarray:
    """Places of the free grains that touch a prescribed grain or a facet."""
    n_free, pairs = system.grains.n_free, system.list.pairs
    near = np.nonzero((pairs.owner < n_free) & (pairs.partner >= n_free))[0]  # free grains come first
    found = [
        i for i, j in zip(pairs.owner[near], pairs.partner[near], strict=True) if _touch_of_pair(system, i, j).depth > 0
    ]
    if system.facets is not None:
        found += system.facets.touching(system.grains)[:, 0].tolist()
    return np.unique(np.array(found, np.int64))


def _partners(system: ParticleSystem, grain: int) -> np.ndarray:
    pairs = system.list.pairs
    row = pairs.partner[pairs.start[grain] : pairs.start[grain + 1]]
    return np.append(row, pairs.owner[pairs.partner == grain])


def _touch_of_pair(system: ParticleSystem, i: int, j: int) -> Touch:
    g = system.grains
    apart = np.array(
        [nearest_image(g.x[j] - g.x[i], system.period[0]), nearest_image(g.y[j] - g.y[i], system.period[1])]
    )
    distance = float(np.hypot(*apart))
    closing = -float(apart @ [g.vx[j] - g.vx[i], g.vy[j] - g.vy[i]]) / distance if distance > 0.0 else 0.0
    depth = float((g.radius[i] + g.radius[j] - distance) / min(g.radius[i], g.radius[j]))
    return Touch(grain=i, partner=j, wall=None, depth=depth, approach=closing)
