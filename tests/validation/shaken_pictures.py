"""Pictures of the shaken boxes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from shaken_cases import CASES, GAMMAS, LONG_CASE, Ascent
from shaken_words import WHOLE, Found

from coupled.campaign.statistics import confidence
from coupled.measuring.findings import Findings
from coupled.measuring.pictures import convection
from coupled.measuring.rises import Periods
from coupled.measuring.samples import Group, intervals
from coupled.measuring.states import rolls_of
from particles import ParticleError

TONES = {"0.9": "#5d6d7e", "1.1": "#e09f3e", "1.3": "#c1440e", "1.5": "#7b1e1e"}
KINDS = {"walls_light": "#2a9d8f", "walls": "#1f5a94", "walls_heavy": "#7b4b94"}
ROLLS = ("walls", "smooth_walls", "periodic_25000")  # with the largest Gamma
BAND = 3  # samples for an interval to be drawn


def draw(found: Found, folder: Path) -> list[str]:
    """Draw what there is; returns the names of the pictures."""
    titles = {case.name: case.title for case in CASES if case.name in found}
    written = [_heights(found, titles, folder), _densities(found, titles, folder), _rises(found, titles, folder)]
    return [name for name in written if name]


def _curve(axes: Axes, ascents: Sequence[Ascent], colour: str, label: str) -> None:
    """Samples thin, their mean thick, with its 95 % interval."""
    mean, half, _ = intervals([ascent.height for ascent in ascents])
    periods = ascents[0].periods
    for ascent in ascents:
        axes.plot(ascent.periods, ascent.height, color=colour, lw=0.6, alpha=0.4)
    axes.plot(periods, mean, color=colour, lw=1.8, label=f"{label}, {len(ascents)} sample{'s' * (len(ascents) > 1)}")
    if len(ascents) >= BAND:
        axes.fill_between(periods, mean - half, mean + half, color=colour, alpha=0.15, lw=0)


def _surface(axes: Axes, ascents: Sequence[Ascent]) -> None:
    axes.axhline(float(np.mean([ascent.surface for ascent in ascents])), color="0.5", lw=0.8, ls="--")
    axes.grid(alpha=0.25)
    axes.set_xlabel("periods of shaking")


def _heights(found: Found, titles: dict[str, str], folder: Path) -> str:
    figure, panels = plt.subplots(2, 4, figsize=(13.0, 6.4), layout="constrained")
    for axes, (name, title) in zip(panels.flat, titles.items(), strict=False):
        for gamma, ascents in found[name].items():
            _curve(axes, ascents, TONES[gamma], f"Gamma {gamma}")
        everyone = [ascent for ascents in found[name].values() for ascent in ascents]
        _surface(axes, everyone)
        axes.set(title=title, ylim=(0.0, 1.08 * max(ascent.surface for ascent in everyone)))
        axes.title.set_fontsize(10)
        axes.legend(fontsize=7, frameon=False, loc="lower left")
    for axes in panels.flat[len(titles) :]:
        axes.set_axis_off()
    figure.supylabel("height of the intruder's centre over the floor, means of two periods", fontsize=10)
    return _saved(figure, folder / "shaken_heights.png")


def _densities(found: Found, titles: dict[str, str], folder: Path) -> str:
    there = {name: tone for name, tone in KINDS.items() if name in found}
    if len(there) < 2:
        return ""
    figure, panels = plt.subplots(1, len(TONES), figsize=(14.0, 3.8), layout="constrained", sharey=True)
    for axes, gamma in zip(panels, TONES, strict=True):
        for name, tone in there.items():
            if gamma in found[name]:
                _curve(axes, found[name][gamma], tone, titles[name].removeprefix("rough walls, ").replace(
                    "rough walls", "equal density"))  # fmt: skip
        _surface(axes, [ascent for name in there for ascent in found[name].get(gamma, [])])
        axes.set_title(f"rough walls, Gamma = {gamma}", fontsize=10)
        axes.legend(fontsize=7, frameon=False)
    panels[0].set_ylabel("height of the intruder's centre")
    return _saved(figure, folder / "shaken_densities.png")


def _rises(found: Found, titles: dict[str, str], folder: Path) -> str:
    figure, axes = plt.subplots(figsize=(7.5, 4.2), layout="constrained")
    shown = {name: title for name, title in titles.items() if name != LONG_CASE}
    for place, (name, title) in enumerate(shown.items()):
        rises = [(float(gamma), [a.climbed(WHOLE) for a in ascents]) for gamma, ascents in found[name].items()]
        aside = 0.006 * (place - 3)  # so that bars do not hide each other
        colour = f"C{place}"
        for gamma, values in rises:
            axes.plot([gamma + aside] * len(values), values, ".", color=colour, ms=4, alpha=0.5)
        means = [confidence(values) for _, values in rises]
        bars = [mean.half_width if mean.count >= BAND else 0.0 for mean in means]
        places = [gamma + aside for gamma, _ in rises]
        axes.errorbar(
            places, [mean.mean for mean in means], bars, fmt="o-", color=colour, lw=1.0, ms=5, capsize=3, label=title
        )
    axes.axhline(0.0, color="0.4", lw=0.8)
    axes.set(xlabel="Gamma", ylabel="rise in 200 periods")
    axes.legend(fontsize=7, frameon=False)
    axes.grid(alpha=0.25)
    return _saved(figure, folder / "shaken_rises.png")


def draw_rolls(found: Found, folder: Path) -> tuple[list[str], dict[str, str]]:
    """Convection at the largest Gamma of all cases; names of pictures, and the roll of each case in words."""
    written, told = [], {}
    titles = {case.name: case.title for case in CASES}
    gamma = GAMMAS[-1]
    for name in [case.name for case in CASES if gamma in found.get(case.name, {})]:
        group = Group(f"{titles[name]}, Gamma {gamma}", tuple(ascent.record for ascent in found[name][gamma]))
        try:
            rolls = rolls_of(group, Periods())
        except ParticleError:  # the frames of the longer period lie at several phases
            continue
        half = f" +- {rolls.roll.half_width:.2f}" if rolls.roll.count > 1 else ""
        told[name] = f"{rolls.roll.mean:.2f}{half} ({rolls.roll.count})"
        if name in ROLLS:
            figure = convection(Findings(group=group, rises=(), profiles=None, rolls=rolls, notes=()))
            figure.axes[0].title.set_fontsize(8)
            written.append(_saved(figure, folder / f"shaken_convection_{name}.png"))
    return written, told


def _saved(figure: plt.Figure, path: Path) -> str:
    figure.savefig(path, dpi=90)
    plt.close(figure)
    return path.name
