"""From the folders of finished runs to what a setting came to."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from coupled.campaign import Outcome
from coupled.errors import QuantityError
from coupled.output import history
from coupled.output.folder import SCENE, SUMMARY
from coupled.quantities import evaluate
from coupled.study.settings.setting import Ran, Setting


def came_to(setting: Setting, outcomes: Sequence[Outcome], base: Sequence[Path] | None) -> Ran:
    """Collect the samples of one setting.

    Parameters
    ----------
    setting : Setting
    outcomes : sequence of Outcome
        One per seed.
    base : sequence of Path, optional
        Folders of the base's samples, for a setting that must have the same bits.
    """
    for outcome in outcomes:
        if outcome.status != "done":
            begun = (outcome.task.folder / SCENE).exists()
            status = outcome.status if begun else "refused"
            return Ran(setting=setting, status=status, message=outcome.message)
    folders = [outcome.task.folder for outcome in outcomes]
    values, lacking = _values(outcomes)
    if not values:
        return Ran(setting=setting, status="failed", message=lacking)
    count = len(outcomes)
    wall = sum(outcome.wall_seconds for outcome in outcomes) / count
    steps = sum(json.loads((folder / SUMMARY).read_text())["steps"] for folder in folders) / count
    return Ran(
        setting=setting,
        status="done",
        message=lacking,
        values=values,
        wall_seconds=wall,
        cpu_seconds=sum(outcome.cpu_seconds for outcome in outcomes) / count,
        steps_per_second=steps / wall if wall > 0.0 else float("inf"),
        same_bits=None if base is None else all(map(_same_rows, folders, base)),
    )


def _values(outcomes: Sequence[Outcome]) -> tuple[dict[str, tuple[float, ...]], str]:
    """Quantities that every sample has, and why others are missing, a sentence each."""
    values, why = {}, []
    for quantity in outcomes[0].task.scene.quantities:
        try:
            values[quantity.name] = tuple(evaluate(quantity, outcome.task.folder) for outcome in outcomes)
        except QuantityError as error:
            why.append(str(error))
    return values, "; ".join(why)


def _same_rows(one: Path, other: Path) -> bool:
    """Whether two histories have the same rows, to the last digit; they are written exactly."""
    return (one / history.NAME).read_bytes() == (other / history.NAME).read_bytes()
