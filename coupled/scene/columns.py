"""Factors against time out of a CSV file that a scene names."""

from __future__ import annotations

from math import isfinite
from pathlib import Path
from typing import Any

from coupled.scene.refusal import refusal

COLUMNS = "two columns, time [s] and factor [-], with a comma between them"


def read_schedules(scene: dict[str, Any], folder: Path) -> None:
    """Put the numbers of each ``schedule.file`` into the tables of a scene, in place of its name.

    What is not of the expected type stays as it is, for the check of types.

    Parameters
    ----------
    folder
        Folder of the scene file, where the path of a CSV file begins.

    Raises
    ------
    SceneError
        A file that is not there, or a row that is no row.
    """
    structure = scene.get("structure")
    loads = structure.get("loads") if isinstance(structure, dict) else None
    for index, load in enumerate(loads if isinstance(loads, list) else ()):
        schedule = load.get("schedule") if isinstance(load, dict) else None
        if not isinstance(schedule, dict) or schedule.get("kind") != "table":
            continue
        if isinstance(schedule.get("file"), str) and not {"times", "factors"} & schedule.keys():
            key = f"structure.loads.{index}.schedule.file"
            schedule["times"], schedule["factors"] = _read(key, schedule.pop("file"), folder)


def _read(key: str, name: str, folder: Path) -> tuple[list[float], list[float]]:
    try:
        lines = (folder / name).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is not text in UTF-8"
        raise refusal(key, name, f"cannot be read ({reason}); give a CSV file beside the scene") from None
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(lines, start=1):
        cells = [cell.strip() for cell in line.partition("#")[0].split(",")]
        if cells == [""]:
            continue
        if len(cells) != 2:
            raise refusal(key, name, f"has {_count(len(cells), 'column')} in line {number}; give {COLUMNS}")
        values = [_number(cell) for cell in cells]
        if values == [None, None] and not rows:
            continue  # names of the columns
        for cell, value in zip(cells, values, strict=True):
            if value is None or not isfinite(value):
                raise refusal(key, name, f'has "{cell}" in line {number}, which is no finite number; mend it')
        if rows and values[0] <= rows[-1][0]:
            raise refusal(
                key,
                name,
                f"has the time {values[0]:g} s in line {number} after {rows[-1][0]:g} s; let the times increase",
            )
        rows.append((values[0], values[1]))
    if len(rows) < 2:
        raise refusal(key, name, f"has {_count(len(rows), 'row')} of numbers; give at least 2, in {COLUMNS}")
    times, factors = zip(*rows, strict=True)
    return list(times), list(factors)


def _number(cell: str) -> float | None:
    """The number in a cell, or None."""
    try:
        return float(cell)
    except ValueError:
        return None


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"
