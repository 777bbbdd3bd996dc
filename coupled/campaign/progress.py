"""How far a campaign is and how long it will take."""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from coupled.campaign.task import Outcome


class CampaignProgress:
    """A bar with the time left on a terminal, with a line above it for each run that failed; nothing elsewhere.

    The time left is estimated from the share of all simulated time that was done since the beginning.

    Parameters
    ----------
    count : int
        Number of runs.
    wanted : bool
    """

    def __init__(self, count: int, *, wanted: bool) -> None:
        self._console = Console(stderr=True)
        self._count, self._wanted = count, wanted
        self._bar: Progress | None = None
        self._first: tuple[float, float] | None = None  # time and share done when the runs began to move

    def __enter__(self) -> CampaignProgress:
        if self._wanted and self._console.is_terminal:
            columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:3.0f} %"),
                       TimeElapsedColumn(), TextColumn("{task.fields[note]}"))  # fmt: skip
            self._bar = Progress(*columns, console=self._console)
            self._task = self._bar.add_task(f"0 of {self._count} runs", total=self._count, note="")
            self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    @property
    def wanted(self) -> bool:
        """Whether anybody sees how far the runs are."""
        return self._bar is not None

    def update(self, ended: int, running: float, *, stopping: bool) -> None:
        """Report the number of runs that have come to an end and the sum of the shares of those under way."""
        if self._bar is None:
            return
        done = ended + running
        note = "stopping" if stopping else self._left(done)
        said = f"{ended} of {self._count} runs"
        self._bar.update(self._task, completed=done, description=said, note=note)

    def _left(self, done: float) -> str:
        """Time left at the pace since the first runs began to move: until then they load."""
        now = time.perf_counter()
        if self._first is None or done < self._first[1]:
            self._first = (now, done)
        begun, first = self._first
        if done == first:
            self._first = (now, done)
            return ""
        minutes, seconds = divmod(round((now - begun) * (self._count - done) / (done - first)), 60)
        return f"{minutes // 60}:{minutes % 60:02d}:{seconds:02d} left"

    def tell(self, outcome: Outcome) -> None:
        """Name a run that failed."""
        if self._bar is not None and outcome.status == "failed":
            sentence = f"leito: {outcome.task.name}: {outcome.message}"
            self._bar.console.print(sentence, markup=False, highlight=False)
