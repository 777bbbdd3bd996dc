"""Symmetry of Gallavotti and Cohen: ``ln P_n(v)/P_n(-v) = n s v``, where rates of both signs occur."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from particles.measures.resampling import Resampling, limit_weights
from particles.state import Floats

FEWEST_WINDOWS = 10.0  # side by side, on either side of zero


class SymmetryPoints(NamedTuple):
    """Bins of |v| (k,) [m]: ``(1/n) ln P_n(v)/P_n(-v)`` [-] and the half width of its interval."""

    v: Floats
    ratio: Floats
    half_width: Floats


@dataclass(frozen=True, kw_only=True)
class Symmetry:
    """What windows of `periods` say of the symmetry.

    Attributes
    ----------
    slope, half_width : float or None
        s [1/m]; None where one tail is too short to be seen.
    lacks : str
        Then the reason, in a sentence; else empty.
    points : SymmetryPoints or None
        By which one sees whether the ratio is a line at all.
    resampled : (resamples,) or None
        Deviations of the slope.
    """

    periods: int
    slope: float | None
    half_width: float | None
    lacks: str
    points: SymmetryPoints | None
    resampled: Floats | None = None


def symmetry(sampling: Resampling, periods: int, *, bins: int = 8) -> Symmetry:
    """Slope of the symmetry from windows of n periods.

    Given |v|, the sign is positive with probability ``1/(1 + exp(-n s |v|))``: the slope is the one of largest
    likelihood, over all windows and without bins. If the ratio is not a line in v it is a mean slope: `points` show it.
    """
    sums = np.concatenate(sampling.sums(periods))
    sides = {"falling": (sums < 0.0).sum() / periods, "rising": (sums > 0.0).sum() / periods}
    for name, held in sides.items():
        if held < FEWEST_WINDOWS:
            lacks = (
                f"no symmetry can be seen: {held:.3g} {name} windows of {periods} periods side by side, of "
                f"{len(sums) / periods:.4g}; it takes {FEWEST_WINDOWS:g}"
            )
            return Symmetry(periods=periods, slope=None, half_width=None, lacks=lacks, points=None)
    size, up = np.abs(sums), (sums > 0.0).astype(float)
    scale = 1.0 / float(size.mean())

    def score(slope: float) -> float:
        return float(np.mean(size * (up - _chance(slope * size))))

    reach = scale
    while score(reach) > 0.0 or score(-reach) < 0.0:
        reach *= 2.0
    slope = float(brentq(score, -reach, reach, xtol=1e-12 * scale, rtol=1e-12))

    def scores(some: Floats) -> Floats:
        return (np.abs(some) * ((some > 0.0) - _chance(slope * np.abs(some))))[:, None]

    chance = _chance(slope * size)
    information = float(np.mean(size**2 * chance * (1.0 - chance)))
    _, resampled = sampling.means(periods, scores)
    deviation = resampled / information
    return Symmetry(
        periods=periods, slope=slope, half_width=float(sampling.half_width(deviation)[0]), lacks="",
        points=_points(sampling, periods, size, bins), resampled=deviation[:, 0],
    )  # fmt: skip


def limit_of_slope(sampling: Resampling, found: Sequence[Symmetry]) -> tuple[float, float] | None:
    """Slope s [1/m] and half width in endless windows, from those of three lengths or more; None with fewer.

    Increments that remember weight the ends of a window otherwise than its middle, which turns the slope by a part that
    falls as 1/n: the line over 1/n takes it out.
    """
    known = [one for one in found if one.slope is not None]
    if len(known) < 3:
        return None
    take = limit_weights([one.periods for one in known], np.array([one.half_width for one in known]))
    deviation = take @ np.array([one.resampled for one in known])
    slope = float(take @ np.array([one.slope for one in known]))
    return slope, float(sampling.half_width(deviation[:, None])[0])


def _chance(argument: Floats) -> Floats:
    """Logistic function; the tanh does not overflow."""
    return np.asarray(0.5 * (1.0 + np.tanh(0.5 * argument)))


def _points(sampling: Resampling, periods: int, size: Floats, bins: int) -> SymmetryPoints:
    """Ratios in bins of |v| of equal numbers of windows."""
    lines = np.unique(np.quantile(size[size > 0.0], np.linspace(0.0, 1.0, bins + 1)))
    lines[-1] *= 1.0 + 1e-12

    def hits(sums: Floats) -> Floats:
        place = np.searchsorted(lines, np.abs(sums), side="right") - 1
        own = place[:, None] == np.arange(len(lines) - 1)
        return np.concatenate(
            [own & (sums > 0.0)[:, None], own & (sums < 0.0)[:, None], own * np.abs(sums)[:, None]], axis=1
        ).astype(float)

    mean, resampled = sampling.means(periods, hits)
    (above, below, moment), (up, down, _) = np.split(mean, 3), np.split(resampled, 3, axis=1)
    held = (above > 0.0) & (below > 0.0)
    above, below, up, down = above[held], below[held], up[:, held], down[:, held]
    deviation = (up / above - down / below) / periods
    return SymmetryPoints(
        moment[held] / (above + below) / periods, np.log(above / below) / periods, sampling.half_width(deviation)
    )
