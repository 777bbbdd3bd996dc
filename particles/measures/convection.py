"""Convection: how far grains go in one period of shaking, averaged in cells."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from particles.errors import ParticleError
from particles.measures.cells import Cells
from particles.state import Floats


class Convection(NamedTuple):
    """Mean displacement per period in cells.

    Attributes
    ----------
    displacement : (rows, columns, 2)
        Mean over the grains and periods [m]; not a number where no grain has passed.
    count : (rows, columns)
        Displacements it is over.
    roll : (periods,)
        Of each period, rise in the middle half of the columns less rise in the outer half [m]: positive where
        grains rise in the middle and sink along the sides; not a number where either has none.
    """

    displacement: Floats
    count: np.ndarray
    roll: Floats


def convection(places: Iterable[Floats], cells: Cells) -> Convection:
    """Mean displacement between successive places (n, 2) [m] of the same grains, taken at one phase of the shaking.

    A displacement belongs to the cell of its middle. Places go on across periodic sides without being folded back, as
    those of the state and of the frames do. One array is held beside the last: any number of periods may follow.

    Raises
    ------
    ParticleError
        With fewer than two arrays, or if their numbers of grains differ.
    """
    total, count, roll = np.zeros((cells.count, 2)), np.zeros(cells.count, np.int64), []
    before: Floats | None = None
    for now in places:
        if before is not None:
            if now.shape != before.shape:
                raise ParticleError(f"{len(now)} places follow {len(before)}: convection needs the same grains")
            middle, step = 0.5 * (now + before), now - before
            cell = cells.number(middle[:, 0], middle[:, 1])
            cell, step = cell[cell >= 0], step[cell >= 0]
            for axis in range(2):
                total[:, axis] += np.bincount(cell, step[:, axis], minlength=cells.count)
            count += np.bincount(cell, minlength=cells.count)
            roll.append(_roll(cell % cells.columns, step[:, 1], cells.columns))
        before = now
    if not roll:
        raise ParticleError("convection needs places at two moments or more, one period apart")
    mean = np.full((cells.count, 2), np.nan)
    mean[count > 0] = total[count > 0] / count[count > 0, None]
    return Convection(cells.shaped(mean), cells.shaped(count), np.array(roll))


def _roll(column: np.ndarray, rise: Floats, columns: int) -> float:
    middle = np.abs(column + 0.5 - 0.5 * columns) < 0.25 * columns
    if middle.all() or not middle.any():
        return float("nan")
    return float(rise[middle].mean() - rise[~middle].mean())
