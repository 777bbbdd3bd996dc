"""The command `leito`, whose runs wait at a row of their history until they are asked to stop.

So a test that stops or kills a run can take as long as it likes. The processes of an ensemble or a study load this
file as well, and wait likewise.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from types import FrameType
from typing import Any

HELD_AT = "LEITO_HELD_AT"  # simulated time [s] of the row
HELD_AFTER = "LEITO_HELD_AFTER"  # so many runs in folders beside that of the run must be done
LIMIT = 300.0  # seconds; only a defect takes so long


def held_leito(arguments: Sequence[str], *, at: float, after: int = 0, **options: Any) -> subprocess.Popen[str]:
    """Start `leito` with runs that wait at a time [s] once `after` runs are done."""
    environment = os.environ | {HELD_AT: repr(at), HELD_AFTER: str(after)}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen([sys.executable, __file__, *arguments], env=environment, **pipes, **options)


def wait_until(there: Callable[[], bool], process: subprocess.Popen[str] | None = None) -> None:
    """Wait for something that a process is to do, if given; fails when that ends before."""
    begun = time.monotonic()
    while not there():
        assert process is None or process.poll() is None, process.communicate()
        assert time.monotonic() - begun < LIMIT, "it does not come"
        time.sleep(0.01)


def hold() -> None:
    """Make the runs of this process wait."""
    from coupled.output.history import History
    from coupled.running.interrupt import Stop

    at, after, asked = float(os.environ[HELD_AT]), int(os.environ[HELD_AFTER]), []
    write, ask = History.write, Stop._ask

    def listen(self: Stop, number: int, frame: FrameType | None) -> None:
        asked.append(number)
        ask(self, number, frame)

    def write_and_wait(self: History, row: dict[str, float]) -> None:
        write(self, row)
        done, begun = len(list(self.path.parents[1].glob("*/summary.json"))), time.monotonic()
        while self.last_time >= at and done >= after and not asked and time.monotonic() - begun < LIMIT:
            time.sleep(0.01)

    History.write, Stop._ask = write_and_wait, listen  # type: ignore[method-assign]


if __name__ == "__mp_main__":
    hold()
if __name__ == "__main__":
    from coupled.cli import main

    hold()
    main()
