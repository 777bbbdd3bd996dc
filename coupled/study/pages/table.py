"""The study as rows: study.csv, and the short table of a terminal."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from coupled.study.judging.errors import Judged
from coupled.study.judging.front import front_of
from coupled.study.judging.reference import Reference
from coupled.study.settings.setting import Ran

CSV = "study.csv"
COLUMNS = (
    "setting", "role", "knobs", "quantity", "unit", "value", "half_width", "samples", "reference", "error",
    "error_half_width", "own_error_of_reference", "verdict", "on_front", "wall_s", "cpu_s", "steps_per_s", "same_bits",
    "status", "message",
)  # fmt: skip


def write_csv(
    path: Path,
    rans: Sequence[Ran],
    judged: Mapping[str, Sequence[Judged]],
    references: Mapping[str, Reference],
    units: Mapping[str, str],
) -> None:
    """Write one row per setting and quantity, and one for each setting without values, in one move.

    Errors, half widths of errors and the reference's own error are over the reference's scale [-].
    """
    beside = path.with_suffix(".part")
    with open(beside, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="")
        writer.writeheader()
        for name, items in judged.items():
            front = front_of(items)
            for item in items:
                writer.writerow(_row(item, references[name], units[name], item in front))
        for ran in rans:
            if not ran.done:
                writer.writerow(_named(ran))
    os.replace(beside, path)


def _named(ran: Ran) -> dict[str, object]:
    knobs = "; ".join(f"{knob}={value}" for knob, value in ran.setting.knobs)
    about = {"setting": ran.setting.name, "role": ran.setting.role, "knobs": knobs}
    return about | {"status": ran.status, "message": ran.message}


def _row(item: Judged, reference: Reference, unit: str, on_front: bool) -> dict[str, object]:
    ran = item.ran
    return _named(ran) | {
        "quantity": item.quantity, "unit": unit, "value": item.value, "half_width": item.half_width,
        "samples": len(ran.values[item.quantity]), "reference": reference.mean, "error": item.error,
        "error_half_width": item.error_half_width, "own_error_of_reference": item.floor, "verdict": item.verdict,
        "on_front": on_front, "wall_s": ran.wall_seconds, "cpu_s": ran.cpu_seconds, "steps_per_s": ran.steps_per_second,
        "same_bits": "" if ran.same_bits is None else ran.same_bits,
    }  # fmt: skip


HEADER = ("quantity", "setting", "value", "error", "", "wall s", "front")


def rows(judged: Mapping[str, Sequence[Judged]], units: Mapping[str, str]) -> list[tuple[str, ...]]:
    """Rows for a terminal, each quantity from fast to slow; a star marks the front."""
    found = []
    for name, items in judged.items():
        front = front_of(items)
        for item in sorted(items, key=lambda item: item.ran.wall_seconds):
            error = percent(item.error, item.error_half_width)
            verdict = "" if item.verdict == "resolved" else item.verdict
            star = "*" if item in front else ""
            first = (f"{name} [{units[name]}]", item.setting.name, _value(item))
            found.append((*first, error, verdict, f"{item.ran.wall_seconds:.3g}", star))
    return found


def without_result(rans: Sequence[Ran]) -> list[str]:
    """A line for each setting that was refused, failed, stopped or left out, or lacks some quantities."""
    return [f"{ran.setting.name}: {ran.lacking}" for ran in rans if ran.lacking]


def _value(item: Judged) -> str:
    return f"{item.value:.6g}" + (f" +- {item.half_width:.2g}" if item.half_width else "")


def percent(error: float, half_width: float = 0.0) -> str:
    """A relative error in percent, with two digits of what is known."""
    if math.isnan(error):
        return ""
    text = f"{100.0 * error:+.2g}"
    return text + (f" +- {100.0 * half_width:.2g} %" if half_width else " %")
