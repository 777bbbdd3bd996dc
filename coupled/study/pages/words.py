"""study.md: what a study says, in a few lines."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from coupled.study.judging.errors import Judged, observed_order
from coupled.study.judging.front import beaten_by, front_of, price
from coupled.study.judging.reference import EXACT, Reference
from coupled.study.pages.table import percent, without_result
from coupled.study.settings.knob import Knob
from coupled.study.settings.setting import Ran
from coupled.study.settings.turns import Value

LOADED = 0.1  # of the wall time that the processor did not work: told
OPEN = ("not resolved", "one sample")
SHORT = 0.5  # seconds of a run below which its time is mostly noise


@dataclass(frozen=True, kw_only=True)
class Told:
    """All that the text is made of."""

    title: str
    seeds: tuple[int, ...]
    rans: Sequence[Ran]
    judged: Mapping[str, Sequence[Judged]]
    references: Mapping[str, Reference]
    units: Mapping[str, str]
    knobs: Mapping[Knob, Value]
    pictures: Mapping[str, Path]


def text_of(told: Told) -> str:
    """The text, in Markdown."""
    parts = [f"# {told.title}", "", *_about(told)]
    for name, items in told.judged.items():
        parts += ["", f"## {name} [{told.units[name]}]", "", _of_reference(told.references[name], told.units[name])]
        parts += ["", f"![{name}]({told.pictures[name].name})", "", *_front(items), "", *_knobs(told.knobs, items)]
        parts += [*_dominated(items), *_open(items)]
    return "\n".join([*parts, *_speed_only(told), *_not_done(told), *_load(told)]) + "\n"


def _about(told: Told) -> list[str]:
    done = sum(ran.done for ran in told.rans)
    seeds = f", each with the seeds {told.seeds[0]} to {told.seeds[-1]}" if len(told.seeds) > 1 else ""
    return [
        f"{done} settings{seeds}. Times are wall seconds of a run's own work, its bed not counted. An error is the "
        "mean difference from the reference over its magnitude, or over the quantity's `scale`."
        + (" +- is Student's 95 % interval of the differences seed by seed." if len(told.seeds) > 1 else "")
    ]


def _of_reference(reference: Reference, unit: str) -> str:
    if reference.source == EXACT:
        sentence = f"Measured against the closed form {reference.mean:.8g} {unit}."
        if reference.error > 0.0:
            sentence += (
                f" The finest levels go past it: {percent(reference.relative_error).lstrip('+')} is taken for its own "
                "error, assumptions that the scene does not share."
            )
        return sentence
    sentence = f'Measured against the setting "{reference.source}": {reference.mean:.6g} {unit}.'
    if math.isnan(reference.error):
        return f"{sentence} How far that is off itself is not known: there is no coarser level beside it."
    if reference.open:
        return f"{sentence} The level before it cannot be told apart from it by these seeds."
    order = f", from levels that differ with order {reference.order:.1f}" if reference.order is not None else ""
    return f"{sentence} Its own error is about {percent(reference.relative_error).lstrip('+')}{order}."


def _front(items: Sequence[Judged]) -> list[str]:
    lines = ["The front, from fast to accurate:", "", "| setting | error | wall [s] |", "|---|---|---|"]
    for item in front_of(items):
        lines.append(f"| {item.setting.name} | {_claim(item)} | {item.ran.wall_seconds:.3g} |")
    return lines


def _claim(item: Judged) -> str:
    """An error with what is known of it."""
    if item.verdict == "reference":
        return "the reference" + (f", own error {percent(item.floor).lstrip('+')}" if item.floor else "")
    shown = percent(item.error, item.error_half_width)
    return shown if item.verdict == "resolved" else f"{shown} ({item.verdict})"


def _knobs(knobs: Mapping[Knob, Value], items: Sequence[Judged]) -> list[str]:
    """What a digit costs by each knob, the cheapest first."""
    base = [item for item in items if item.setting.role == "base"]
    lines: list[tuple[float, str]] = []
    for knob, scene_value in knobs.items():
        own = [item for item in items if item.setting.role == "knob" and item.setting.knobs[0][0] == knob.name]
        if not own or knob.speed_only or not base:
            continue
        found = price(knob.name, [*base, *own])
        order = _order(knob, scene_value, base, own)
        lines.append(
            (found.seconds_per_decade, _knob_line(knob, found.coarse, found.fine, found.seconds_per_decade) + order)
        )
    if not lines:
        return []
    return [
        "Price of accuracy by knob, the rest as in the scene, the cheapest first:",
        "",
        *(f"- {line}" for _, line in sorted(lines)),
        "",
    ]


def _knob_line(knob: Knob, coarse: Judged, fine: Judged, seconds: float) -> str:
    if coarse.verdict in OPEN:
        return f"`{knob.name}` ({knob.meaning}): nothing resolved; fastest is {_at(coarse)}"
    if math.isinf(seconds):
        return f"`{knob.name}` ({knob.meaning}): buys no accuracy here; fastest is {_at(coarse)}"
    return (
        f"`{knob.name}` ({knob.meaning}): {seconds:.2g} s per decade of error, from {_claim(coarse)} {_at(coarse)} to "
        f"{_claim(fine)} {_at(fine)}"
    )


def _at(item: Judged) -> str:
    value = "as it is" if item.setting.role == "base" else f"at {item.setting.knobs[0][1]}"
    return f"{value} ({item.ran.wall_seconds:.2g} s)"


def _order(knob: Knob, scene_value: Value, base: Sequence[Judged], own: Sequence[Judged]) -> str:
    if not knob.falls or any(item.verdict in OPEN for item in (*base, *own)):
        return ""
    pairs = [(float(item.setting.knobs[0][1]), item.value) for item in own]
    if scene_value:
        pairs += [(float(scene_value), item.value) for item in base]
    order = observed_order(pairs)
    return "" if order is None else f"; order {order:.2f}"


def _dominated(items: Sequence[Judged]) -> list[str]:
    lines = []
    for item in items:
        told = item.verdict in ("resolved", "below the reference's own error")
        better = beaten_by(item, items) if told else None
        if better is not None:
            lines.append(f'- "{item.setting.name}" by "{better.setting.name}"')
    return ["Dominated, another setting is faster and not less accurate:", "", *lines, ""] if lines else []


def _open(items: Sequence[Judged]) -> list[str]:
    lines = []
    for verdict in ("not resolved", "below the reference's own error", "one sample"):
        names = [f'"{item.setting.name}"' for item in sorted(items, key=_wall) if item.verdict == verdict]
        if names:
            lines.append(f"- {verdict}, from fast to slow: {', '.join(names)}")
    return ["Not told apart from the reference:", "", *lines, ""] if lines else []


def _wall(item: Judged) -> float:
    return item.ran.wall_seconds


def _speed_only(told: Told) -> list[str]:
    """Knobs that must change the speed alone."""
    lines = []
    for ran in told.rans:
        if ran.same_bits is not None:
            what = "the same bits as" if ran.same_bits else "NOT the same bits as"
            lines.append(f"- {ran.setting.name}: {what} the scene as it is, {ran.wall_seconds:.3g} s")
    if not lines:
        return []
    differs = any(ran.same_bits is False for ran in told.rans)
    why = ["", "Sums in another order change bits, and in many grains all of them; what that does is among the errors."]
    return ["", "## Speed only", "", *lines, *(why if differs else [])]


def _not_done(told: Told) -> list[str]:
    lines = [f"- {line}" for line in without_result(told.rans)]
    return ["", "## Without a result", "", *lines] if lines else []


def _load(told: Told) -> list[str]:
    done = [ran for ran in told.rans if ran.done]
    lines = []
    idle = [ran for ran in done if abs(ran.wall_seconds - ran.cpu_seconds / _busy(ran)) > LOADED * ran.wall_seconds]
    if idle:
        lines.append(
            f"- Wall and processor time of {len(idle)} of {len(done)} settings differ by more than "
            f"{100 * LOADED:.0f} %: the machine was at work for others too, or waited for its disk. Take their times "
            "with care; `cpu_s` in study.csv is the other one."
        )
    short = sum(ran.wall_seconds < SHORT for ran in done)
    if short:
        lines.append(
            f"- {short} settings took less than {SHORT:g} s: their times are known to some ten percent at best."
        )
    return ["", "## Times", "", *lines] if lines else []


def _busy(ran: Ran) -> float:
    """Cores that a run keeps busy, as far as is known."""
    return float(ran.setting.threads)
