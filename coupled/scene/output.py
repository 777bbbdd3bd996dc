"""Tables of the time and of what a run writes."""

from __future__ import annotations

from pydantic import Field

from coupled.scene.types import Flag, NonNegative, Positive, Table


class Time(Table):
    """Duration and step of the run."""

    duration: Positive = Field(description="simulated time [s]")
    step: Positive = Field(description="time step of the grains [s]")
    stop_at_rest: Positive | None = Field(
        None,
        description="stop when the mean kinetic energy per grain over the mean m |g| d falls below this [-]",
    )


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
