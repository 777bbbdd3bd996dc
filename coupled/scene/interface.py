"""Tables of the interface and of the rows of fixed grains."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Discriminator, Field, Tag

from coupled.scene.shape import Shape
from coupled.scene.types import Count, Flag, Positive, Table, Vector

RowName = Annotated[str, Field(min_length=1)] | None
ROW_NAME = Field(None, description="name of its material in the contact law; absent: that of the free grains")

SHAKEN = Field(None, description="whether the row moves with [shaking]; absent: it does where there is one")


class Interface(Table):
    """The door between both physics: grains glued to the boundary of the structure, or its facets themselves.

    Facets need nothing more than the boundaries. What is said of glued grains may stay in a scene
    with facets, so that one key changes the interface; rows `under` a boundary take their number from it.
    """

    kind: Literal["glued", "facets"] = Field(
        "glued", description="what grains meet: grains on the boundary, or its facets"
    )
    per_facet: Count | None = Field(None, description="glued grains per facet: one on each node, the others between")
    count: Count | None = Field(None, description="glued grains in all, instead of per_facet")
    diameter: Positive | None = Field(None, description="diameter of a glued grain [m]; absent: the smallest spacing")
    boundaries: tuple[str, ...] = Field(("outer",), min_length=1, description="boundaries that meet grains")
    velocity: Literal["shape", "mean"] = Field(
        "shape", description="velocity of a glued grain: interpolated, or the facet's mean (G)"
    )
    couple: bool = Field(
        True, description="give the torque of a glued grain to its nodes as a couple; false drops it (G)"
    )
    exchange: Literal["predicted", "lagged", "iterated"] = Field(
        "predicted",
        description="order of the exchange: predicted interface, G's lagged order, or iterated until both sides agree",
    )
    tolerance: Positive | None = Field(
        None, description="iterated: largest change of the boundary by a further iteration, over its motion in the step"
    )
    iterations: Count | None = Field(None, description="iterated: most iterations per step of the structure")
    substeps: Count = Field(1, description="grain steps per step of the structure")
    largest_stiffness_ratio: Positive | None = Field(
        None, description="stiffness ratio r above which a run is refused [-]"
    )

    def facet_lengths(self, shape: Shape) -> tuple[float, ...]:
        """Return the lengths of all facets that meet grains [m]."""
        return sum((shape.facet_lengths(name) for name in self.boundaries), ())

    def grains_per_facet(self, shape: Shape) -> int:
        """Return the number of glued grains per facet, derived from `count` when that is given.

        A closed boundary has as many first nodes as facets, an open one has one more node.
        """
        if self.per_facet is not None:
            return self.per_facet
        assert self.count is not None, "the rules of the scene demand per_facet or count"
        closed = "outer" in self.boundaries
        return (self.count if closed else self.count - 1) // len(self.facet_lengths(shape))

    def smallest_spacing(self, shape: Shape) -> float:
        """Return the smallest distance between neighbouring glued grains [m]."""
        return min(self.facet_lengths(shape)) / self.grains_per_facet(shape)


class Row(Table):
    """A row of fixed grains between two points."""

    start: Vector = Field(description="centre of the first grain [m]")
    end: Vector = Field(description="centre of the last grain [m]")
    count: Count = Field(description="number of grains")
    radius: Positive = Field(description="radius [m]")
    name: RowName = ROW_NAME
    velocity: Vector = Field((0.0, 0.0), description="constant velocity of the row [m/s]")
    shaken: Flag | None = SHAKEN


class RowUnder(Table):
    """A row of fixed grains, one exactly below each place of a glued grain of a boundary, touching it or the facet."""

    beside: ClassVar[str] = " together with under"

    under: str = Field(description="boundary of the structure")
    radius: Positive = Field(description="radius [m]")
    name: RowName = ROW_NAME
    shaken: Flag | None = SHAKEN


def _row_kind(data: Any) -> str:
    under = "under" in data if isinstance(data, dict) else isinstance(data, RowUnder)
    return "<under>" if under else "<between>"


AnyRow = Annotated[
    Annotated[Row, Tag("<between>")] | Annotated[RowUnder, Tag("<under>")],
    Discriminator(_row_kind),
]
