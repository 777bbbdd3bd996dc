"""What a look at the contacts of a system has found."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class ContactLook:
    """The contacts at one moment: energies of the springs [J/m], counts, the deepest overlap.

    `overlap` (n,) [m] is the sum over the contacts of each grain, `contacts` (n,) their number;
    `deepest` is the largest overlap over the smaller radius, at grain `deepest_at`.
    """

    normal_energy: float
    tangential_energy: float
    rolling_energy: float
    count: int
    deepest: float
    deepest_at: int
    overlap: NDArray[np.float64]
    contacts: NDArray[np.int64]
