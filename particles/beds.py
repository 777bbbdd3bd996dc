"""Making a bed: grains on a lattice, ready to fall (model 1.6)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from particles.errors import ParticleError, require
from particles.state import Grains


def lattice(
    sizes: Sequence[tuple[float, int]],
    density: float,
    *,
    width: float,
    spacing: float = 1.05,
    jitter: float = 0.0,
    seed: int = 1,
    holes: Sequence[tuple[float, float, float]] = (),
) -> Grains:
    """Discs of mixed sizes on a square lattice between x = 0 and `width`, rows from the floor up.

    Parameters
    ----------
    sizes : sequence of (radius [m], count)
        Shuffled over the lattice by `seed`.
    density : float
        [kg/m3].
    width : float
        Of the box [m].
    spacing : float
        Lattice constant over the largest diameter, >= 1.
    jitter : float
        Random shift of each grain, as a fraction (0 to 1) of its free gap in its cell; a perfect
        lattice of equal columns would come to rest as columns.
    seed : int
        Of the order and the shifts.
    holes : sequence of (x, y, radius) [m]
        Discs that are left free.

    Raises
    ------
    ParticleError
        If a number is out of range or a single grain does not fit in the width.
    """
    require("lattice spacing", spacing, at_least=1.0)
    if not 0.0 <= jitter <= 1.0:
        raise ParticleError(f"jitter = {jitter:g} must lie between 0 and 1")
    rng = np.random.default_rng(seed)
    radius = np.concatenate([np.full(count, size) for size, count in sizes])
    rng.shuffle(radius)
    pitch = 2.0 * float(radius.max()) * spacing
    columns = int(width / pitch + 1e-9)
    if columns < 1:
        raise ParticleError(f"a grain of radius {radius.max():g} m does not fit in a box {width:g} m wide")
    step = width / columns
    place = _places(len(radius), columns, step, pitch, holes)
    position = np.column_stack([(place % columns + 0.5) * step, (place // columns + 0.5) * pitch])
    gap = 0.5 * np.array([step, pitch]) - radius[:, None]
    position += jitter * gap * rng.uniform(-1.0, 1.0, position.shape)
    return Grains.discs(position, radius, density)


def _places(
    n: int, columns: int, step: float, pitch: float, holes: Sequence[tuple[float, float, float]]
) -> NDArray[np.int64]:
    """Numbers of the first `n` places, row by row, whose cells of `step` x `pitch` [m] lie outside the holes."""
    taken = sum((int(2.0 * radius / step) + 2) * (int(2.0 * radius / pitch) + 2) for _, _, radius in holes)
    place = np.arange(n + taken)
    clear = np.ones(len(place), bool)
    for x, y, radius in holes:
        aside = np.maximum(np.abs((place % columns + 0.5) * step - x) - 0.5 * step, 0.0)
        above = np.maximum(np.abs((place // columns + 0.5) * pitch - y) - 0.5 * pitch, 0.0)
        clear &= np.hypot(aside, above) >= radius
    return place[clear][:n]


def rest_ratio(grains: Grains, gravity: Sequence[float], kinetic: float) -> float:
    """Mean kinetic energy per grain over the mean of ``m |g| d``: much less than 1 at rest."""
    free = slice(grains.n_free)
    weight = float(np.hypot(*gravity)) * float(grains.mass[free].mean()) * 2.0 * float(grains.radius[free].mean())
    return kinetic / grains.n_free / weight if weight > 0.0 else float("inf")


def drop_height_on(grains: Grains, position: NDArray[np.float64], radius: NDArray[np.float64]) -> float:
    """How far discs (k, 2), (k,) can be lowered before the first touches a free grain from above [m].

    Infinite if none is below.
    """
    free = slice(grains.n_free)
    lowest = np.inf
    for (x, y), r in zip(position, radius, strict=True):
        reach = grains.radius[free] + r
        aside = np.abs(grains.x[free] - x)
        under = (aside < reach) & (grains.y[free] < y)
        if under.any():
            clear = y - grains.y[free][under] - np.sqrt(reach[under] ** 2 - aside[under] ** 2)
            lowest = min(lowest, float(clear.min()))
    return lowest


def drop_height_of_facets(grains: Grains, points: NDArray[np.float64], facets: NDArray[np.int64]) -> float:
    """How far facets (m, 2) between nodes (n, 2) can be lowered before one touches a free grain from above [m].

    The body lies to the left of each facet. Infinite if none is below.
    """
    nodes = points[np.unique(facets)]
    lowest = drop_height_on(grains, nodes, np.zeros(len(nodes)))
    free = slice(grains.n_free)
    x, y, radius = grains.x[free], grains.y[free], grains.radius[free]
    for start, end in points[facets]:
        length = float(np.hypot(*(end - start)))
        tx, ty = (end - start) / length
        if tx <= 0.0:
            continue  # it faces upwards
        # its outward normal is (ty, -tx): the clearance r falls by tx for each metre it is lowered
        fall = ((x - start[0]) * ty - (y - start[1]) * tx - radius) / tx
        foot = (x - start[0]) * tx + (y - start[1] + fall) * ty
        below = (foot >= 0.0) & (foot <= length) & (fall > 0.0)
        lowest = min(lowest, float(fall[below].min(initial=np.inf)))
    return float(lowest)
