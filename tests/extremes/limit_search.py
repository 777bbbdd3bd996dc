"""Where the outcome changes along an axis."""

from __future__ import annotations

import math
from pathlib import Path

from leito_process import LeitoProcess
from trials import Axis
from verdict import GOOD, Verdict, judge


def walk(axis: Axis, leito: LeitoProcess, folder: Path) -> list[Verdict]:
    """Verdicts at all values of an axis, and at those that close in on the places where the outcome changes."""
    found = [judge(axis, value, leito, folder) for value in axis.values]
    if axis.sharpen is None:
        return found
    walked = found[:1]
    for after in found[1:]:
        walked += [*_between(axis, walked[-1], after, leito, folder), after]
    return walked


def _between(axis: Axis, low: Verdict, high: Verdict, leito: LeitoProcess, folder: Path) -> list[Verdict]:
    """The two verdicts on either side of the change, where these differ; none that are known already."""
    ends = (low, high)
    while low.outcome != high.outcome and high.value > axis.sharpen * low.value:
        middle = judge(axis, math.sqrt(low.value * high.value), leito, folder)
        low, high = (middle, high) if middle.outcome == low.outcome else (low, middle)
    return [verdict for verdict in (low, high) if verdict not in ends]


def ranges(verdicts: list[Verdict], axis: Axis, outcome: str) -> str:
    """Runs of successive values with an outcome, in words; their number where values are words themselves."""
    if isinstance(verdicts[0].value, str):
        return f"{sum(verdict.outcome == outcome for verdict in verdicts)} of {len(verdicts)}"
    runs: list[list[Verdict]] = []
    for before, verdict in zip([None, *verdicts], verdicts, strict=False):
        if verdict.outcome == outcome:
            if before is None or before.outcome != outcome:
                runs.append([])
            runs[-1].append(verdict)
    shown = [[axis.show(verdict.value) for verdict in run] for run in runs]
    return ", ".join(run[0] if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in shown) or "-"


def defects(verdicts: list[Verdict]) -> list[Verdict]:
    """Those that must not be."""
    return [verdict for verdict in verdicts if verdict.outcome not in GOOD]
