"""What is said of a run that goes wrong."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

FARTHEST_STEP = 0.5  # of its radius that a grain in contact may go in a step, or the structure of the smallest one's

Remedy = Literal["step", "contact", "exchange", "structure", "deformation", "wall", "inside"]


@dataclass(frozen=True)
class Sign:
    """What is wrong, with its place and value, and what to change about it.

    Attributes
    ----------
    largest_step : float
        Largest time step that would not have shown it, over the present one, where that is known to be smaller.
    """

    what: str
    remedy: Remedy
    largest_step: float = 1.0
