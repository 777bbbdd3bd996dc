"""Cells that deformation has turned inside out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

CORNERS = {"quadrilateral": 4, "triangle": 3}


def first_overturned(places: NDArray[np.float64], cells: NDArray[np.int64], kind: str) -> int | None:
    """Number of the first cell with a corner that no longer turns to the left, None without any.

    At such a corner the map from the reference cell folds over: the material there has less than no volume, whatever
    the theory says of its strain. Corners alone are looked at, of cells of order 2 as well.

    Parameters
    ----------
    places : (n, 2)
        Present positions of the nodes [m].
    cells : (m, k)
        Nodes of each cell in VTK order, counter-clockwise where they are sound.
    kind : {"quadrilateral", "triangle"}
    """
    corners = places[cells[:, : CORNERS[kind]]]
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    turn = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
    overturned = np.nonzero(~(turn > 0.0).all(axis=1))[0]
    return int(overturned[0]) if len(overturned) else None
