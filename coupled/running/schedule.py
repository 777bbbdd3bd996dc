"""When something is due, in whole steps."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Every:
    """Due at the steps next to the multiples of `interval` steps, which need not be whole, and at the last step.

    What is due is at most half a step off its time after any number of steps: a phase of a motion stays that phase.
    """

    interval: float
    last: int

    @classmethod
    def seconds(cls, seconds: float, window: float, last: int) -> Every:
        """An interval [s] in steps of length `window` [s], at least one and at most `last`."""
        return cls(max(1.0, min(seconds / window, last)), last)

    def due(self, step: int) -> bool:
        return self.next(step - 1) == step

    def next(self, step: int) -> int:
        """The first due step after `step`."""
        count = max(math.floor((step + 0.5) / self.interval) - 1, 0)  # at least one too early, whatever is rounded
        while (due := math.floor(count * self.interval + 0.5)) <= step:
            count += 1
        return min(due, self.last)


@dataclass(frozen=True)
class Events:
    """What a run does on its way: rows, frames (None: never) and checkpoints are written; watchdogs look at `looks`."""

    history: Every
    frames: Every | None
    checkpoints: Every
    looks: Every

    def next(self, step: int) -> int:
        """The first step after `step` at which something is due."""
        return min(event.next(step) for event in self._writing() + [self.looks])

    def writes(self, step: int) -> bool:
        """Whether a row, a frame or a checkpoint is due."""
        return any(event.due(step) for event in self._writing())

    def _writing(self) -> list[Every]:
        return [event for event in (self.history, self.frames, self.checkpoints) if event is not None]
