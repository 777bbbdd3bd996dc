"""Where the intruders of a scene stand at the start."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from coupled.scene.intruders import MIDDLE

if TYPE_CHECKING:
    from coupled.scene.grains import Box, Grains
    from coupled.scene.intruders import Intruder


def places_of(intruders: tuple[Intruder, ...], grains: Grains, box: Box) -> list[tuple[float, float]]:
    """Centres [m] of the intruders among grains that a scene lays out."""
    middle = _middle_of_list(grains) if grains.layout == "list" else _middle_of_lattice(intruders, grains, box)
    return [
        (
            0.5 * box.width if intruder.x == MIDDLE else intruder.x,
            max(middle, intruder.radius) if intruder.y == MIDDLE else intruder.y,
        )
        for intruder in intruders
    ]


def _middle_of_list(grains: Grains) -> float:
    heights = [row[1] for row in grains.positions]
    return 0.5 * (min(heights) + max(heights))


def _middle_of_lattice(intruders: tuple[Intruder, ...], grains: Grains, box: Box) -> float:
    """Half the height [m] of grains on a lattice and the intruders among them."""
    pitch = 2.0 * grains.largest_radius * grains.spacing
    columns = max(int(box.width / pitch + 1e-9), 1)
    taken = sum(math.pi * intruder.radius**2 for intruder in intruders)
    return 0.5 * (grains.count * pitch / columns + taken / box.width)
