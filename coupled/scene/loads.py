"""Tables of the external loads of a structure and of their schedules in time."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from coupled.scene.types import Flag, Number, Positive, Table, Vector, by_kind


class Constant(Table):
    """Full strength from the start."""

    beside: ClassVar[str] = ' together with kind = "constant"'

    kind: Literal["constant"] = "constant"


class Ramp(Table):
    """From nothing linearly to full strength, then held."""

    beside: ClassVar[str] = ' together with kind = "ramp"'

    kind: Literal["ramp"] = "ramp"
    over: Positive = Field(description="time to reach full strength [s]")


class Sine(Table):
    """The factor ``offset + sin(2 pi frequency t + phase)``."""

    beside: ClassVar[str] = ' together with kind = "sine"'

    kind: Literal["sine"] = "sine"
    frequency: Positive | None = Field(None, description="frequency [Hz]")
    period: Positive | None = Field(None, description="period [s], instead of frequency")
    phase: Number = Field(0.0, description="phase at the start [rad]")
    offset: Number = Field(0.0, description="mean factor [-]")

    @property
    def cycles_per_second(self) -> float:
        """The frequency, however it is given [Hz]."""
        assert self.frequency is not None or self.period is not None, "the rules of the scene demand one of them"
        return self.frequency if self.frequency is not None else 1.0 / self.period


class Rows(Table):
    """Factors at times, linear between them, held before the first and after the last."""

    beside: ClassVar[str] = ' together with kind = "table"'

    kind: Literal["table"] = "table"
    times: tuple[Number, ...] | None = Field(None, description="times, ascending [s]")
    factors: tuple[Number, ...] | None = Field(None, description="factor at each of the times [-]")
    file: str | None = Field(
        None, description="CSV file beside the scene with the columns time [s] and factor [-], instead of both lists"
    )


Schedule = Annotated[
    Annotated[Constant, Tag("<constant>")]
    | Annotated[Ramp, Tag("<ramp>")]
    | Annotated[Sine, Tag("<sine>")]
    | Annotated[Rows, Tag("<table>")],
    by_kind("constant", "ramp", "sine", "table"),
]


class _Scheduled(Table):
    """What every load has."""

    schedule: Schedule = Field(default_factory=Constant, description="how strong the load is at a time")

    @model_validator(mode="before")
    @classmethod
    def _ramp_is_a_schedule(cls, data: Any) -> Any:
        """Refuse the former key of the ramp with what to write instead."""
        if isinstance(data, dict) and "ramp_time" in data:
            time = data["ramp_time"]
            instead = f'schedule = {{ kind = "ramp", over = {time!r} }}' if time else 'schedule = { kind = "constant" }'
            raise PydanticCustomError("replaced_key", "replaced key", {"key": "ramp_time", "instead": instead})
        return data


class BoundaryLoad(_Scheduled):
    """A force spread evenly over the length of a boundary."""

    beside: ClassVar[str] = ' together with kind = "boundary"'

    kind: Literal["boundary"] = "boundary"
    boundary: str = Field(description="name of the loaded boundary")
    total_force: Vector = Field(description="resultant [N per m of thickness]")


class PressureLoad(_Scheduled):
    """A pressure on a boundary."""

    beside: ClassVar[str] = ' together with kind = "pressure"'

    kind: Literal["pressure"] = "pressure"
    boundary: str = Field(description="name of the pressed boundary")
    pressure: Number = Field(description="pressure, positive when it presses on the structure [Pa]")
    follows: Flag = Field(
        False, description="whether normal and length are those of the present shape, not of the first"
    )


class BodyLoad(_Scheduled):
    """A uniform acceleration of the whole structure, such as its own weight."""

    beside: ClassVar[str] = ' together with kind = "body"'

    kind: Literal["body"] = "body"
    acceleration: Vector = Field(description="acceleration [m/s2]")


class PointLoad(_Scheduled):
    """A force at a point in the structure or on its boundary."""

    beside: ClassVar[str] = ' together with kind = "point"'

    kind: Literal["point"] = "point"
    point: Vector = Field(description="point relative to the centroid of the shape [m]")
    force: Vector = Field(description="force [N per m of thickness]")


Load = Annotated[
    Annotated[BoundaryLoad, Tag("<boundary>")]
    | Annotated[PressureLoad, Tag("<pressure>")]
    | Annotated[BodyLoad, Tag("<body>")]
    | Annotated[PointLoad, Tag("<point>")],
    by_kind("boundary", "pressure", "body", "point"),
]
