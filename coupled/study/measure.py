"""From the folders of finished runs to what a setting came to."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from coupled.campaign import Outcome
from coupled.errors import LeitoError
from coupled.output import history
from coupled.output.folder import SCENE, SUMMARY
from coupled.quantities import evaluate
from coupled.scene import Scene
from coupled.study.setting import Ran, Setting


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
    try:
        samples = [_values(outcome.task.scene, outcome.task.folder) for outcome in outcomes]
    except LeitoError as error:
        return Ran(setting=setting, status="failed", message=str(error))
    count = len(outcomes)
    wall = sum(outcome.wall_seconds for outcome in outcomes) / count
    steps = sum(json.loads((folder / SUMMARY).read_text())["steps"] for folder in folders) / count
    return Ran(
        setting=setting,
        status="done",
        values={name: tuple(sample[name] for sample in samples) for name in samples[0]},
        wall_seconds=wall,
        cpu_seconds=sum(outcome.cpu_seconds for outcome in outcomes) / count,
        steps_per_second=steps / wall if wall > 0.0 else float("inf"),
        same_bits=None if base is None else all(map(_same_rows, folders, base)),
    )


def _values(scene: Scene, folder: Path) -> Mapping[str, float]:
    return {quantity.name: evaluate(quantity, folder) for quantity in scene.quantities}


def _same_rows(one: Path, other: Path) -> bool:
    """Whether two histories have the same rows, to the last digit; they are written exactly."""
    return (one / history.NAME).read_bytes() == (other / history.NAME).read_bytes()
