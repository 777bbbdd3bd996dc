"""The Pareto front as a picture: error against wall time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from coupled.report.drawing import Axes, plt
from coupled.study.judging.errors import Judged
from coupled.study.judging.front import front_of
from coupled.study.pages.labels import Label, write_labels
from coupled.study.settings.setting import Role

MARKERS = "osD^vP<>Xhp*d8"
ROLE_STYLE: dict[Role, tuple[str, str, float]] = {
    "base": ("X", "k", 9.0),
    "preset": ("*", "C3", 13.0),
    "combination": ("P", "C2", 8.0),
    "finer": ("d", "0.45", 7.0),
    "reference": ("d", "0.2", 8.0),
}
NAMED = ("preset", "base")
FEWEST_DECADES = 1.2  # of an axis


def draw_front(path: Path, title: str, items: Sequence[Judged]) -> None:
    """Draw one marker per setting of one quantity, the front as a line, presets and the base by name.

    An open marker stands where the difference from the reference is not resolved; its bar ends where the
    error may lie. The dotted line is the reference's own error.
    """
    figure, axes = plt.subplots(figsize=(9.0, 5.4), layout="constrained")
    lowest = _lowest(items)
    _draw_line(axes, items, lowest)
    for group, style in _groups(items):
        _draw_group(axes, group, style, lowest)
    floor = items[0].floor
    if floor > lowest:
        axes.axhline(floor, color="0.6", lw=0.8, ls=":")
        axes.annotate(
            "the reference's own error", (0.01, floor), xycoords=("axes fraction", "data"), ha="left", va="top",
            fontsize=7, color="0.4",
        )  # fmt: skip
    _scale(axes, items, lowest)
    axes.set(xlabel="wall time of a run [s]", ylabel="error over the reference [-]")
    axes.set_title(title, fontsize=10)
    axes.grid(True, which="major", color="0.9", lw=0.6)
    axes.legend(fontsize=7.5, loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, borderaxespad=0.0)
    figure.draw_without_rendering()  # the axes have their place now
    _name_points(axes, items, lowest)
    figure.savefig(path, dpi=140)
    plt.close(figure)


def _lowest(items: Sequence[Judged]) -> float:
    """Where errors that are next to nothing are drawn."""
    sound = [item.known for item in items if item.known > 1e-14]
    return 0.5 * min(sound, default=1e-15)


def _height(item: Judged, lowest: float) -> float:
    return max(abs(item.error) if item.verdict == "not resolved" else item.known, lowest)


def _draw_line(axes: Axes, items: Sequence[Judged], lowest: float) -> None:
    front = front_of(items)
    places = np.array([(item.ran.wall_seconds, max(item.known, lowest)) for item in front])
    axes.plot(*places.T, color="0.55", lw=1.4, zorder=1, label="front")


def _groups(items: Sequence[Judged]) -> list[tuple[list[Judged], tuple[str, str, str, float]]]:
    """Settings that share a marker: those of one knob, or of one role; (label, marker, colour, size)."""
    groups: dict[str, list[Judged]] = {}
    for item in items:
        setting = item.setting
        name = setting.knobs[0][0] if setting.role == "knob" else setting.role
        groups.setdefault(name, []).append(item)
    found = []
    for number, (name, group) in enumerate(sorted(groups.items(), key=lambda entry: entry[0] in ROLE_STYLE)):
        marker, colour, size = ROLE_STYLE.get(name, (MARKERS[number % len(MARKERS)], f"C{number % 10}", 6.5))
        found.append((group, (name, marker, colour, size)))
    return found


def _draw_group(axes: Axes, group: Sequence[Judged], style: tuple[str, str, str, float], lowest: float) -> None:
    name, marker, colour, size = style
    words = {"base": "as it is", "preset": "preset", "finer": "second finest", "reference": "finest"}
    label = words.get(name, name)
    for item in group:
        seconds, height = item.ran.wall_seconds, _height(item, lowest)
        open_ = item.verdict in ("not resolved", "one sample")
        if item.error_half_width > 0.0:
            low = max(abs(item.error) - item.error_half_width, lowest)
            high = abs(item.error) + item.error_half_width
            axes.plot([seconds, seconds], [low, high], color=colour, lw=0.8, alpha=0.6, zorder=2)
        axes.plot(
            seconds, height, marker, color=colour, ms=size, mfc="white" if open_ else colour, ls="none", zorder=3,
            label=label,
        )  # fmt: skip
        label = "_"


def _name_points(axes: Axes, items: Sequence[Judged], lowest: float) -> None:
    """Write the values beside the markers; presets and base first, which get the better places."""
    named = sorted(items, key=lambda item: (item.setting.role not in NAMED, item.ran.wall_seconds))
    write_labels(
        axes,
        [
            Label(_short(item), item.ran.wall_seconds, _height(item, lowest), item.setting.role in NAMED)
            for item in named
        ],
    )


def _short(item: Judged) -> str:
    setting = item.setting
    if setting.role == "preset":
        return setting.accuracy or setting.name
    if setting.role == "knob":
        return setting.knobs[0][1]
    return "" if setting.role == "finer" else setting.name


def _scale(axes: Axes, items: Sequence[Judged], lowest: float) -> None:
    """Logarithmic axes that are wide enough for what is written beside the markers."""
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    axes.set(xscale="log", yscale="log")
    walls = [item.ran.wall_seconds for item in items]
    heights = [_height(item, lowest) for item in items]
    tops = [abs(item.error) + item.error_half_width for item in items]
    for values, setter in ((walls, axes.set_xlim), ((*heights, *tops), axes.set_ylim)):
        low, high = np.log10(min(value for value in values if value > 0.0)), np.log10(max(values))
        margin = max(0.12 * (high - low), 0.5 * (FEWEST_DECADES - (high - low)), 0.1)
        setter(10 ** (low - margin), 10 ** (high + 1.3 * margin))
    low, high = axes.get_ylim()
    axes.yaxis.set_minor_formatter(plain if high < 100.0 * low else NullFormatter())
    axes.yaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0) if high < 100.0 * low else tuple(range(2, 10))))
    axes.xaxis.set_major_formatter(plain)
    axes.xaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    axes.xaxis.set_minor_formatter(plain)
    axes.tick_params(which="both", labelsize=8)
