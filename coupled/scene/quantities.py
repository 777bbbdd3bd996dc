"""Tables of the quantities of interest: what a run is made for, told at its end and compared between runs."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, Tag

from coupled.scene.types import Count, NonNegative, Number, Positive, Table, by_kind


class _Quantity(Table):
    """What every quantity has."""

    name: str = Field(description="name: letters, digits and underscores, a letter first")
    unit: str | None = Field(None, description="unit that is shown; absent: that of the column")
    exact: Number | None = Field(None, description="value that is known otherwise, such as a closed form [unit]")
    scale: Positive | None = Field(
        None, description="what an error is measured against [unit]; absent: the magnitude of the value compared with"
    )


class ColumnValue(_Quantity):
    """A column of the history at one time, linear between its rows."""

    beside: ClassVar[str] = ' together with kind = "value"'

    kind: Literal["value"] = "value"
    column: str = Field(description="column of history.csv")
    time: NonNegative | None = Field(None, description="time [s]; absent: the end of the run")


class ColumnOverTime(_Quantity):
    """A column over a window of time: its mean, least or largest value, drop or rise, frequency.

    `over` counts from the ends of the window, wherever a run that is made shorter or longer has them: of a drop or rise
    the means over so long at both ends are compared, of anything else the last part of the window is looked at.
    """

    beside: ClassVar[str] = ' together with a kind of "mean", "min", "max", "drop", "rise" or "frequency"'

    kind: Literal["mean", "min", "max", "drop", "rise", "frequency"] = "mean"
    column: str = Field(description="column of history.csv")
    start: NonNegative = Field(0.0, description="start of the window [s]")
    end: Positive | None = Field(None, description="end of the window [s]; absent: the end of the run")
    over: Positive | None = Field(
        None,
        description="drop, rise: length of the means at both ends that are compared [s], absent: of the moments there; "
        "others: length of the last part of the window that counts [s], absent: all of it",
    )
    over_periods: Count | None = Field(None, description="over in periods of [shaking], instead of over")


class ColumnWhen(_Quantity):
    """A column when another one reaches a value for the first time: the force at a depth."""

    beside: ClassVar[str] = ' together with kind = "when"'

    kind: Literal["when"] = "when"
    column: str = Field(description="column of history.csv that is read")
    other: str = Field(description="column of history.csv that reaches the value")
    reaches: Number | None = Field(None, description="the value")
    changes_by: Number | None = Field(None, description="the value minus that at the start, instead of reaches")


class Surface(_Quantity):
    """Mean height [m] or slope [degrees] of the surface of the free grains at the end of the run.

    The surface is the upper envelope of the discs; the slope is that of its line of least squares, positive where
    it rises to the right.
    """

    beside: ClassVar[str] = ' together with a kind of "surface_height" or "surface_angle"'

    kind: Literal["surface_height", "surface_angle"] = "surface_height"
    left: Number | None = Field(None, description="left end of the part that is looked at [m]; absent: of the box")
    right: Number | None = Field(None, description="right end of that part [m]; absent: of the box")


class Packing(_Quantity):
    """Area of the free grains in a rectangle over that of the rectangle, at the end of the run [-]."""

    beside: ClassVar[str] = ' together with kind = "packing_fraction"'

    kind: Literal["packing_fraction"] = "packing_fraction"
    left: Number | None = Field(None, description="left end of the rectangle [m]; absent: that of the box")
    right: Number | None = Field(None, description="right end of the rectangle [m]; absent: that of the box")
    bottom: Number = Field(0.0, description="lower end of the rectangle [m]")
    top: Number = Field(description="upper end of the rectangle [m]")


Quantity = Annotated[
    Annotated[ColumnValue, Tag("<value>")]
    | Annotated[ColumnWhen, Tag("<when>")]
    | Annotated[ColumnOverTime, Tag("<over_time>")]
    | Annotated[Surface, Tag("<surface>")]
    | Annotated[Packing, Tag("<packing_fraction>")],
    by_kind(
        "value",
        "when",
        "packing_fraction",
        over_time=("mean", "min", "max", "drop", "rise", "frequency"),
        surface=("surface_height", "surface_angle"),
    ),
]
