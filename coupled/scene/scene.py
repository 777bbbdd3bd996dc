"""The scene: every table of a scene file, typed and checked against each other."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from coupled.scene.accuracy import Accuracy, Preset
from coupled.scene.contact import Contact, Damping
from coupled.scene.grains import AnyGrains, Box, Grains
from coupled.scene.interface import AnyRow, Interface
from coupled.scene.intruders import Intruder
from coupled.scene.output import Output, Time
from coupled.scene.quantities import Quantity
from coupled.scene.rules import check_rules
from coupled.scene.shaking import Shaking
from coupled.scene.structure import Structure
from coupled.scene.types import Table, Vector


class Scene(Table):
    """A whole case. A table that is absent is not modelled.

    Lengths in m, masses in kg, times in s, forces in N per m of thickness, unless `units` says
    that the numbers are dimensionless. x points right, y up, rotation is counter-clockwise.
    """

    title: Annotated[str, Field(min_length=1)] = Field(description="one line that says what it is")
    units: Literal["SI", "dimensionless"] = Field("SI", description="units of all numbers")
    gravity: Vector = Field((0.0, 0.0), description="acceleration of gravity [m/s2]")
    accuracy: Accuracy | None = Field(None, description="preset of the numerical keys")
    time: Time = Field(description="duration and step")
    box: Box | None = Field(None, description="rigid walls and periodic sides")
    grains: AnyGrains | None = Field(None, description="free grains")
    intruders: tuple[Intruder, ...] = Field((), description="grains of their own size and density, followed")
    shaking: Shaking | None = Field(None, description="motion of the walls and rows")
    contact: Contact | None = Field(None, description="contact law")
    damping: Damping | None = Field(None, description="global damping of the grains")
    structure: Structure | None = Field(None, description="structure")
    interface: Interface | None = Field(None, description="glued grains or facets, where grains meet the structure")
    rows: tuple[AnyRow, ...] = Field((), description="rows of fixed grains, or of grains that move")
    output: Output = Field(default_factory=Output, description="what is written")
    quantities: tuple[Quantity, ...] = Field((), description="numbers of interest, told at the end of a run")
    preset: Preset | None = Field(None, description="what a preset did to this scene, written where it is read")
    bed: Scene | None = Field(
        None, description="the scene that grains.bed names, whole; read from its file when absent"
    )

    @model_validator(mode="before")
    @classmethod
    def _write_checkpoint_interval(cls, data: Any) -> Any:
        """Write the checkpoint interval, a tenth of the duration, when it is not given."""
        if not isinstance(data, dict):
            return data
        time, output = data.get("time"), data.get("output", {})
        if not isinstance(time, dict) or not isinstance(output, dict):
            return data
        duration, step = time.get("duration"), time.get("step")
        if isinstance(duration, (int, float)) and isinstance(step, (int, float)):
            interval = max(duration / 10, step)
            return {**data, "output": {"checkpoint_interval": interval, **output}}
        return data

    @model_validator(mode="after")
    def _tables_agree(self) -> Scene:
        check_rules(self)
        return self

    @property
    def shaken_rows(self) -> tuple[int, ...]:
        """The rows, numbered from 0, that move with the shaken walls."""
        if self.shaking is None:
            return ()
        return tuple(index for index, row in enumerate(self.rows) if row.shaken is not False)

    @property
    def first_grains(self) -> Grains | None:
        """The table that lays the free grains out: this scene's, or its bed's."""
        if isinstance(self.grains, Grains):
            return self.grains
        return self.bed.first_grains if self.bed is not None else None
