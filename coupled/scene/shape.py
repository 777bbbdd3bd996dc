"""Tables of the two shapes that structures have, with what their boundaries measure."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from coupled.scene.types import Count, Positive, Table

LOADED_ARC = math.radians(120.0)


class _Shape(Table):
    """What every meshed shape has."""

    cell: Literal["quadrilateral", "triangle"] = Field("quadrilateral", description="cell shape")
    order: Literal[1, 2] = Field(1, description="polynomial order of the elements")


class Tube(_Shape):
    """A ring; boundary `loaded_arc` is its upper 120 degrees, `free_arc` the rest of `outer`."""

    boundaries: ClassVar[tuple[str, ...]] = ("outer", "inner", "loaded_arc", "free_arc")
    glueable: ClassVar[tuple[str, ...]] = ("outer", "loaded_arc")

    outer_radius: Positive = Field(description="outer radius [m]")
    inner_radius: Positive = Field(description="inner radius [m]")
    around: Annotated[Count, Field(ge=6)] = Field(30, description="elements around")
    layers: Count = Field(2, description="elements through the wall")

    @property
    def half_extent(self) -> tuple[float, float]:
        """Half width and half height [m]."""
        return self.outer_radius, self.outer_radius

    def facet_lengths(self, boundary: str) -> tuple[float, ...]:
        """Return the facet lengths of ``outer`` or ``loaded_arc`` between successive nodes [m]."""
        facets = self.around * self.order
        chord = 2 * self.outer_radius * math.sin(math.pi / facets)
        if boundary == "outer":
            return (chord,) * facets
        step = 2 * math.pi / self.around
        from_top = [(k + 0.5) * step - math.pi for k in range(self.around)]
        loaded = sum(abs(angle) < LOADED_ARC / 2 for angle in from_top)
        return (chord,) * (loaded * self.order)


class Beam(_Shape):
    """A rectangle."""

    boundaries: ClassVar[tuple[str, ...]] = ("outer", "top", "bottom", "left", "right")
    glueable: ClassVar[tuple[str, ...]] = boundaries

    length: Positive = Field(description="length along x [m]")
    height: Positive = Field(description="height along y [m]")
    along: Count = Field(40, description="elements along the length")
    across: Count = Field(2, description="elements through the height")

    @property
    def half_extent(self) -> tuple[float, float]:
        """Half width and half height [m]."""
        return self.length / 2, self.height / 2

    def facet_lengths(self, boundary: str) -> tuple[float, ...]:
        """Return the facet lengths of a boundary between successive nodes [m]."""
        along, across = self.along * self.order, self.across * self.order
        face = (self.length / along,) * along
        end = (self.height / across,) * across
        if boundary in ("top", "bottom"):
            return face
        if boundary in ("left", "right"):
            return end
        return face + end + face + end


Shape = Tube | Beam
