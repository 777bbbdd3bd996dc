"""history.csv: one row per interval, names with units in the header."""

from __future__ import annotations

import csv
import math
import os
import warnings
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
        beside = self.path.with_suffix(".part")
        with open(self.path, newline="") as file, open(beside, "w", newline="") as kept:
            rows, writer = csv.reader(file), csv.writer(kept)
            heading = next(rows, None)
            if heading is None:
                beside.unlink()
                return
            self._names = [_bare(name) for name in heading]
            writer.writerow(heading)
            for row in rows:
                # times are written exactly (shortest repr), the margin only covers a cut last row
                if len(row) == len(heading) and float(row[0]) <= until:
                    writer.writerow(row)
                    self.last_time = float(row[0])
        os.replace(beside, self.path)

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
    """Columns of a history by name without the unit, read into no more memory than some tables of them."""
    with open(path, newline="") as file:
        names = next(csv.reader(file))
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*contained no data")
            table = np.loadtxt(file, delimiter=",", ndmin=2).reshape(-1, len(names))
    return {_bare(name): column for name, column in zip(names, table.T, strict=True)}


def _bare(name: str) -> str:
    """A name without its unit."""
    return name.partition(" [")[0]
