"""Tables of the free grains and of the rigid box around them."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from coupled.scene.intruders import Intruder
from coupled.scene.types import Count, Fraction, Number, Positive, Table, Whole

Wall = Literal["left", "right", "floor", "lid"]
Axis = Literal["x", "y"]
USUAL_WALLS: tuple[Wall, ...] = ("left", "right", "floor")
ACROSS: dict[Axis, tuple[Wall, ...]] = {"x": ("left", "right"), "y": ("floor", "lid")}
Precision = Literal["float64", "float32"]
PRECISION = Field("float64", description="stored forces, masses and contact memories; float32 saves memory and no time")
SKIN_FACTOR = Field(1.0, description="factor on the reach of the contact lists beyond contact [-]: speed alone")
COARSENING = Field(
    None,
    description="factor on all radii [-], with so many fewer grains that a bed fills its box as before; dashpots, the "
    "grains of the bed and glued grains follow",
)


class Box(Table):
    """Rigid walls; the lower left corner is the origin."""

    width: Positive = Field(description="inner width of the box [m]")
    height: Positive = Field(description="inner height of the box [m]")
    walls: tuple[Wall, ...] = Field(USUAL_WALLS, description="sides with a wall")
    periodic: tuple[Axis, ...] = Field((), description="axes along which the box repeats, instead of walls across them")

    @model_validator(mode="before")
    @classmethod
    def _write_walls(cls, data: Any) -> Any:
        """Write the usual walls, without those across a periodic axis."""
        if isinstance(data, dict) and isinstance(data.get("periodic"), (list, tuple)):
            across = [wall for axis in data["periodic"] for wall in ACROSS.get(axis, ())]
            return {"walls": [wall for wall in USUAL_WALLS if wall not in across], **data}
        return data

    @property
    def period(self) -> tuple[float | None, float | None]:
        """Lengths after which x and y repeat [m]."""
        return (self.width if "x" in self.periodic else None, self.height if "y" in self.periodic else None)


class SizeClass(Table):
    """Equal grains, or grains of equally probable radii about a mean."""

    radius: Positive = Field(description="grain radius [m]")
    count: Count = Field(description="number of grains of this radius")
    spread: Annotated[Number, Field(ge=0, lt=1)] = Field(
        0.0, description="radii lie between 1 - spread and 1 + spread of the radius, uniformly [-]"
    )

    @property
    def smallest(self) -> float:
        """Smallest possible radius [m]."""
        return self.radius * (1.0 - self.spread)

    @property
    def largest(self) -> float:
        """Largest possible radius [m]."""
        return self.radius * (1.0 + self.spread)


class Grains(Table):
    """Free grains laid out at the start of the run."""

    sizes: tuple[SizeClass, ...] = Field(min_length=1, description="radii and counts")
    density: Positive = Field(description="mass of a grain per volume [kg/m3]")
    seed: Whole = Field(1, description="seed of the order of sizes and of the jitter")
    spacing: Annotated[Number, Field(ge=1)] = Field(1.05, description="lattice spacing over the largest diameter [-]")
    jitter: Fraction = Field(0.0, description="random shift as a fraction of the free gap [-]")
    layout: Literal["lattice", "list"] = Field("lattice", description="how grains start")
    coarsening: Positive | None = COARSENING
    precision: Precision = PRECISION
    skin_factor: Positive = SKIN_FACTOR
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
        return min(size.smallest for size in self.sizes)

    @property
    def largest_radius(self) -> float:
        """Largest grain radius [m]."""
        return max(size.largest for size in self.sizes)

    @property
    def smallest_mass(self) -> float:
        """Mass of the smallest grain, ``pi r^2 rho`` [kg/m]."""
        return math.pi * self.smallest_radius**2 * self.density

    def lattice_capacity(self, box: Box, intruders: tuple[Intruder, ...] = ()) -> int:
        """Return the number of lattice places in ``box``, at least, that intruders leave."""
        pitch = self.spacing * 2 * self.largest_radius
        # one part in 1e9 keeps a box of exactly n pitches from losing a column to rounding
        columns = math.floor(box.width / pitch * (1 + 1e-9))
        rows = math.floor(box.height / pitch * (1 + 1e-9))
        taken = sum((math.ceil(2 * intruder.radius / pitch) + 1) ** 2 for intruder in intruders)
        return max(columns * rows - taken, 0)


class SettledGrains(Table):
    """Free grains as another scene, the bed, left them at its end."""

    beside: ClassVar[str] = " together with bed"

    bed: Annotated[str, Field(min_length=1)] = Field(description="name or path of the scene that settles the grains")
    coarsening: Positive | None = COARSENING
    precision: Precision = PRECISION
    skin_factor: Positive = SKIN_FACTOR


def _layout_of(data: Any) -> str:
    settled = "bed" in data if isinstance(data, dict) else isinstance(data, SettledGrains)
    return "<settled>" if settled else "<laid out>"


AnyGrains = Annotated[
    Annotated[Grains, Tag("<laid out>")] | Annotated[SettledGrains, Tag("<settled>")],
    Discriminator(_layout_of),
]
