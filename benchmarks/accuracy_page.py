"""The page of measured accuracies: a table per scene, and one picture of all presets."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path

import report
from matplotlib.ticker import FuncFormatter, LogLocator

from coupled.report.drawing import Line2D, plt
from coupled.scene.accuracy import PRESETS
from coupled.study.judging.errors import Judged
from coupled.study.pages.table import percent
from coupled.study.settings.setting import Ran
from coupled.study.study import Study

Done = tuple[str, str, Study]  # scene, what is shortened, its study
PLAIN = FuncFormatter(lambda value, _: f"{value:g}")
STYLE = {"draft": ("C1", "o"), "standard": ("C0", "s"), "reference": ("C2", "D")}
TEXT = """# What the presets cost, and how far off they are

Written by `make bench ARGS=accuracy` on {cores} cores of {processor}.

A study (`leito study`) of each scene, shortened where that is said. Errors are those of a quantity against its closed
form or the finest setting of its scene (step and mesh twice as fine; four times for the first three), over its
magnitude. In scenes with grains they are means over five seeds (three for the trench), +- Student's 95 % interval of
the differences seed by seed; an error inside its interval is not resolved. Times are processor seconds of one run on
one core, which are its wall time on a quiet machine; beds and compilation are not counted. The pictures of a single
scene show wall time as it was measured, two runs at a time.

{presets}

![accuracy.png](accuracy.png)

Errors of all quantities below against the time over that of the scene as it is; open: not resolved, or below what
the reference knows itself; the marker then stands at the bound.

{scenes}

{left_out}
"""


def write(path: Path, done: Sequence[Done], left_out: str) -> None:
    """Write the page and its pictures."""
    path.parent.mkdir(parents=True, exist_ok=True)
    about = report.machine()
    _draw(path.with_suffix(".png"), done)
    path.write_text(
        TEXT.format(
            cores=about["cores"], processor=about["processor"], presets=_presets(),
            scenes="\n\n".join(_scene(path, *one) for one in done), left_out=left_out,
        )
    )  # fmt: skip


def _presets() -> str:
    """Keys of each preset; one that acts on nothing in a scene is left out there."""
    lines = []
    for name, groups in PRESETS.items():
        keys = [f"`{key} = {value}`" for group in groups for key, value in group.keys.items()]
        lines.append(f"- `{name}`: {', '.join(dict.fromkeys(keys))}")
    return "\n".join(lines)


def _scene(path: Path, scene: str, said: str, study: Study) -> str:
    parts = [f"## {scene}", *([said] if said else []), _table(study)]
    parts += _pictures(path, scene, study)
    missing = [f"- {line}".replace(f"{study.folder}/", "") for line in study.without_result()]
    if missing:
        parts.append("\n".join(["Without a result:", "", *missing]))
    return "\n\n".join(parts)


def _table(study: Study) -> str:
    quantities = list(study.judged)
    head = ["setting", "time [s]", "times as fast", *(f"{name} [{study.units[name]}]" for name in quantities)]
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    base = _base(study)
    for ran in _shown(study):
        by_quantity = [{item.setting.name: item for item in study.judged[quantity]} for quantity in quantities]
        errors = [_cell(items[ran.setting.name]) if ran.setting.name in items else "" for items in by_quantity]
        seconds = ran.cpu_seconds
        cells = [ran.setting.accuracy or ran.setting.name, f"{seconds:.3g}", f"{base / seconds:.2g}", *errors]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _shown(study: Study) -> list[Ran]:
    """The settings of the table: as it is, presets, finest."""
    roles = ("base", "preset", "reference")
    return [ran for role in roles for ran in study.rans if ran.done and ran.setting.role == role]


def _base(study: Study) -> float:
    """Processor time of the scene as it is [s]."""
    return next(ran.cpu_seconds for ran in study.rans if ran.setting.role == "base")


def _cell(item: Judged) -> str:
    if item.verdict == "reference":
        return f"{item.value:.5g}" + (f" (own error {percent(item.floor).lstrip('+')})" if item.floor else "")
    mark = {"not resolved": ", not resolved", "below the reference's own error": ", below the reference's own"}
    return percent(item.error, item.error_half_width) + mark.get(item.verdict, "")


def _pictures(path: Path, scene: str, study: Study) -> list[str]:
    """Copy the fronts of a study that turned knobs beside the page."""
    if not any(ran.setting.role == "knob" for ran in study.rans):
        return []
    shown = []
    for quantity in study.judged:
        target = path.with_name(f"accuracy_{scene}_{quantity}.png")
        shutil.copyfile(study.folder / f"pareto_{quantity}.png", target)
        shown.append(f"![{target.name}]({target.name})")
    return shown


def _draw(path: Path, done: Sequence[Done]) -> None:
    """Every preset of every scene and quantity: error against relative time."""
    figure, axes = plt.subplots(figsize=(8.0, 4.8), layout="constrained")
    for _, _, study in done:
        base = _base(study)
        for item in (item for items in study.judged.values() for item in items if item.setting.role == "preset"):
            colour, marker = STYLE[item.setting.accuracy]
            sure = item.verdict == "resolved"
            height = max(item.known, 1e-7)
            fill = colour if sure else "white"
            axes.plot(item.ran.cpu_seconds / base, height, marker, color=colour, mfc=fill, ms=6)
    axes.set(
        xscale="log", yscale="log", xlabel="time over that of the scene as it is [-]", ylabel="error [-]",
        title=f"Presets on {len(done)} scenes that ship",
    )  # fmt: skip
    axes.xaxis.set_major_formatter(PLAIN)
    axes.xaxis.set_minor_formatter(PLAIN)
    axes.xaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    axes.axvline(1.0, color="0.7", lw=0.8)
    axes.grid(True, which="major", color="0.92")
    handles = [
        Line2D([], [], color=colour, marker=marker, ls="none", label=name) for name, (colour, marker) in STYLE.items()
    ]
    axes.legend(handles=handles, fontsize=8)
    figure.savefig(path, dpi=130)
    plt.close(figure)
