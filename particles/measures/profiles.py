"""Averages over the grains whose centres lie in horizontal strips."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from particles.errors import ParticleError
from particles.state import Floats

RATTLER = 2  # contacts up to which a disc carries nothing: at least three hold one that bears a load


class Profile(NamedTuple):
    """A mean per strip (k,), not a number where no grain is, and the number of grains it is over."""

    mean: Floats
    count: np.ndarray


def mean_in_strips(values: ArrayLike, y: Floats, edges: ArrayLike) -> Profile:
    """Mean of a quantity of grains (n,) per strip between heights (k + 1,) [m].

    Raises
    ------
    ParticleError
        If the edges do not rise.
    """
    lines, quantity = np.asarray(edges, float), np.asarray(values, float)
    if lines.ndim != 1 or len(lines) < 2 or not np.all(np.diff(lines) > 0.0):
        raise ParticleError("the edges of strips must be two rising heights or more")
    strip = np.searchsorted(lines, y, side="right") - 1
    inside = (strip >= 0) & (strip < len(lines) - 1)
    count = np.bincount(strip[inside], minlength=len(lines) - 1)
    total = np.bincount(strip[inside], quantity[inside], minlength=len(lines) - 1)
    return Profile(np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0), count)


def coordination_in_strips(
    contacts: np.ndarray, y: Floats, edges: ArrayLike, *, without_rattlers: bool = False
) -> Profile:
    """Mean number of contacts per grain and strip [-].

    `contacts` (n,) of each grain, `y` (n,) its height [m]. A rattler has `RATTLER` contacts or fewer; without them the
    mean is over the others alone, whose contacts with rattlers still count.
    """
    kept = contacts > RATTLER if without_rattlers else np.ones(len(contacts), bool)
    return mean_in_strips(contacts[kept], y[kept], edges)
