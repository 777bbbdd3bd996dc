"""When something is due, in whole steps."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Every:
    """Due at multiples of `interval` steps, and at the last step."""

    interval: int
    last: int

    @classmethod
    def seconds(cls, seconds: float, window: float, last: int) -> Every:
        """The nearest whole number of steps of length `window` [s], at least one and at most `last`."""
        return cls(max(1, round(min(seconds / window, last))), last)

    def due(self, step: int) -> bool:
        return step % self.interval == 0 or step == self.last

    def next(self, step: int) -> int:
        """The first due step after `step`."""
        return min((step // self.interval + 1) * self.interval, self.last)


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
