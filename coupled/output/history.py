"""history.csv: one row per interval, names with units in the header."""

from __future__ import annotations

import csv
import math
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

NAME = "history.csv"


class History:
    """Rows of numbers against time, flushed as they come; `last_time` [s] is that of the last one.

    Parameters
    ----------
    path : Path
    keep_until : float, optional
        Go on in an existing file: keep its rows up to this time [s] and drop those after it, which
        a killed run had written since its checkpoint.
    """

    def __init__(self, path: Path, *, keep_until: float | None = None) -> None:
        self.path = path
        self._names: list[str] = []
        self.last_time = -math.inf
        if keep_until is not None and path.exists():
            self._keep(keep_until)

    def _keep(self, until: float) -> None:
        with open(self.path, newline="") as file:
            rows = [row for row in csv.reader(file)]
        if not rows:
            return
        self._names = [_bare(name) for name in rows[0]]
        # times are written exactly (shortest repr), the margin only covers a cut last row
        whole = [row for row in rows[1:] if len(row) == len(rows[0]) and float(row[0]) <= until]
        beside = self.path.with_suffix(".part")
        with open(beside, "w", newline="") as file:
            csv.writer(file).writerows([rows[0], *whole])
        os.replace(beside, self.path)
        self.last_time = float(whole[-1][0]) if whole else -math.inf

    def write(self, row: dict[str, float]) -> None:
        """Append a row; the first one makes the header. Columns have their names, whatever the units beside them."""
        new = not self._names
        with open(self.path, "w" if new else "a", newline="") as file:
            writer = csv.writer(file)
            if new:
                writer.writerow(row)
            values = {_bare(name): float(value) for name, value in row.items()}
            self._names = self._names or list(values)
            writer.writerow([repr(values[name]) for name in self._names])
        self.last_time = values[self._names[0]]


def read_history(path: Path) -> dict[str, NDArray[np.float64]]:
    """Columns of a history by name without the unit."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    table = np.array(rows[1:], dtype=float).reshape(-1, len(rows[0]))
    return {_bare(name): column for name, column in zip(rows[0], table.T, strict=True)}


def _bare(name: str) -> str:
    """A name without its unit."""
    return name.partition(" [")[0]
