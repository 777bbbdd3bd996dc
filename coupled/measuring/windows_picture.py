"""The picture of windows: large-deviation function and symmetry."""

from __future__ import annotations

import numpy as np

from coupled.measuring.findings import Findings
from coupled.measuring.look import WIDTH, length
from coupled.measuring.rises import LargeDeviations, Rise
from coupled.report.drawing import Axes, Figure, plt


def large_deviation(one: Findings) -> Figure | None:
    """Histograms of all windows, their limit, the transform, and the symmetry where there is one."""
    rise = next((rise for rise in one.rises if not rise.deviations.lacks), None)
    if rise is None:
        return None
    found = rise.deviations
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH + 2.0, 4.2), layout="constrained")
    shades = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(found.lengths)))
    tones = dict(zip(found.lengths, shades, strict=True))
    for curve in found.curves:  # not of every length
        left.errorbar(
            curve.v, curve.rate, curve.half_width, fmt="o-", ms=3, lw=0.8, elinewidth=0.6, color=tones[curve.periods],
            label=f"{curve.periods} period{'s' * (curve.periods > 1)}",
        )  # fmt: skip
    if np.isfinite(found.limit.rate).sum() > 1:
        left.errorbar(
            found.limit.v,
            found.limit.rate,
            found.limit.half_width,
            fmt="ks",
            ms=4,
            mfc="none",
            label="limit of the line",
        )
    chosen = found.tilted[found.settled or found.lengths[-1]]
    known = np.isfinite(chosen.rate)
    longest = found.moments[-1]
    v = found.curves[-1].v
    label = f"Gaussian, variance of n = {longest.periods}"
    left.plot(v, longest.gaussian_rate(v), "--", color="0.5", lw=1.0, zorder=0, label=label)
    left.plot(chosen.v[known], chosen.rate[known], "r-", lw=1.4, label=_transform_label(found))
    left.set(xlabel=length([one], "rise per period v"), ylabel="I(v)")
    if not known.any() and not any(np.isfinite(curve.rate).any() for curve in found.curves):
        left.text(0.5, 0.5, "too few windows", ha="center", va="center", transform=left.transAxes, fontsize=9)
    else:
        left.legend(fontsize=7, frameon=False)
    _draw_symmetry(right, one, rise, tones)
    figure.suptitle(f"{one.group.label}: {rise.name}, {len(rise.samples)} samples", fontsize=10)
    return figure


def _transform_label(found: LargeDeviations) -> str:
    if found.settled is None:
        return f"Legendre transform, n = {found.lengths[-1]}, not settled"
    return f"Legendre transform, n = {found.settled}"


def _draw_symmetry(axes: Axes, one: Findings, rise: Rise, tones: dict[int, np.ndarray]) -> None:
    found = rise.deviations
    for each in found.symmetries:
        if each.points is not None:
            points, tone = each.points, tones[each.periods]
            axes.errorbar(points.v, points.ratio, points.half_width, fmt="o", ms=3, elinewidth=0.6, color=tone)
            axes.plot([0.0, points.v.max()], [0.0, each.slope * points.v.max()], "-", lw=0.8, color=tone)
    if found.slopes:
        axes.set_title("slope, " + "; ".join(f"{what}: {value}" for what, value in found.slopes), fontsize=8)
        axes.set(xlabel=length([one], "|v|"), ylabel="ln(P(v)/P(-v))/n")
        axes.grid(alpha=0.25)
    else:
        axes.axis("off")
        axes.text(0.5, 0.5, "no left tail:\nno symmetry can be seen", ha="center", va="center", fontsize=9)
