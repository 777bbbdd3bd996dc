"""Pictures of the measures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coupled.measuring.findings import Findings
from coupled.measuring.look import COLOURS, WIDTH, length, title
from coupled.measuring.record import Floats, Shaken
from coupled.measuring.rises import Rise, height_over_floor, speed_over_floor
from coupled.measuring.states import Rolls
from coupled.measuring.windows_picture import large_deviation
from coupled.report.drawing import Axes, Figure, NullFormatter, plt
from particles.measures import portrait, strobe

FEWEST_SAMPLES = 3  # for a band: of two it is wider than the picture
FEWEST_ROWS = 8  # of the history in a period, for a portrait


def draw_all(found: Sequence[Findings], folder: Path) -> list[Path]:
    """Draw what there is; returns the paths of the pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    pictures = {"height": heights(found), "rise_rate": rise_rates(found), "profiles": profiles(found)}
    for number, one in enumerate(found):
        more = "" if len(found) == 1 else f"_{number + 1}"
        pictures |= {
            f"convection{more}": convection(one),
            f"portrait{more}": phase_portrait(one),
            f"large_deviation{more}": large_deviation(one),
        }
    drawn = []
    for name, figure in pictures.items():
        if figure is not None:
            drawn.append(folder / f"{name}.png")
            figure.savefig(drawn[-1], dpi=150)
            plt.close(figure)
    return drawn


class Curve(NamedTuple):
    """An intruder of a group: its label, its rise, its colour, and the shaking whose periods are counted."""

    label: str
    rise: Rise
    colour: str
    shaken: Shaken

    def periods(self, time: Floats) -> Floats:
        """Times [s] as periods since the shaking began."""
        return (time - self.shaken.start) / self.shaken.period


def _curves(found: Sequence[Findings]) -> list[Curve]:
    """Every intruder of every group."""
    several = any(len(one.rises) > 1 for one in found)
    names = [(one, rise) for one in found for rise in one.rises]
    return [
        Curve(
            f"{one.group.label}, {rise.name}" if several else one.group.label,
            rise,
            COLOURS[k % len(COLOURS)],
            one.group.records[0].shaken,
        )
        for k, (one, rise) in enumerate(names)
    ]


def heights(found: Sequence[Findings]) -> Figure | None:
    """Height once a period: samples thin, their mean thick with its 95 % interval."""
    curves = _curves(found)
    if not curves:
        return None
    figure, axes = plt.subplots(figsize=(WIDTH, 4.2), layout="constrained")
    for curve in curves:
        label, rise, colour, _ = curve
        for sample in rise.samples:
            axes.plot(curve.periods(sample.time), sample.value, color=colour, lw=0.6, alpha=0.35)
        period = curve.periods(rise.time)
        told = f"{label}, {len(rise.samples)} sample{'s' * (len(rise.samples) > 1)}"
        axes.plot(period, rise.mean, color=colour, lw=2.0, label=told)
        if len(rise.samples) >= FEWEST_SAMPLES:
            low, high = rise.mean - rise.half_width, rise.mean + rise.half_width
            axes.fill_between(period, low, high, color=colour, alpha=0.15, lw=0)
    axes.set(xlabel="periods of shaking", ylabel=length(found, "height of the intruder over the floor"))
    axes.set_title(title(found), fontsize=10)
    axes.set_ylim(*_reach([sample.value for curve in curves for sample in curve.rise.samples]))
    axes.legend(fontsize=8, frameon=False)
    axes.grid(alpha=0.25)
    return figure


def _reach(curves: Sequence[Floats]) -> tuple[float, float]:
    """Limits of an axis that holds curves (n,), whatever bands go beyond."""
    low, high = min(float(curve.min()) for curve in curves), max(float(curve.max()) for curve in curves)
    margin = 0.06 * (high - low) or 1.0
    return low - margin, high + margin


def rise_rates(found: Sequence[Findings]) -> Figure | None:
    """Mean rise per period in windows of a tenth of the record, with the 95 % interval of the whole."""
    curves = _curves(found)
    if not curves:
        return None
    figure, axes = plt.subplots(figsize=(WIDTH, 3.6), layout="constrained")
    shown = [np.zeros(1)]
    for curve in curves:
        label, rise, colour, _ = curve
        window = max(1, len(rise.time) // 10)
        mean = rise.mean[::window]
        middle = curve.periods(rise.time[0]) + (np.arange(len(mean) - 1) + 0.5) * window
        shown.append(np.diff(mean) / window)
        axes.plot(middle, shown[-1], "o-", color=colour, ms=4, lw=1.2, label=label)
        axes.axhline(rise.rate.mean, color=colour, lw=0.8, ls="--")
        if rise.rate.count > 1:
            axes.axhspan(rise.rate.low, rise.rate.high, color=colour, alpha=0.08, lw=0)
    axes.axhline(0.0, color="0.4", lw=0.8)
    axes.set(xlabel="periods of shaking", ylabel=length(found, "rise per period"))
    axes.set_title(
        f"{title(found)}\nmeans over tenths of the record; dashed the whole, with its 95 % interval", fontsize=9
    )
    axes.set_ylim(*_reach(shown))
    axes.legend(fontsize=8, frameon=False)
    axes.grid(alpha=0.25)
    return figure


def profiles(found: Sequence[Findings]) -> Figure | None:
    """Packing fraction, coordination and temperatures over the height."""
    shown = [one for one in found if one.profiles is not None]
    if not shown:
        return None
    figure, panels = plt.subplots(1, 3, figsize=(WIDTH + 1.0, 4.4), sharey=True, layout="constrained")
    for k, one in enumerate(shown):
        own, colour = one.profiles, COLOURS[k % len(COLOURS)]
        for axes, names in zip(
            panels, (("packing",), ("coordination",), ("temperature", "spin_temperature")), strict=True
        ):
            for name, style in zip(names, ("-", "--"), strict=False):
                label = one.group.label if len(names) == 1 else name.replace("_", " ")
                mean, half = own.mean[name], own.half_width[name]
                axes.plot(mean, own.y, style, color=colour, lw=1.4, label=label)
                if np.isfinite(half).any():
                    axes.fill_betweenx(own.y, mean - half, mean + half, color=colour, alpha=0.15, lw=0)
    panels[0].set(xlabel="packing fraction", ylabel=length(found, "height over the floor"), xlim=(0.0, None))
    panels[1].set(xlabel="contacts per grain", xlim=(0.0, None))
    panels[2].set(xlabel="temperature over mean mass")
    if any((one.profiles.mean["temperature"] > 0.0).any() for one in shown):
        panels[2].set_xscale("log")
        panels[2].xaxis.set_minor_formatter(NullFormatter())
    (panels[0] if len(shown) > 1 else panels[2]).legend(fontsize=7, frameon=False)
    frames = sum(one.profiles.frames for one in shown)
    figure.suptitle(f"{title(found)}: means of {frames} frame{'s' * (frames > 1)}", fontsize=10)
    return figure


def convection(one: Findings) -> Figure | None:
    """Displacement per period: colour by its vertical part, streamlines."""
    if one.rolls is None:
        return None
    cells, field = one.rolls.cells, one.rolls.field
    extent = (cells.left, cells.left + cells.width, cells.bottom, cells.bottom + cells.height)
    shape = min(max(cells.height / cells.width, 0.3), 1.4)
    figure, axes = plt.subplots(figsize=(WIDTH, 0.8 * WIDTH * shape + 1.0), layout="constrained")
    up = field.displacement[..., 1]
    limit = float(np.nanquantile(np.abs(up), 0.98)) or 1.0
    shown = axes.imshow(up, origin="lower", extent=extent, cmap="RdBu_r", vmin=-limit, vmax=limit, aspect="equal")
    _streamlines(axes, one.rolls)
    figure.colorbar(shown, ax=axes, label=length([one], "rise per period"), shrink=0.8)
    axes.set(xlabel=length([one], "x"), ylabel=length([one], "height over the floor"), xlim=extent[:2], ylim=extent[2:])
    roll = one.rolls.roll
    told = f"{roll.mean:.3g}" + (f" +- {roll.half_width:.2g}" if roll.count > 1 else "")
    axes.set_title(f"{one.group.label}: middle over sides {told} per period", fontsize=10)
    return figure


def _streamlines(axes: Axes, rolls: Rolls) -> None:
    cells, flow = rolls.cells, rolls.field.displacement
    if cells.rows < 2:
        return
    speed = np.hypot(flow[..., 0], flow[..., 1])
    top = float(np.nanmax(speed)) or 1.0
    u, v = (np.ma.masked_invalid(flow[..., k]) for k in range(2))
    width = 0.4 + 1.6 * np.nan_to_num(speed) / top
    axes.streamplot(cells.x, cells.y, u, v, color="0.15", linewidth=width, density=1.2, arrowsize=0.8)


def phase_portrait(one: Findings) -> Figure | None:
    """The first sample's intruder over the phase: height over the floor less its rise, and velocity against it.

    Both as the floor sees them.
    """
    record = one.group.records[0]
    if not one.rises or record.shaken is None:
        return None
    rise, shaken, time = one.rises[0], record.shaken, record.history["time"]
    rows = shaken.period / float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    if rows < FEWEST_ROWS - 0.01:
        return None
    looks = rise.samples[0].time
    height, on = height_over_floor(record, rise.name), (time >= looks[0]) & (time <= looks[-1])
    level = strobe(time, height, period=shaken.period, start=shaken.start)
    swing = (height - np.interp(time, level.time, level.value))[on]
    speed = speed_over_floor(record, rise.name)[on]
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH + 1.0, 3.8), layout="constrained")
    seen = portrait(time[on], swing, period=shaken.period, start=shaken.start, bins=min(32, round(rows)))
    left.plot(seen.phase, seen.value, ".", ms=2, color=COLOURS[0], alpha=0.4)
    left.plot(np.arange(len(seen.mean) + 1) / len(seen.mean), np.append(seen.mean, seen.mean[0]), "k-", lw=1.2)
    left.set(xlabel="phase of the shaking", ylabel=length([one], "height over the floor, rise taken out"))
    points = right.scatter(swing, speed, c=seen.phase, s=3, cmap="twilight", vmin=0.0, vmax=1.0)
    figure.colorbar(points, ax=right, label="phase")
    right.set(xlabel=length([one], "height over the floor, rise taken out"), ylabel="velocity over the floor")
    figure.suptitle(f"{one.group.label}: {rise.name}, {record.title}", fontsize=9)
    return figure
