"""How far a run is and how long it will take."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn


class RunProgress:
    """A bar with the time left on a terminal; a line every tenth elsewhere; nothing if not wanted.

    Parameters
    ----------
    title : str
    last : int
        Step at which the run ends.
    first : int
        Step at which this process begins.
    wanted : bool
    """

    def __init__(self, title: str, last: int, first: int, *, wanted: bool) -> None:
        self.title, self.last, self.first, self.wanted = title, max(last, 1), first, wanted
        self._bar: Progress | None = None
        self._begun = time.perf_counter()
        self._told = 10 * first // self.last

    def __enter__(self) -> RunProgress:
        console = Console(stderr=True)
        if self.wanted and console.is_terminal:
            columns = (
                TextColumn("{task.description}"), BarColumn(),
                TextColumn("{task.percentage:3.0f} %  {task.fields[note]}"),
                TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn(),
            )  # fmt: skip
            self._bar = Progress(*columns, console=console)
            self._task = self._bar.add_task(self.title, total=self.last, completed=self.first, note="")
            self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def update(self, step: int, note: str) -> None:
        """Report that `step` is done."""
        if self._bar is not None:
            self._bar.update(self._task, completed=step, note=note)
        elif self.wanted and 10 * step // self.last > self._told:
            self._told = 10 * step // self.last
            spent = time.perf_counter() - self._begun
            left = spent * (self.last - step) / max(step - self.first, 1)
            print(
                f"{self.title}: {100 * step / self.last:3.0f} %  {note}, {spent:.0f} s spent, {left:.0f} s left",
                file=sys.stderr,
                flush=True,
            )
