"""Rigid walls: half planes that may move."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from particles.errors import ParticleError, require

SIDES = ("left", "right", "floor", "lid")


@dataclass(frozen=True, kw_only=True)
class Wall:
    """A half plane; grains stay on the side to which `normal` points.

    Parameters
    ----------
    point : (2,) floats
        Any point of the wall [m].
    normal : (2,) floats
        Towards the grains; normalised here.
    velocity : (2,) floats
        Constant velocity of the wall [m/s].
    material : int
        Row of a `ContactTable`.
    name : str
        For messages and tables.
    shaken : bool
        Whether it takes part in the `Shaking` of its system.
    """

    point: tuple[float, float]
    normal: tuple[float, float]
    velocity: tuple[float, float] = (0.0, 0.0)
    material: int = 0
    name: str = "wall"
    shaken: bool = False

    def __post_init__(self) -> None:
        for label, value in (("point", self.point), ("normal", self.normal), ("velocity", self.velocity)):
            for number in value:
                require(f"{self.name} {label}", number)
        if not np.hypot(*self.normal) > 0.0:
            raise ParticleError(f"{self.name} normal must not be zero: give the direction towards the grains")

    @property
    def unit_normal(self) -> tuple[float, float]:
        length = float(np.hypot(*self.normal))
        return (self.normal[0] / length, self.normal[1] / length)


def box(width: float, height: float, sides: Sequence[str] = ("left", "right", "floor")) -> list[Wall]:
    """Walls of a box [m] whose lower left corner is the origin; `sides` among left, right, floor, lid."""
    require("box width", width, above=0.0)
    require("box height", height, above=0.0)
    places = {
        "left": ((0.0, 0.0), (1.0, 0.0)),
        "right": ((width, 0.0), (-1.0, 0.0)),
        "floor": ((0.0, 0.0), (0.0, 1.0)),
        "lid": ((0.0, height), (0.0, -1.0)),
    }
    for side in sides:
        if side not in places:
            raise ParticleError(f"box side {side!r} must be one of {', '.join(SIDES)}")
    return [Wall(point=places[side][0], normal=places[side][1], name=side) for side in sides]
