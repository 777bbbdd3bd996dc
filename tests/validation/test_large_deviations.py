"""`make validate`: large-deviation functions of sequences in closed form, and how often the error bars hold them.

Writes `docs/validation/large_deviations.md` with a figure.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "particles"))

from sequences import SEQUENCES

from particles.measures import (
    Resampling,
    checked_sequences,
    cumulants,
    extrapolated,
    limit_of_slope,
    rate_function,
    symmetry,
    usual_edges,
)

DOCS = Path(__file__).parents[2] / "docs" / "validation"
CASES = 400
LEVEL = 0.95
LEAST = 0.90  # the spread of a share over 400 cases is 0.011; finite blocks understate the bars by some percent
LEAST_OF_LIMIT = 0.87  # of the chain's slope, whose line over 1/n leaves a tenth of a bar
HELD = {"walk": 20_000, "gaussian": 20_000, "chain": 40_000}
LENGTHS = {"walk": (8, 16, 24), "gaussian": (4, 8, 16), "chain": (16, 32, 64)}
TILTS = {
    "walk": np.array([-0.4, -0.2, 0.2, 0.4]),
    "gaussian": np.array([-0.5, -0.25, 0.25, 0.5]),
    "chain": np.array([-0.12, -0.06, 0.06, 0.12]),
}
SLOPES = {"walk": (2, 4, 8), "gaussian": (4, 8, 16), "chain": (12, 20, 32)}
SETTLED = {"walk": 8, "gaussian": 4, "chain": 16}  # windows whose transform is taken
LATTICE = {"walk": np.array([0.25, 0.5, 0.75]), "chain": np.array([0.25, 0.5, 0.75])}  # rates that all windows can have
NAMES = {
    "walk": "walk, 3/4 up",
    "gaussian": "Gaussian, mean 0.3, spread 1",
    "chain": "chain, leaves 1 by 0.1, -1 by 0.3",
}
PAGE = """# Large-deviation functions of sequences in closed form

Written by `make validate`.

{cases} independent records of each sequence; error bars of level {level:g}. A share is that of the cases in which the
closed form lies within the bars, the least and the largest over the points; a miss is the mean error. The walk and the
Gaussian increments are independent; the chain takes steps 1 and -1 and remembers (second eigenvalue 0.6).
Records hold {held} increments.

![large_deviations.png](large_deviations.png)

| sequence | road | windows | points | share | miss, mean bar |
|---|---|---|---|---|---|
{rows}

The transform needs windows that have forgotten their beginning; shorter ones miss the chain's function by more than
the bars say, which a comparison with windows twice as long shows. The histogram at one length is wrong by a part that
falls as 1/n; the line over 1/n takes it out. At the ends of the support of a lattice (all steps up) that line is wrong:
there the part does not fall as 1/n.

## Symmetry of Gallavotti and Cohen

| sequence | windows | slope | miss | mean bar | share |
|---|---|---|---|---|---|
{slopes}

The chain's slope is that of its limit: its windows are off by a part that falls as 1/n, of which the line leaves some.
"""


class Tally:
    """Errors over half widths, case by case."""

    def __init__(self) -> None:
        self.errors: dict[tuple[str, str, str], list[np.ndarray]] = {}
        self.bars: dict[tuple[str, str, str], list[np.ndarray]] = {}

    def add(self, key: tuple[str, str, str], error: np.ndarray, bar: np.ndarray) -> None:
        self.errors.setdefault(key, []).append(np.atleast_1d(error))
        self.bars.setdefault(key, []).append(np.atleast_1d(bar))

    def shares(self, key: tuple[str, str, str]) -> np.ndarray:
        return np.mean(np.abs(self.errors[key]) <= np.array(self.bars[key]), axis=0)

    def miss(self, key: tuple[str, str, str]) -> tuple[float, float]:
        """Largest mean error of a point and the mean bar there."""
        mean, bars = np.mean(self.errors[key], axis=0), np.mean(self.bars[key], axis=0)
        worst = int(np.argmax(np.abs(mean)))
        return float(mean[worst]), float(bars[worst])


def edges_of(name: str, sampling: Resampling) -> np.ndarray:
    if name not in LATTICE:
        return usual_edges(sampling)
    v = LATTICE[name]
    return np.column_stack([v - 1e-6, v + 1e-6]).ravel()


def one_case(name: str, case: int, rng: np.random.Generator, tally: Tally) -> None:
    sequence, lengths = SEQUENCES[name], LENGTHS[name]
    sampling = Resampling(
        sequences=checked_sequences([sequence.make(rng, HELD[name])]), longest=lengths[-1], seed=case, level=LEVEL,
        resamples=200,
    )  # fmt: skip
    for n in {SETTLED[name], SETTLED[name] // 4}:
        found = cumulants(sampling, n, TILTS[name])
        tally.add((name, "lambda", str(n)), found.value - sequence.cumulant(TILTS[name]), found.half_width)
        tally.add((name, "transform", str(n)), found.rate - sequence.rate(found.v), found.half_width)
    edges = edges_of(name, sampling)
    curves = [rate_function(sampling, n, edges) for n in lengths]
    limit = extrapolated(sampling, curves)
    # beside the bin of the mean, where the rate is zero: two values of a lattice, three bins to either side else
    middle = int(np.flatnonzero(limit.half_width == 0.0)[0])
    own = middle + (np.array([-2, 2]) if name in LATTICE else np.array([-3, -2, -1, 1, 2, 3]))
    truth = sequence.rate(limit.v[own])
    tally.add((name, "histogram", str(lengths[0])), curves[0].rate[own] - truth, curves[0].half_width[own])
    label = ", ".join(map(str, lengths))
    tally.add((name, "histogram, limit", label), limit.rate[own] - truth, limit.half_width[own])
    symmetries = [symmetry(sampling, n) for n in SLOPES[name]]
    for each in symmetries:
        tally.add((name, "slope", str(each.periods)), each.slope - sequence.slope, each.half_width)
    slope, half_width = limit_of_slope(sampling, symmetries)
    tally.add((name, "slope", "limit"), slope - sequence.slope, half_width)


@pytest.mark.validate
def test_error_bars_hold_the_closed_forms() -> None:
    tally = Tally()
    for name in SEQUENCES:
        rng = np.random.default_rng(1)
        for case in range(CASES):
            one_case(name, case, rng, tally)
    _draw()
    _write(tally)
    for name in SEQUENCES:
        for road in ("lambda", "transform"):
            shares = tally.shares((name, road, str(SETTLED[name])))
            assert shares.min() > LEAST, (name, road, shares)
        shares = tally.shares((name, "histogram, limit", ", ".join(map(str, LENGTHS[name]))))
        assert shares.min() > LEAST, (name, shares)
    assert tally.shares(("chain", "slope", "limit")).min() > LEAST_OF_LIMIT
    assert tally.shares(("gaussian", "slope", "4")).min() > LEAST


def _write(tally: Tally) -> None:
    rows, slopes = [], []
    for key in tally.errors:
        name, road, windows = key
        shares, (miss, bar) = tally.shares(key), tally.miss(key)
        if road == "slope":
            slope = SEQUENCES[name].slope
            slopes.append(f"| {NAMES[name]} | {windows} | {slope:.4f} | {miss:+.4f} | {bar:.4f} | {shares[0]:.3f} |")
        else:
            rows.append(
                f"| {NAMES[name]} | {road} | {windows} | {len(shares)} | {shares.min():.3f} to {shares.max():.3f} | "
                f"{miss:+.1e}, {bar:.1e} |"
            )
    held = ", ".join(f"{count} ({name})" for name, count in HELD.items())
    page = PAGE.format(cases=CASES, level=LEVEL, held=held, rows="\n".join(rows), slopes="\n".join(slopes))
    (DOCS / "large_deviations.md").write_text(page)


def _draw() -> None:
    """One record of each sequence: both roads beside the closed form."""
    figure, panels = plt.subplots(1, 3, figsize=(11.0, 3.8), layout="constrained")
    for axes, (name, sequence) in zip(panels, SEQUENCES.items(), strict=True):
        lengths = LENGTHS[name]
        sampling = Resampling(
            sequences=checked_sequences([sequence.make(np.random.default_rng(2), HELD[name])]), longest=lengths[-1]
        )
        edges = edges_of(name, sampling)
        curves = [rate_function(sampling, n, edges) for n in lengths]
        shown = slice(None, None, 2 if name in LATTICE else 1)  # not what lies between the values of a lattice
        for curve, tone in zip(curves, ("#9ecae1", "#6baed6", "#3182bd"), strict=True):
            points = (part[shown] for part in (curve.v, curve.rate, curve.half_width))
            axes.errorbar(*points, fmt=".", color=tone, ms=4, lw=0.8, label=f"n = {curve.periods}")
        limit = extrapolated(sampling, curves)
        points = (part[shown] for part in limit[:3])
        axes.errorbar(*points, fmt="ks", ms=4, mfc="none", lw=0.8, label="limit of these")
        tilts = np.linspace(4.0 * TILTS[name][0], 4.0 * TILTS[name][-1], 41)
        found = cumulants(sampling, SETTLED[name], tilts)
        axes.errorbar(
            found.v, found.rate, found.half_width, fmt="r.", ms=3, lw=0.7, label=f"transform, n = {SETTLED[name]}"
        )
        reach = np.concatenate([found.v[np.isfinite(found.v)], limit.v[np.isfinite(limit.rate)]])
        v = np.linspace(reach.min(), reach.max(), 120)
        if name in LATTICE:
            v = np.clip(v, -0.995, 0.995)
        axes.plot(v, sequence.rate(v), color="#2a9d8f", lw=1.2, label="closed form")
        axes.set(xlabel="v", ylabel="I(v)", title=NAMES[name])
        axes.title.set_fontsize(9)
        axes.set_ylim(-0.05 * sequence.rate(v).max(), 1.25 * sequence.rate(v).max())
        axes.legend(fontsize=7, frameon=False)
    figure.savefig(DOCS / "large_deviations.png", dpi=130)
    plt.close(figure)
