"""Table of the shaken walls and rows."""

from __future__ import annotations

import math
from typing import Any, Literal

from pydantic import Field, model_validator

from coupled.scene.grains import Box, Wall
from coupled.scene.types import Count, NonNegative, Positive, Table, Vector


class Shaking(Table):
    """Walls of the box, and rows of grains, that move to and fro: ``A (1 - cos(omega t))`` or ``A sin(omega t)``."""

    gamma: Positive | None = Field(None, description="Gamma = A omega^2/g [-], instead of amplitude")
    amplitude: Positive | None = Field(None, description="A, half the stroke [m]")
    period: Positive | None = Field(None, description="period of the motion [s]")
    period_steps: Count | None = Field(None, description="period in steps of the grains, instead of period")
    direction: Literal["x", "y"] = Field("y", description="axis of the motion")
    walls: tuple[Wall, ...] | None = Field(None, min_length=1, description="walls that move; absent: all of the box")
    waveform: Literal["cosine", "sine"] = Field(
        "cosine", description="A (1 - cos), which begins at rest at the lowest point, or A sin"
    )
    start: NonNegative = Field(0.0, description="time when the motion begins [s]")
    stop: Positive | None = Field(
        None, description="time when it ends [s]: the ramp begins to fall, or without one the period is finished"
    )
    ramp: NonNegative | None = Field(
        None,
        description="time in which the amplitude grows and falls [s]; absent: none for cosine, one period for sine",
    )

    @model_validator(mode="before")
    @classmethod
    def _write_ramp(cls, data: Any) -> Any:
        """Write the ramp of one period that keeps the velocity of a sine from jumping."""
        if isinstance(data, dict) and data.get("waveform", "cosine") == "cosine":
            return {"ramp": 0.0, **data}
        return data

    def moved(self, box: Box) -> tuple[Wall, ...]:
        """The walls that move: those named, or all of the box."""
        return self.walls or box.walls

    def period_with(self, step: float) -> float:
        """The period [s] with a time step of the grains [s]."""
        return self.period if self.period_steps is None else self.period_steps * step

    def amplitude_of(self, period: float, gravity: Vector) -> float:
        """A [m] of a period [s] under gravity [m/s2]."""
        if self.amplitude is not None:
            return self.amplitude
        return self.gamma * math.hypot(*gravity) * (period / (2.0 * math.pi)) ** 2
