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
        """The nearest whole number of steps of length `window` [s], at least one."""
        return cls(max(1, round(seconds / window)), last)

    def due(self, step: int) -> bool:
        return step % self.interval == 0 or step == self.last

    def next(self, step: int) -> int:
        """The first due step after `step`."""
        return min((step // self.interval + 1) * self.interval, self.last)
