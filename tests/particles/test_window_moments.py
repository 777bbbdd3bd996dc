"""Moments of windows against closed forms, and error bars where samples differ among themselves."""

import math

import numpy as np
import pytest
from sequences import LEAVE_DOWN, LEAVE_UP, MEAN, SEQUENCES, SPREAD, UP

from particles import ParticleError
from particles.measures import Resampling, checked_sequences, quietest_phase, window_moments

CASES = 100
LEAST = 0.88  # of level 0.95; the spread of a share of 100 is 0.02, finite blocks understate the bars by some percent
REMEMBERS = 1.0 - LEAVE_UP - LEAVE_DOWN  # second eigenvalue of the chain


def expected(name: str, n: int) -> tuple[float, float, float, float]:
    """Mean, variance over n, skewness, excess of sums of n increments; not a number where no closed form is used."""
    if name == "gaussian":
        return MEAN, SPREAD**2, 0.0, 0.0
    if name == "walk":  # binomial
        spread = n * UP * (1.0 - UP)
        return 2.0 * UP - 1.0, 4.0 * UP * (1.0 - UP), (1.0 - 2.0 * UP) / math.sqrt(spread), 1.0 / spread - 6.0 / n
    up = LEAVE_DOWN / (LEAVE_UP + LEAVE_DOWN)
    memory = sum((1.0 - lag / n) * REMEMBERS**lag for lag in range(1, n))
    return 2.0 * up - 1.0, 4.0 * up * (1.0 - up) * (1.0 + 2.0 * memory), math.nan, math.nan


@pytest.mark.parametrize(("name", "periods"), [("gaussian", 4), ("walk", 6), ("chain", 8)])
def test_moments_lie_within_their_bars(name, periods):
    rng, truth = np.random.default_rng(1), np.array(expected(name, periods))
    within = []
    for case in range(CASES):
        sampling = Resampling(sequences=(SEQUENCES[name].make(rng, 4000),), longest=periods, seed=case, resamples=200)
        found = window_moments(sampling, periods)
        values, bars = np.array(found[1:]).T
        within.append(np.abs(values - truth) <= bars)
    shares = np.mean(within, axis=0)[np.isfinite(truth)]
    assert shares.min() > LEAST, shares


@pytest.mark.parametrize("lengths", [(160,), (120, 200)], ids=["equal", "unequal"])
def test_whole_samples_know_that_samples_differ(lengths):
    """Each sample has a mean of its own, of spread 1/2: var(S)/n = 1 + n/4, and blocks within samples cannot see it."""
    rng, own, n = np.random.default_rng(2), 0.5 * math.sqrt(12.0), 4  # rates evenly spread
    truth = np.array([0.0, 1.0 + n * own**2 / 12.0])
    within = {True: [], False: []}
    for case in range(CASES):
        sequences = checked_sequences(
            [own * (rng.random() - 0.5) + rng.standard_normal(lengths[k % len(lengths)]) for k in range(40)]
        )
        for whole, hits in within.items():
            found = window_moments(Resampling(sequences=sequences, longest=n, whole=whole, seed=case, resamples=200), n)
            values, bars = np.array([found.mean, found.variance]).T
            hits.append(np.abs(values - truth) <= bars)
    assert np.mean(within[True], axis=0).min() > LEAST
    assert np.mean(within[False], axis=0)[0] < 0.75  # 8 blocks per sample: sqrt(0.3/320) over sqrt(0.26/40), 0.55


def test_whole_samples_that_are_equal_leave_nothing_open():
    sequence = np.random.default_rng(3).standard_normal(50)
    found = window_moments(Resampling(sequences=(sequence,) * 12, longest=4, whole=True), 4)
    assert max(np.array(found[1:])[:, 1]) < 1e-12
    sums = np.convolve(sequence, np.ones(4), "valid")
    assert found.variance.value == pytest.approx(sums.var() / 4.0, rel=1e-12)
    assert found.gaussian_rate(np.array([sums.mean() / 4.0]))[0] == pytest.approx(0.0, abs=1e-25)


def test_the_quietest_phase_is_that_without_the_swing():
    rng = np.random.default_rng(4)
    rises = rng.standard_normal((3, 200))
    swings = [a * (-1.0) ** np.arange(200) for a in (0.8, 0.1, 0.5)]
    assert quietest_phase([rises + swing for swing in swings]) == 1


def test_refusals():
    sequences = tuple(np.random.default_rng(5).standard_normal((9, 40)))
    with pytest.raises(ParticleError, match="9 of 9 sequences hold two windows of 4 periods.*need 10"):
        Resampling(sequences=sequences, longest=4, whole=True)
    with pytest.raises(ParticleError, match="0 of 20 sequences"):
        Resampling(sequences=tuple(np.zeros((20, 7))), longest=4, whole=True)
    with pytest.raises(ParticleError, match="the same sum"):
        window_moments(Resampling(sequences=tuple(np.ones((12, 40))), longest=4, whole=True), 4)
