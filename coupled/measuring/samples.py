"""Which runs belong together: samples of one scene that differ in their seeds alone."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from coupled.campaign.statistics import Interval, confidence
from coupled.errors import LeitoError
from coupled.measuring.record import Floats, Record
from coupled.output import history
from coupled.output.folder import SCENE, require_folder

NOT_COMPARED = ("seed", "title", "output", "quantities")  # keys that make no other scene


@dataclass(frozen=True)
class Group:
    """Samples of one scene under a name."""

    label: str
    records: tuple[Record, ...]


def groups_of(folders: Sequence[Path]) -> list[Group]:
    """The runs in folders, those of one scene together, in the order in which they are met.

    A folder is a run, or holds runs at any depth, as that of an ensemble does.

    Raises
    ------
    LeitoError
        If one of them holds no run.
    """
    found: dict[str, list[Record]] = {}
    for folder in folders:
        for place in _runs_in(folder):
            record = Record(place)
            found.setdefault(json.dumps(_without_seeds(record.scene), sort_keys=True), []).append(record)
    groups = [Group(_label(records), tuple(records)) for records in found.values()]
    names = [group.label for group in groups]
    return [
        group if names.count(group.label) == 1 else Group(str(group.records[0].folder), group.records)
        for group in groups
    ]


def _runs_in(folder: Path) -> list[Path]:
    require_folder(folder, "give folders of runs or of an ensemble")
    if (folder / SCENE).exists():
        return [folder]
    found = sorted(path.parent for path in folder.rglob(SCENE) if (path.parent / history.NAME).exists())
    if not found:
        raise LeitoError(f"{folder} holds no run ({SCENE} and {history.NAME}); give folders of runs or of an ensemble")
    return found


def _without_seeds(table: Any) -> Any:
    if isinstance(table, dict):
        return {key: _without_seeds(value) for key, value in table.items() if key not in NOT_COMPARED}
    return [_without_seeds(item) for item in table] if isinstance(table, list) else table


def _label(records: list[Record]) -> str:
    folder = records[0].folder.resolve()
    return folder.parent.name if len(records) > 1 or folder.name.startswith("seed_") else folder.name


def intervals(values: Sequence[Floats]) -> tuple[Floats, Floats, np.ndarray]:
    """Mean, half width of the 95 % interval and number of samples for each of k values (k,), out of the finite ones.

    Where no sample has a number there is none; with one sample the half width is not a number.
    """
    table = np.array(values, float)
    mean, half = np.full(table.shape[1], np.nan), np.full(table.shape[1], np.nan)
    count = np.isfinite(table).sum(axis=0)
    for k in np.nonzero(count)[0]:
        column = table[:, k]
        found = confidence(column[np.isfinite(column)])
        mean[k] = found.mean
        if found.count > 1:
            half[k] = found.half_width
    return mean, half, count


def told(found: Interval) -> dict[str, float | int | None]:
    """An interval for a JSON file; the half width of one sample is null."""
    half = found.half_width if found.count > 1 else None
    return {"mean": found.mean, "half_width": half, "samples": found.count}
