"""Large-deviation function of a rate, such as the rise of an intruder per period, from records of its increments.

``P_n(v) ~ exp(-n I(v))`` for the mean v of n successive increments, as n grows (model 4). Two roads:

- the histogram, ``I_n(v) = -(1/n) ln(P_n(v)/P_n(<v>))``: the ratio to the bin of the mean takes the factor ``sqrt(n)``
  of a density out, so that what is left of the finite n falls as 1/n and can be extrapolated;
- the scaled cumulant generating function ``lambda(k) = lim (1/n) ln <exp(k n v)>``, and its Legendre transform
  ``I(v) = max_k (k v - lambda(k))`` (convex functions only).

Error bars are of sampling alone, from blocks resampled (`Resampling`); they do not know of the finite n, which
`Extrapolated.gap` and a comparison of both roads show. Source: H. Touchette, Physics Reports 478 (2009) 1, sections
3 to 5, for the definitions; error bars by the moving-block bootstrap (Kunsch 1989), linearised.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from particles.errors import ParticleError
from particles.measures.resampling import Resampling, limit_weights
from particles.state import Floats

LARGEST_ERROR = 0.2  # relative, of a probability or mean whose logarithm is taken
BINS_PER_DEVIATION = 3.0
FEWEST_WINDOWS = 40.0  # that carry a mean of exponentials, by their weights


class RateFunction(NamedTuple):
    """Of windows of `periods`, at v (k,) [m]: the rate I_n(v) [-], the half width of its interval, and counts.

    Where too few windows lie, rate and half width are not a number. `count` is the windows in each bin, `resampled`
    (resamples, k) the deviations of the rate.
    """

    periods: int
    v: Floats
    rate: Floats
    half_width: Floats
    count: np.ndarray
    resampled: Floats


def usual_edges(sampling: Resampling, periods: int | None = None) -> Floats:
    """Edges of bins over all windows of one length [m], one of them centred on the mean; absent: of the longest.

    Three bins per standard deviation: averaging over a bin changes I by 1 % three deviations from the mean.
    """
    n = sampling.longest if periods is None else periods
    v = np.concatenate(sampling.sums(n)) / n
    width, mean = float(v.std()) / BINS_PER_DEVIATION, float(v.mean())
    if width <= 1e-12 * max(abs(mean), 1e-300):
        raise ParticleError("all windows have the same mean: there is no large-deviation function to be seen")
    low, high = np.floor((v.min() - mean) / width), np.ceil((v.max() - mean) / width)
    return np.asarray(mean + width * (np.arange(low, high + 2) - 0.5))


def rate_function(sampling: Resampling, periods: int, edges: ArrayLike) -> RateFunction:
    """The histogram's road for windows of one length.

    Parameters
    ----------
    sampling : Resampling
        The sequences and how they are resampled.
    periods : int
        n, periods per window, not more than the longest of `sampling`.
    edges : (k + 1,)
        Of the bins of v [m]; on a lattice, one value per bin.

    Raises
    ------
    ParticleError
        If the mean lies outside the bins, or no bin but that of the mean is known well enough.
    """
    lines = np.asarray(edges, float)

    def hits(sums: Floats) -> Floats:
        place = np.searchsorted(lines, sums / periods, side="right") - 1
        return np.asarray(place[:, None] == np.arange(len(lines) - 1), float)

    share, resampled = sampling.means(periods, hits)
    windows = sampling.sums(periods)
    mean = sum(float(sums.sum()) for sums in windows) / sum(len(sums) for sums in windows) / periods
    places = 0.5 * (lines[:-1] + lines[1:])
    middle = int(np.argmin(np.abs(places - mean)))
    if not lines[0] <= mean <= lines[-1] or share[middle] == 0.0:
        raise ParticleError(f"the bins do not hold the mean {mean:g} of the increments: widen them")
    with np.errstate(divide="ignore", invalid="ignore"):
        change = (resampled - share) / share
        known = (share > 0.0) & (sampling.half_width(change) < 2.0 * LARGEST_ERROR)
        rate = -np.log(share / share[middle]) / periods
    deviation = -(change - change[:, [middle]]) / periods
    rate, deviation = np.where(known, rate, np.nan), np.where(known, deviation, np.nan)
    count = np.round(share * sum(len(sums) for sums in windows)).astype(np.int64)
    return RateFunction(periods, places, rate, sampling.half_width(deviation), count, deviation)


class Extrapolated(NamedTuple):
    """To endless windows, at v (k,) [m]: rate [-] and half width, not a number with fewer than three lengths.

    `gap` (k,) is the distance of the last two lengths, over the half width of that distance: curves that overlap
    keep it below 1. Not for the ends of the support, where there is no factor ``sqrt(n)`` to take out.
    """

    v: Floats
    rate: Floats
    half_width: Floats
    gap: Floats


def extrapolated(sampling: Resampling, curves: Sequence[RateFunction]) -> Extrapolated:
    """Line through I_n(v) over 1/n, per bin, weighted by the half widths; error bars from the common resamples.

    `curves` are of the same sampling and bins.
    """
    order = sorted(curves, key=lambda curve: curve.periods)
    rates, widths = np.array([c.rate for c in order]), np.array([c.half_width for c in order])
    bins = rates.shape[1]
    rate, half, gap = (np.full(bins, np.nan) for _ in range(3))
    for b in range(bins):
        known = np.nonzero(np.isfinite(rates[:, b]))[0]
        if len(known) < 3:
            continue
        if not widths[known, b].any():  # the bin of the mean, zero by definition
            rate[b], half[b], gap[b] = 0.0, 0.0, 0.0
            continue
        take = limit_weights([order[n].periods for n in known], widths[known, b])
        rate[b] = take @ rates[known, b]
        deviations = np.array([order[k].resampled[:, b] for k in known])
        half[b] = sampling.half_width((take @ deviations)[:, None])[0]
        apart = sampling.half_width((deviations[-1] - deviations[-2])[:, None])[0]
        # no width: the bin of the mean of both lengths, though not of a third
        gap[b] = abs(rates[known[-1], b] - rates[known[-2], b]) / apart if apart > 0.0 else 0.0
    return Extrapolated(order[0].v, rate, half, gap)


@dataclass(frozen=True, kw_only=True)
class Cumulants:
    """The scaled cumulant generating function and what comes of it, at k (m,) [1/m].

    Attributes
    ----------
    value, half_width : (m,)
        lambda(k) [-]; not a number where fewer than 40 windows carry the mean.
    v, rate : (m,)
        Of the Legendre transform: ``v = d lambda/dk`` [m], ``I = k v - lambda`` [-], with the same half width: at its
        maximum k does not count. About the mean it falls to zero; the error is of second order there. Not a number
        beyond where v rises with k, as it must.
    """

    k: Floats
    value: Floats
    half_width: Floats
    v: Floats
    rate: Floats


def cumulants(sampling: Resampling, periods: int, k: ArrayLike) -> Cumulants:
    """lambda(k) from windows of n and of n/2 periods, and the large-deviation function by Legendre's transform.

    ``lambda = (ln G_n - ln G_m)/(n - m)``, ``G_n = <exp(k n v)>``, m = n/2 rounded down (``ln G_1`` alone for n = 1):
    for a chain with a gap in its spectrum the rest falls exponentially with m, not as 1/n.
    A mean of exponentials is dominated by few windows at large k: where ``(sum w)^2/sum w^2`` over windows side by side
    falls below 40, nothing is given.
    """
    tilt = np.atleast_1d(np.asarray(k, float))
    long, short = periods, periods // 2
    value, slope, change = np.zeros(len(tilt)), np.zeros(len(tilt)), np.zeros((sampling.resamples, len(tilt)))
    known = np.ones(len(tilt), bool)
    for window, sign in ((long, 1.0), (short, -1.0)):
        if window == 0:
            continue
        log_mean, v_mean, deviation, carriers = _tilted(sampling, window, tilt)
        value += sign * log_mean
        slope += sign * v_mean
        change += sign * deviation
        known &= carriers >= FEWEST_WINDOWS
    value, slope, change = (part / (long - short) for part in (value, slope, change))
    known &= sampling.half_width(change) * (long - short) < 2.0 * LARGEST_ERROR
    value, half = (np.where(known, part, np.nan) for part in (value, sampling.half_width(change)))
    slope = np.where(known & _convex(tilt, slope, known), slope, np.nan)
    return Cumulants(k=tilt, value=value, half_width=half, v=slope, rate=tilt * slope - value)


def _convex(tilt: Floats, slope: Floats, known: np.ndarray) -> np.ndarray:
    """Where the slope rises with k, from the smallest |k| outwards: beyond, there is no transform."""
    order = np.argsort(tilt)[known[np.argsort(tilt)]]
    rises = np.zeros(len(tilt), bool)
    if not len(order):
        return rises
    middle, steps = int(np.argmin(np.abs(tilt[order]))), np.diff(slope[order]) > 0.0
    up, down = steps[middle:], steps[:middle][::-1]
    above = len(up) if up.all() else int(np.argmin(up))
    below = len(down) if down.all() else int(np.argmin(down))
    if above + below or len(order) == 1:
        rises[order[middle - below : middle + above + 1]] = True
    return rises


def _tilted(sampling: Resampling, periods: int, tilt: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """ln G, its derivative in k, its resampled deviations, and the windows side by side that carry it."""
    most = np.max([np.maximum(tilt * sums.max(), tilt * sums.min()) for sums in sampling.sums(periods)], axis=0)

    def weights(sums: Floats) -> Floats:
        return np.exp(sums[:, None] * tilt - most)

    mean, resampled = sampling.means(periods, weights)
    number = first = second = 0.0
    for sums in sampling.sums(periods):
        weight = weights(sums)
        first, second, number = first + sums @ weight, second + (weight**2).sum(axis=0), number + len(sums)
    carriers = (mean * number) ** 2 / second / periods
    return np.log(mean) + most, first / (mean * number), (resampled - mean) / mean, carriers
