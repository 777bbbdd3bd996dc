"""Ctrl-C as a wish that is met at the next event."""

from __future__ import annotations

import signal
from types import FrameType
from typing import Any


class Stop:
    """Ctrl-C asks for a stop at the next event; a second one stops at once."""

    asked = False

    def __enter__(self) -> Stop:
        self._before = signal.signal(signal.SIGINT, self._ask)
        return self

    def __exit__(self, *error: Any) -> None:
        signal.signal(signal.SIGINT, self._before)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True
