"""Confidence intervals hold the true mean as often as they say."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coupled.campaign.statistics import confidence
from coupled.errors import LeitoError

DRAWS = 4000


@pytest.mark.parametrize("count", [2, 3, 10])
@pytest.mark.parametrize("level", [0.5, 0.95])
def test_the_interval_holds_the_true_mean_in_that_share_of_cases(count: int, level: float) -> None:
    """A wrong quantile fails: with the normal one, two samples would be covered in 70 % instead of 95 %."""
    random = np.random.default_rng(count)
    intervals = [confidence(random.normal(3.0, 2.0, count), level) for _ in range(DRAWS)]
    held = np.mean([interval.low <= 3.0 <= interval.high for interval in intervals])
    # four standard deviations of a share in DRAWS trials: passes by chance in all but 1 of 15 000 cases
    assert abs(held - level) < 4.0 * math.sqrt(level * (1.0 - level) / DRAWS)


def test_it_narrows_with_the_root_of_the_number_of_samples() -> None:
    random = np.random.default_rng(0)
    counts = [100, 400, 1600, 6400]
    widths = [np.mean([confidence(random.normal(size=n)).half_width for _ in range(50)]) for n in counts]
    rate = np.polyfit(np.log(counts), np.log(widths), 1)[0]
    assert abs(rate + 0.5) < 0.02  # widths of 50 samples each of 100 or more scatter by 1 %


def test_one_value_says_nothing_of_the_spread() -> None:
    interval = confidence([2.0])
    assert (interval.mean, interval.half_width, interval.count) == (2.0, math.inf, 1)


def test_what_has_no_mean_is_refused() -> None:
    with pytest.raises(LeitoError, match="at least one value"):
        confidence([])
    with pytest.raises(LeitoError, match="finite ones, not .*nan"):
        confidence([1.0, math.nan])
    with pytest.raises(LeitoError, match="level = 95 must lie between 0 and 1"):
        confidence([1.0, 2.0], 95.0)
