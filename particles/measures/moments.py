"""Mean, variance and shape of the sums of windows: what a Gaussian large-deviation function would be made of."""

from typing import NamedTuple

import numpy as np

from particles.errors import ParticleError
from particles.measures.resampling import Resampling
from particles.state import Floats


class Estimate(NamedTuple):
    """A value and the half width of its interval."""

    value: float
    half_width: float


class WindowMoments(NamedTuple):
    """Of the sums S of n = `periods` increments.

    `mean` is that of S/n [m]; `variance` is ``var(S)/n`` [m2], which for increments that forget tends to
    ``var(x) (1 + 2 sum of their correlations)``; `skewness` and `excess` (kurtosis less 3) of S [-] are zero for
    Gaussian sums and fall as ``1/sqrt(n)`` and 1/n for independent increments.
    """

    periods: int
    mean: Estimate
    variance: Estimate
    skewness: Estimate
    excess: Estimate

    def gaussian_rate(self, v: Floats) -> Floats:
        """The rate ``(v - mean)^2/(2 variance)`` [-] at v (k,) [m]: that of Gaussian windows with these two moments."""
        return np.asarray((v - self.mean.value) ** 2 / (2.0 * self.variance.value))


def window_moments(sampling: Resampling, periods: int) -> WindowMoments:
    """Moments of windows of one length; error bars linearised from the resampled moments.

    Raises
    ------
    ParticleError
        If all windows have the same sum.
    """
    windows = np.concatenate(sampling.sums(periods))
    centre = float(windows.mean())
    if windows.std() <= 1e-12 * max(abs(centre), 1e-300):
        raise ParticleError(f"all windows of {periods} periods have the same sum: there is no distribution to be seen")

    def powers(sums: Floats) -> Floats:
        return np.asarray((sums - centre)[:, None] ** np.arange(1, 5))

    moment, resampled = sampling.means(periods, powers)
    (_, second, third, fourth), change = moment, (resampled - moment).T
    skewness, ratio = third / second**1.5, fourth / second**2
    shift = change[0] / np.sqrt(second)  # a resampled mean turns the higher moments about it, too
    spread = change[1] / second
    values = np.array([centre / periods, second / periods, skewness, ratio - 3.0])
    deviations = [
        change[0] / periods,
        change[1] / periods,
        change[2] / second**1.5 - 3.0 * shift - 1.5 * skewness * spread,
        change[3] / second**2 - 4.0 * skewness * shift - 2.0 * ratio * spread,
    ]
    bars = sampling.half_width(np.column_stack(deviations))
    return WindowMoments(periods, *(Estimate(float(v), float(bar)) for v, bar in zip(values, bars, strict=True)))
