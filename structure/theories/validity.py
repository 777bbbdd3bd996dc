"""How far each theory goes, and what is said of a result beyond that."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from structure.theories.theory import TheoryName


class Limit(NamedTuple):
    """A quantity, the largest magnitude up to which a theory is to be trusted, what is said above it, and the
    magnitude above which its result means nothing."""

    quantity: str
    largest: float
    said: str
    meaningless: float = math.inf


SMALL_STRAIN = Limit(
    "max_strain",
    0.02,
    "largest strain {:.3g} leaves the small-strain theory (up to {:g}): distrust the stresses",
    1.0,
)
LIMITS: dict[TheoryName, tuple[Limit, ...]] = {
    "linear": (
        SMALL_STRAIN,
        Limit(
            "rotation",
            0.1,
            "the structure has turned by {:.3g} rad, which the linear theory does not follow (up to {:g}): "
            'take theory "corotational"',
            0.5,  # by then it has grown by 14 %
        ),
    ),
    "corotational": (
        SMALL_STRAIN,
        Limit(
            "local_rotation",
            0.1,
            "parts of the structure have turned by {:.3g} rad against its frame, which the corotational theory does "
            'not follow (up to {:g}): take theory "large_strain"',
            1.0,
        ),
    ),
    "large_strain": (
        Limit(
            "compression",
            0.4,
            "the material is compressed by {:.3g} of its length, where the St Venant-Kirchhoff law softens (reliable "
            "up to {:g}): distrust the result",
        ),
    ),
}


def departures(theory: TheoryName, numbers: Mapping[str, float]) -> dict[str, str]:
    """Sentences, by quantity, on numbers that leave the range of a theory.

    Parameters
    ----------
    theory
        The theory in use.
    numbers
        "rotation" [rad] of the body, "max_strain", "local_rotation" [rad], "compression"; those that are
        missing are not looked at.
    """
    return {
        limit.quantity: limit.said.format(abs(numbers[limit.quantity]), limit.largest)
        for limit in LIMITS[theory]
        if abs(numbers.get(limit.quantity, 0.0)) > limit.largest
    }


def beyond_meaning(theory: TheoryName, numbers: Mapping[str, float]) -> str | None:
    """What is said where numbers, as in `departures`, are so far outside a theory that going on means nothing."""
    said = departures(theory, numbers)
    for limit in LIMITS[theory]:
        if abs(numbers.get(limit.quantity, 0.0)) > limit.meaningless:
            return said[limit.quantity]
    return None
