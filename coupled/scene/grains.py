"""Tables of the free grains and of the rigid box around them."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Discriminator, Field, Tag

from coupled.scene.types import Count, Fraction, Number, Positive, Table, Whole

Wall = Literal["left", "right", "floor", "lid"]


class Box(Table):
    """Rigid walls; the lower left corner is the origin."""

    width: Positive = Field(description="inner width of the box [m]")
    height: Positive = Field(description="inner height of the box [m]")
    walls: tuple[Wall, ...] = Field(("left", "right", "floor"), description="sides with a wall")


class SizeClass(Table):
    """Equal grains."""

    radius: Positive = Field(description="grain radius [m]")
    count: Count = Field(description="number of grains of this radius")


class Grains(Table):
    """Free grains laid out at the start of the run."""

    sizes: tuple[SizeClass, ...] = Field(min_length=1, description="radii and counts")
    density: Positive = Field(description="mass of a grain per volume [kg/m3]")
    seed: Whole = Field(1, description="seed of the order of sizes and of the jitter")
    spacing: Annotated[Number, Field(ge=1)] = Field(1.05, description="lattice spacing over the largest diameter [-]")
    jitter: Fraction = Field(0.0, description="random shift as a fraction of the free gap [-]")
    layout: Literal["lattice", "list"] = Field("lattice", description="how grains start")
    positions: tuple[Annotated[tuple[Number, ...], Field(min_length=2, max_length=5)], ...] = Field(
        (), description="rows [x, y, vx, vy, omega] in m, m/s and rad/s, in the order of sizes"
    )

    @property
    def count(self) -> int:
        """Number of grains."""
        return sum(size.count for size in self.sizes)

    @property
    def smallest_radius(self) -> float:
        """Smallest grain radius [m]."""
        return min(size.radius for size in self.sizes)

    @property
    def largest_radius(self) -> float:
        """Largest grain radius [m]."""
        return max(size.radius for size in self.sizes)

    @property
    def smallest_mass(self) -> float:
        """Mass of the smallest grain, ``pi r^2 rho`` [kg/m]."""
        return math.pi * self.smallest_radius**2 * self.density

    def lattice_capacity(self, box: Box) -> int:
        """Return the number of lattice places in ``box``."""
        pitch = self.spacing * 2 * self.largest_radius
        # one part in 1e9 keeps a box of exactly n pitches from losing a column to rounding
        columns = math.floor(box.width / pitch * (1 + 1e-9))
        rows = math.floor(box.height / pitch * (1 + 1e-9))
        return columns * rows


class SettledGrains(Table):
    """Free grains as another scene, the bed, left them at its end."""

    beside: ClassVar[str] = " together with bed"

    bed: Annotated[str, Field(min_length=1)] = Field(description="name or path of the scene that settles the grains")


def _layout_of(data: Any) -> str:
    settled = "bed" in data if isinstance(data, dict) else isinstance(data, SettledGrains)
    return "<settled>" if settled else "<laid out>"


AnyGrains = Annotated[
    Annotated[Grains, Tag("<laid out>")] | Annotated[SettledGrains, Tag("<settled>")],
    Discriminator(_layout_of),
]
