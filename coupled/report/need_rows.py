"""Rows of `leito check`: what a scene models, leaves out and models without need, with shares of the cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from coupled.report.modelled import leaves_out, models
from coupled.report.needs import Needless
from coupled.report.paired import Measured
from coupled.report.shares import Trial, shares
from coupled.scene import Scene

Row = tuple[str, str, str]
LEAST = 0.005  # share that is told in percent


def need_rows(scene: Scene, needless: Sequence[Needless], trial: Trial, measured: Mapping[str, Measured]) -> list[Row]:
    """Rows (section, quantity, value).

    Parameters
    ----------
    scene : Scene
        With its step.
    needless : sequence of Needless
    trial : Trial
        Times of the parts of a step.
    measured : mapping
        Shares from paired runs, by feature; may be empty.
    """
    share = shares(scene, trial)
    named = dict.fromkeys([*models(scene), *share])
    rows = [("models", name, _told(share.get(name), measured.get(name))) for name in named]
    rows.append(("leaves out", "", ", ".join(leaves_out(scene)) or "nothing"))
    for found in needless:
        cost = share.get(found.feature) if found.feature is not None else None
        rows.append(("without need", found.key, found.why + ("" if cost is None else f" ({_percent(cost)})")))
    return rows


def _told(share: float | None, measured: Measured | None) -> str:
    said = "no cost of its own" if share is None else f"{_percent(share)} of the time"
    if measured is None:
        return said
    return f"{said}; measured {_percent(measured.share)} ({_percent(measured.low)} to {_percent(measured.high)})"


def _percent(share: float) -> str:
    return "below 1 %" if 0.0 <= share < LEAST else f"{100.0 * share:.0f} %"
