"""`make validate`: the large-deviation function of an intruder's rise, from many small shaken boxes.

Makes (or takes up) the ensembles in `runs/validation/rises` and writes `docs/validation/rises.md` with a picture.
"""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes

sys.path.insert(0, str(Path(__file__).parent))

from rise_cases import CASES, Measured, beyond, grown, measured

from coupled.campaign.statistics import Interval
from particles.measures import Estimate, WindowMoments

DOCS = Path(__file__).parents[2] / "docs" / "validation"
PICTURE = "rises.png"
WIDE = 118  # of a line of text
USUAL = 0.1  # share of bins beyond bars of level 0.95 that says nothing: twice what is expected
PAGE = """# Large deviations of the rise of an intruder

Written by `make validate`.

400 discs of diameter 1 and one of diameter 5, of equal density, in boxes 15 wide, shaken as in the
[source's scenes](shaken.md) at the period of 25 000 of its steps; lengths are mean diameters. The estimator is that of
`leito measure ENSEMBLE --first .. --last .. --phase quiet`, proved on [closed forms](large_deviations.md). Bars and
intervals are of level 0.95, from whole samples drawn again: windows of one sample are not independent.

![{picture}]({picture})

## What counts

In a box there is no limit of endless windows: the rise of a grain between floor and surface is bounded, and its rate
depends on the depth. What is estimated is the function of a *stage*, for windows far shorter than it. The stage is the
same periods of the shaking in all samples, in which the intruder comes from well above the floor and is nowhere near
the surface. A stage between two heights would keep those that rise slowly for longer, drop a window in which one
leaves, and so cut the tails; a fixed time does neither. Its price is that heights spread within it.

{stages}

Means in the quarters of the stage, in its second half less the first, and in fifths of all periods from the first of
the stage on:

| case | samples | periods | height at first, at last | rise per period, quarters | halves | fifths |
|---|---|---|---|---|---|---|
{quarters}

## Windows

n is the length of the windows, `variance` that of their sum over n, which tends to the variance of single rises with
all their correlations; `whole` is the variance of the rise over the whole stage between samples, without windows.
`beyond` counts the bins of the histogram whose bars do not reach the Gaussian of the same mean and variance; one in
twenty would by chance on the average, though all share the noise of the bin of the mean. The slope is that of
Gallavotti and Cohen, `ln P(v)/P(-v) = n s v`; a Gaussian has `2 mean/variance`. Bins are a third of the deviation of
their own windows; the extrapolation and its gaps use those of the longest for all.

| case | n | windows side by side | mean | variance | skewness | excess | beyond | slope s | Gaussian slope |
|---|---|---|---|---|---|---|---|---|---|
{windows}

{verdicts}

## The phase at which one looks

Of the ten phases, the heights are read at that at which single rises spread least. At others the swing of the bed,
which cancels in long windows, hides the rise in short ones; variance at phase 0, the lowest point of the floor:

| case | {lengths} |
|---|{dashes}|
{phases}

## Not resolved

The limit n to infinity at fixed v, of which there is none in a box; tails beyond about three deviations of the longest
windows, where too few lie; how the function depends on depth, size, density or Gamma; the boxes of 2500 grains. Windows
of n begin early enough for the longest one to fit, so that the last periods of the stage count for less in short ones.
"""


def told(found: Interval | Estimate, digits: int = 4) -> str:
    """Value and half width."""
    value = found.mean if isinstance(found, Interval) else found.value
    return f"{value:+.{digits}f} +- {found.half_width:.{digits}f}"


def stage_words(one: Measured) -> str:
    """What was run, and at which phase."""
    case = one.case
    return (
        f"**{capital(case.title)}.** {len(one.records)} samples of {case.length} periods; the stage is the periods "
        f"{case.first} to {case.last}, phase {one.stage.phase:.1f}. The surface at rest is at {one.surface:.1f}; the "
        f"upper edge of the intruder comes within its radius of it in {one.at_top or 'none'} of the stages."
    )


def capital(title: str) -> str:
    """With a capital letter."""
    return title[0].upper() + title[1:]


def quarter_row(one: Measured) -> str:
    """One line of the table of the stages."""
    first, last = one.stage.mean[0], one.stage.mean[-1]
    samples = np.array([sample.rise for sample in one.whole.samples])
    fifths = ", ".join(f"{part.mean():.3f}" for part in np.array_split(samples, 5, axis=1))
    quarters = ", ".join(told(quarter, 3) for quarter in one.quarters())
    cells = (
        one.case.title, len(one.records), one.rises.size, f"{first:.1f}, {last:.1f}", quarters, told(one.turn(), 3),
        fifths,
    )  # fmt: skip
    return f"| {' | '.join(map(str, cells))} |"


def window_rows(one: Measured) -> list[str]:
    """Lines of the table of the windows, and one of the whole stage."""
    found, rows = one.found, []
    curves = one.curves()
    side_by_side = {n: sum(len(s.rise) // n for s in one.stage.samples) for n in found.lengths}
    for moments, symmetry in zip(found.moments, found.symmetries, strict=True):
        n = moments.periods
        out, bins = beyond(curves[n], moments)
        slope = "no left tail" if symmetry.slope is None else f"{symmetry.slope:.2f} +- {symmetry.half_width:.2f}"
        cells = (
            one.case.title, n, side_by_side[n], told(moments.mean), told(moments.variance),
            told(moments.skewness, 2), told(moments.excess, 2), f"{out} of {bins}",
            slope, f"{2.0 * moments.mean.value / moments.variance.value:.2f}",
        )  # fmt: skip
        rows.append(f"| {' | '.join(map(str, cells))} |")
    value, half = one.between()
    rows.append(f"| {one.case.title} | whole | {len(one.records)} | | {value:+.4f} +- {half:.4f} | | | | | |")
    return rows


def holds_zero(found: Estimate) -> bool:
    """Whether the interval does."""
    return abs(found.value) <= found.half_width


def gaussian_words(one: Measured) -> str:
    """Whether Gaussians of the same mean and variance are what the windows say, and where not."""
    found, curves = one.found, one.curves()
    fails = []
    for moments in found.moments:
        out, bins = beyond(curves[moments.periods], moments)
        shape = not (holds_zero(moments.skewness) and holds_zero(moments.excess))
        if shape or out > USUAL * bins:
            fails.append(moments.periods)
    lasting = [m.periods for m in found.moments if m.periods not in fails]
    if not fails:
        return "the Gaussian explains all windows within bars"
    text = f"the Gaussian fails by shape or bins at n = {', '.join(map(str, fails))}"
    text += f" and explains n = {', '.join(map(str, lasting))} within bars" if lasting else ""
    longest = found.moments[-1]
    skewed = longest.skewness
    if holds_zero(skewed):
        return f"{text}; whether the longest windows are skewed is open: {told(skewed, 2)}"
    side = "slow" if skewed.value > 0.0 else "fast"
    return f"{text}; windows of {longest.periods} are skewed by {told(skewed, 2)}: {side} ones are the rarer"


def verdict(one: Measured) -> str:
    """What the case has come to, in a few sentences."""
    found = one.found
    gap = float(np.nanmax(found.limit.gap))
    settled = (
        f"the cumulant function at n = {found.settled} agrees with that at {2 * found.settled} within bars"
        if found.settled
        else "the cumulant function does not settle: no length agrees with its double within bars"
    )
    last, before = found.moments[-1], found.moments[-2]
    change = 100.0 * (last.variance.value / before.variance.value - 1.0)
    return (
        f"**{capital(one.case.title)}**: {settled}; histograms of the last two lengths differ by {gap:.1f} of the half "
        f"width of their difference at most; the variance changes by {change:+.0f} % from n = {before.periods} to "
        f"{last.periods}. {feedback_words(one)} As to shape, {gaussian_words(one)}. {symmetry_words(one)}"
    )


def feedback_words(one: Measured) -> str:
    """How the rate depends on the height, and what that does to the variance."""
    slope, half = one.feedback()
    longest, stage = one.found.lengths[-1], one.rises.shape[1]
    return (
        f"The rise per period changes by {slope:+.4f} +- {half:.4f} per diameter of height, which alone makes the "
        f"variance per period {grown(slope, longest):.2f} times that of single steps at n = {longest} and "
        f"{grown(slope, stage):.2f} times over the stage."
    )


def symmetry_words(one: Measured) -> str:
    """Up to which length there are left tails, and whether their slopes have settled."""
    seen = [each for each in one.found.symmetries if each.slope is not None]
    if not seen:
        return "There is no left tail, and no symmetry."
    text = f"Left tails are long enough up to n = {seen[-1].periods}"
    if one.found.slope is None:
        return text + ", of too few lengths for a limit of the slope."
    settled = abs(seen[-1].slope - seen[-2].slope) < seen[-1].half_width
    value = f"{one.found.slope[0]:.1f} +- {one.found.slope[1]:.1f}"
    if settled:
        return text + f"; the last two slopes agree within bars, and the line over 1/n ends at {value}."
    return (
        text
        + f"; the slope still changes there by more than its bar: {value}, where the line over 1/n ends, is a guess."
    )


def draw(cases: Sequence[Measured]) -> None:
    """Heights, function and symmetry of each case."""
    figure, panels = plt.subplots(len(cases), 3, figsize=(13.0, 4.2 * len(cases)), layout="constrained")
    for (left, middle, right), one in zip(panels, cases, strict=True):
        _draw_heights(left, one)
        _draw_rates(middle, one)
        _draw_symmetry(right, one)
    figure.savefig(DOCS / PICTURE, dpi=130)
    plt.close(figure)


def _draw_heights(axes: Axes, one: Measured) -> None:
    period = one.case.first + np.arange(len(one.whole.time))
    for sample in one.whole.samples:
        axes.plot(period, sample.value, color="#1f5a94", lw=0.4, alpha=0.35)
    axes.plot(period, one.whole.mean, color="k", lw=1.6, label="mean")
    axes.axvspan(one.case.first, one.case.last, color="#e09f3e", alpha=0.2, lw=0, label="stage")
    axes.axhline(one.surface, color="0.5", ls="--", lw=0.8, label="surface at rest")
    axes.set(xlabel="periods of shaking", ylabel="height of the intruder", title=one.case.title)
    axes.legend(fontsize=7, frameon=False)


def _draw_rates(axes: Axes, one: Measured) -> None:
    found, curves = one.found, one.curves()
    tones = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(curves)))
    for curve, tone in zip(curves.values(), tones, strict=True):
        axes.errorbar(
            curve.v, curve.rate, curve.half_width, fmt="o-", ms=3, lw=0.8, elinewidth=0.6, color=tone,
            label=f"n = {curve.periods}",
        )  # fmt: skip
    longest = found.moments[-1]
    known = np.concatenate([curve.v[np.isfinite(curve.rate)] for curve in curves.values()])
    v = np.linspace(known.min(), known.max(), 200)
    axes.plot(v, longest.gaussian_rate(v), "k--", lw=1.0, label=f"Gaussian, variance of n = {longest.periods}")
    chosen = found.tilted[found.settled or found.lengths[-1]]
    label = f"transform, n = {found.settled}" if found.settled else f"transform, n = {longest.periods}, not settled"
    axes.plot(chosen.v, chosen.rate, "r-", lw=1.2, label=label)
    top = max(float(np.nanmax(curve.rate)) for curve in curves.values())
    axes.set(xlabel="rise per period v", ylabel="I(v)", ylim=(-0.05 * top, 1.25 * top))
    axes.legend(fontsize=7, frameon=False)


def _draw_symmetry(axes: Axes, one: Measured) -> None:
    seen = [each for each in one.found.symmetries if each.points is not None]
    tones = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(one.found.symmetries)))
    for each, tone in zip(seen, tones, strict=False):
        points = each.points
        label = f"n = {each.periods}: s = {each.slope:.2f} +- {each.half_width:.2f}"
        axes.errorbar(points.v, points.ratio, points.half_width, fmt="o", ms=3, elinewidth=0.6, color=tone, label=label)
        axes.plot([0.0, points.v.max()], [0.0, each.slope * points.v.max()], "-", lw=0.8, color=tone)
    axes.set(xlabel="|v|", ylabel="ln(P(v)/P(-v))/n")
    axes.legend(fontsize=7, frameon=False)


def variances(moments: Sequence[WindowMoments], lengths: Sequence[int]) -> list[str]:
    """By the length of the windows; empty where they are not seen."""
    known = {one.periods: f"{one.variance.value:.3f}" for one in moments}
    return [known.get(n, "") for n in lengths]


def write(cases: Sequence[Measured]) -> None:
    """Draw, and write the page; no number in it is typed by hand."""
    draw(cases)
    lengths = sorted({n for one in cases for n in one.found.lengths})
    phases = []
    for one in cases:
        for phase, rise in ((one.stage.phase, one.stage), (0.0, one.at_zero)):
            cells = variances(rise.deviations.moments, lengths)
            phases.append(f"| {one.case.title}, phase {phase:.1f} | {' | '.join(cells)} |")
    page = PAGE.format(
        picture=PICTURE,
        stages="\n\n".join(textwrap.fill(stage_words(one), WIDE) for one in cases),
        quarters="\n".join(map(quarter_row, cases)),
        windows="\n".join(row for one in cases for row in window_rows(one)),
        verdicts="\n\n".join(textwrap.fill(verdict(one), WIDE) for one in cases),
        lengths=" | ".join(f"n = {n}" for n in lengths),
        dashes="|".join("---" for _ in lengths),
        phases="\n".join(phases),
    )
    (DOCS / "rises.md").write_text(page)


@pytest.mark.validate
def test_large_deviations_of_the_rise() -> None:
    cases = [measured(case) for case in CASES]
    write(cases)
    for one in cases:
        found = one.found
        assert found.whole and one.at_top == 0
        assert one.stage.rate.low > 0.0, one.stage.rate  # it rises in both
        assert any(symmetry.slope is not None for symmetry in found.symmetries)
        # windows of the longest length and whole stages of independent samples have one variance, but for what
        # remembers longer than the longest window: bars of both, added
        value, half = one.between()
        assert abs(found.moments[-1].variance.value - value) < found.moments[-1].variance.half_width + half
        for record in one.records:
            assert abs(record.history["ledger_relative_error"][-1]) < 0.01, record.folder
