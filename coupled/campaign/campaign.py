"""Make many runs side by side, each as `leito run` makes it."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait

from coupled.campaign import crews
from coupled.campaign.folders import begun, done, is_done, require_own, share_done
from coupled.campaign.progress import CampaignProgress
from coupled.campaign.task import Outcome, Task
from coupled.campaign.worker import WISH
from coupled.errors import LeitoError
from coupled.output.lock import require_place
from coupled.running.interrupt import Stop
from coupled.running.launch import ranks

PAUSE = 0.5  # seconds between two looks at the runs


def run_all(
    tasks: Sequence[Task],
    *,
    workers: int | None = None,
    progress: bool = True,
    resume: bool = True,
    overwrite: bool = False,
) -> list[Outcome]:
    """Make runs side by side and return what came of each, in their order.

    Finished runs of the same scene are reused, begun ones taken up. A run that fails, or whose process is killed,
    ends no other. After Ctrl-C each run writes its checkpoint and is "stopped". Outside mpirun the runs are made by
    processes of this machine; under mpirun, where all ranks call this, by the ranks but the first.

    Parameters
    ----------
    tasks : sequence of Task
        With a folder each.
    workers : int, optional
        Runs at a time; by default the cores over the largest number of threads of a run. Under mpirun it is
        the number of ranks less one.
    progress : bool
        A bar for the whole, on a terminal.
    resume : bool
        Reuse what the folders hold; otherwise one that holds a run is refused.
    overwrite : bool
        Make all anew, whatever their folders hold.

    Raises
    ------
    LeitoError
        If two tasks have one folder, or one holds the run of another scene or, without `resume`, any, or cannot be
        a folder; before anything runs.
    """
    if ranks() > 1:
        return _on_ranks(tasks, progress, resume, overwrite)
    ended = _prepared(tasks, resume, overwrite)
    left = [task for task in tasks if task.folder not in ended]
    threads = max((task.threads for task in left), default=1)
    size = min(workers or max(1, (os.cpu_count() or 1) // threads), max(1, len(left)))
    with crews.processes(size, threads) as crew, Stop() as stop:
        return _Campaign(tasks, ended, crew, stop, overwrite).go(progress)


def _on_ranks(tasks: Sequence[Task], progress: bool, resume: bool, overwrite: bool) -> list[Outcome]:
    from mpi4py import MPI

    from coupled.running.ranks import on_root

    comm = MPI.COMM_WORLD
    ended = on_root(comm, lambda: _prepared(tasks, resume, overwrite))
    outcomes: list[Outcome] = []
    with crews.ranks() as crew:
        if crew is not None:
            outcomes = _Campaign(tasks, ended, crew, WISH, overwrite).go(progress)
    return comm.bcast(outcomes, root=0)


def _prepared(tasks: Sequence[Task], resume: bool, overwrite: bool) -> dict[object, Outcome]:
    """The outcomes, by folder, of what is finished already; refuses what would mix runs."""
    folders = [task.folder for task in tasks]
    for folder in folders:
        if folders.count(folder) > 1:
            raise LeitoError(f"{folder} is the folder of two runs; give each its own")
    for task in tasks:
        require_place(task.folder)
    if overwrite:
        return {}
    for task in tasks:
        if begun(task) and not resume:
            raise LeitoError(
                f"{task.folder} holds a run already; go on with --resume, or start anew with --overwrite or --out"
            )
        require_own(task)
    return {task.folder: done(task) for task in tasks if is_done(task)}


class _Campaign:
    """Tasks on their way through a crew."""

    def __init__(
        self, tasks: Sequence[Task], ended: dict[object, Outcome], crew: crews.Crew, stop: Stop, overwrite: bool
    ) -> None:
        self._tasks, self._ended, self._crew, self._stop, self._overwrite = tasks, dict(ended), crew, stop, overwrite
        self._waiting = deque(task for task in tasks if task.folder not in ended)
        self._running: dict[Future[Outcome], Task] = {}

    def go(self, progress: bool) -> list[Outcome]:
        """Run everything that is not stopped."""
        stopping = False
        with CampaignProgress(len(self._tasks), wanted=progress) as bar:
            while self._waiting or self._running:
                if not stopping and self._wished():
                    stopping = True
                    self._crew.stop()
                    self._drop()
                while self._waiting and len(self._running) < self._crew.size:
                    task = self._waiting.popleft()
                    self._running[self._crew.submit(task, self._overwrite)] = task
                shares = sum(share_done(task) for task in self._running.values()) if bar.wanted else 0.0
                bar.update(self._at_end(), shares, stopping=stopping)
                self._collect(bar)
        return [self._ended[task.folder] for task in self._tasks]

    def _wished(self) -> bool:
        """Whether the user wants to stop: said to this process, or to one of the crew."""
        return self._stop.asked or any(outcome.status == "stopped" for outcome in self._ended.values())

    def _at_end(self) -> int:
        return sum(outcome.status != "stopped" for outcome in self._ended.values())

    def _drop(self) -> None:
        while self._waiting:
            task = self._waiting.popleft()
            self._ended[task.folder] = Outcome(task=task, status="stopped", message="not begun")

    def _collect(self, bar: CampaignProgress) -> None:
        ended, _ = wait(self._running, timeout=PAUSE, return_when=FIRST_COMPLETED)
        for future in ended:
            task = self._running.pop(future)
            outcome = self._crew.outcome(task, future)
            self._ended[task.folder] = outcome
            bar.tell(outcome)
