"""Ctrl-C, or the end of a job's time, as a wish that is met at the next event."""

from __future__ import annotations

import signal
from types import FrameType
from typing import Any

WISHES = (signal.SIGINT, signal.SIGTERM)  # the second is what `kill` and batch systems send first


class Stop:
    """Ctrl-C and SIGTERM ask for a stop at the next event; a second one stops at once."""

    asked = False

    def __enter__(self) -> Stop:
        self._before = {wish: signal.signal(wish, self._ask) for wish in WISHES}
        return self

    def __exit__(self, *error: Any) -> None:
        for wish, before in self._before.items():
            signal.signal(wish, before)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True
