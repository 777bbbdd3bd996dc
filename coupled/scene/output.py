"""Tables of the time and of what a run writes."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from coupled.scene.types import Flag, NonNegative, Number, Positive, Table

SAFETY = 0.8  # of the limit of any packing, where the step is left to the model


def _step_kind(step: Any) -> str:
    return "<auto>" if step == "auto" else "<number>"


Step = Annotated[
    Annotated[Positive, Tag("<number>")] | Annotated[Literal["auto"], Tag("<auto>")], Discriminator(_step_kind)
]


class Time(Table):
    """Duration and step of the run."""

    duration: Positive = Field(description="simulated time [s]")
    step: Step = Field(
        description='time step of the grains [s], or "auto": safety times the limit that holds in every packing of them'
    )
    safety: Annotated[Number, Field(gt=0, le=1)] | None = Field(
        None, description=f'share of that limit for step = "auto" [-]; absent: {SAFETY:g}'
    )
    integrator: Literal["leapfrog", "velocity_verlet"] = Field(
        "leapfrog", description="scheme of the grains; velocity_verlet shows dashpots the velocity of the present"
    )
    step_fraction: Annotated[Number, Field(gt=0, le=1)] | None = Field(
        None,
        description='share of the sharp limit for step = "auto" [-], instead of safety: the limit of a settled sample '
        "of the grains, or that of the coupling if it is smaller",
    )
    refinement: Positive | None = Field(None, description="number by which a given step is divided [-]")
    stop_at_rest: Positive | None = Field(
        None,
        description="stop when the mean kinetic energy per grain over the mean m |g| d falls below this [-]",
    )

    @model_validator(mode="before")
    @classmethod
    def _write_safety(cls, data: Any) -> Any:
        """Write the safety factor of a step that is left to the model."""
        if isinstance(data, dict) and data.get("step") == "auto" and data.get("step_fraction") is None:
            return {"safety": SAFETY, **data}
        return data

    @property
    def least_step(self) -> float:
        """The step [s], or 0 while it is left to the model."""
        return 0.0 if self.step == "auto" else self.step


class Output(Table):
    """What a run writes, and how often, in simulated time."""

    folder: str | None = Field(None, description="folder of the run; absent: runs/<scene>")
    history_interval: Positive = Field(0.01, description="between rows of history.csv [s]")
    frames_per_second: NonNegative = Field(
        20.0, description="frames of the XDMF files per simulated second [1/s]; 0: none"
    )
    checkpoint_interval: Positive | None = Field(
        None, description="between checkpoints [s]; absent: a tenth of the duration"
    )
    figures: Flag = Field(True, description="draw the figures at the end")
