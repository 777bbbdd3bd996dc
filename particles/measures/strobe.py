"""One look per period of the shaking: heights at a phase, rises from one to the next, the portrait over the phase."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from particles.errors import ParticleError, require
from particles.state import Floats


class Strobe(NamedTuple):
    """Values (k,) at one phase of successive periods, their times (k,) [s], and the changes (k - 1,) between them."""

    time: Floats
    value: Floats
    rise: Floats


def strobe(time: Floats, value: Floats, *, period: float, start: float = 0.0, phase: float = 0.0) -> Strobe:
    """A quantity at the times ``start + (j + phase) period`` within the record, interpolated linearly between rows.

    Parameters
    ----------
    time, value : (n,)
        Rising times [s] and the quantity then, e.g. a height [m].
    period, start : float
        Of the shaking [s].
    phase : float
        Within the period, 0 to 1.

    Notes
    -----
    Where the interval of the rows divides the period, interpolation makes the same error in every period and the
    rises have none.

    Raises
    ------
    ParticleError
        If the record holds fewer than two such times.
    """
    require("period", period, above=0.0)
    require("start", start)
    first = math.ceil((time[0] - start) / period - phase - 1e-9) if len(time) else 0
    last = math.floor((time[-1] - start) / period - phase + 1e-9) if len(time) else -1
    first = max(first, 0)
    if last - first < 1:
        length = time[-1] - time[0] if len(time) else 0.0
        raise ParticleError(
            f"a record of {length:g} s with shaking from {start:g} s on holds no whole "
            f"period of {period:g} s: run longer"
        )
    at = start + (np.arange(first, last + 1) + phase) * period
    found = np.interp(at, time, value)
    return Strobe(at, found, np.diff(found))


def quietest_phase(looks: Sequence[Sequence[Floats]]) -> int:
    """The phase at which single rises spread least.

    What a bed does within its period, or in two, is no rise, but is part of every look; it fades as 1/n in windows of n
    periods, the sooner the less of it there is. The limit of long windows is the same at every phase.

    Parameters
    ----------
    looks : sequence of sequence of (n,)
        For each phase, the rises of each sample [m].

    Returns
    -------
    int
        Index of the phase; the first of equal ones.
    """
    return int(np.argmin([np.concatenate(list(rises)).var() for rises in looks]))


class Portrait(NamedTuple):
    """Points over the phase: phase (n,) 0 to 1, the quantity (n,), its mean and standard deviation about j/k (k,)."""

    phase: Floats
    value: Floats
    mean: Floats
    deviation: Floats


def portrait(time: Floats, value: ArrayLike, *, period: float, start: float = 0.0, bins: int = 32) -> Portrait:
    """A quantity over the phase of the shaking, from `start` [s] on.

    Bins are equally wide, their middles at the phases 0, 1/bins, 2/bins ...: rows of which a whole number makes a
    period lie in the middles, and round-off moves none to the next bin.
    """
    require("period", period, above=0.0)
    require("bins", bins, at_least=1)
    on = time >= start
    phase, kept = ((time[on] - start) / period) % 1.0, np.asarray(value, float)[on]
    bin_of = np.floor(phase * bins + 0.5).astype(np.int64) % bins
    count = np.bincount(bin_of, minlength=bins)
    held = count > 0
    mean, deviation = np.full(bins, np.nan), np.full(bins, np.nan)
    mean[held] = np.bincount(bin_of, kept, minlength=bins)[held] / count[held]
    deviation[held] = np.sqrt(np.bincount(bin_of, (kept - mean[bin_of]) ** 2, minlength=bins)[held] / count[held])
    return Portrait(phase, kept, mean, deviation)
