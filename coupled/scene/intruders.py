"""Table of the intruders."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from coupled.scene.types import Number, Positive, Table

MIDDLE = "middle"


def _place_kind(place: Any) -> str:
    return "<middle>" if isinstance(place, str) else "<number>"


Place = Annotated[
    Annotated[Number, Tag("<number>")] | Annotated[Literal["middle"], Tag("<middle>")], Discriminator(_place_kind)
]


class Intruder(Table):
    """A free grain of its own size and density, whose path the history tells."""

    name: Annotated[str, Field(min_length=1)] | None = Field(
        None, description="name of its material in the contact law; absent: that of the free grains"
    )
    radius: Positive = Field(description="radius [m]")
    density: Positive = Field(description="mass per volume [kg/m3]")
    x: Place = Field(MIDDLE, description="centre at the start [m], or that of the box")
    y: Place = Field(MIDDLE, description="centre at the start [m], or that of the other grains")

    @property
    def mass(self) -> float:
        """Mass ``pi r^2 rho`` [kg/m]."""
        return math.pi * self.radius**2 * self.density
