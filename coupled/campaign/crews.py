"""Who makes the runs: processes of this machine, or the ranks that mpirun has started."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Protocol

from coupled.campaign.task import Outcome, Task
from coupled.campaign.worker import WISH, start, work

RUNS_EACH = 20  # of a process: dolfinx keeps some megabytes of each structure, whatever is done to free them
KILLED = "the process of this run was killed, perhaps for want of memory: take fewer at a time, then go on"


class Crew(Protocol):
    """Takes tasks, at most `size` at a time."""

    size: int

    def submit(self, task: Task, overwrite: bool) -> Future[Outcome]:
        """Begin a task."""

    def outcome(self, task: Task, future: Future[Outcome]) -> Outcome:
        """What came of a task that has ended."""

    def stop(self) -> None:
        """Ask all runs to write their checkpoints and stop."""


class Processes:
    """A pool of one process for each run at a time: one that is killed takes no other run with it.

    A pool of many ends all its processes when one of them dies.

    Parameters
    ----------
    size : int
    threads : int
        For linear algebra, in each.
    """

    def __init__(self, size: int, threads: int) -> None:
        self.size, self._threads = size, threads
        self._idle: list[_Slot] = []
        self._busy: dict[Future[Outcome], _Slot] = {}

    def submit(self, task: Task, overwrite: bool) -> Future[Outcome]:
        slot = self._idle.pop() if self._idle else _Slot(self._threads)
        future = slot.pool.submit(work, task, overwrite)
        self._busy[future] = slot
        return future

    def outcome(self, task: Task, future: Future[Outcome]) -> Outcome:
        slot = self._busy.pop(future)
        try:
            outcome = future.result()
        except BrokenProcessPool:
            slot.pool.shutdown(wait=False)
            return Outcome(task=task, status="failed", message=KILLED)
        slot.runs += 1
        if slot.runs < RUNS_EACH:
            self._idle.append(slot)
        else:
            slot.pool.shutdown(wait=False)
        return outcome

    def stop(self) -> None:
        for slot in self._busy.values():
            slot.send(signal.SIGINT)

    def kill(self) -> None:
        """End all runs at once; their last checkpoints stay."""
        for slot in self._busy.values():
            slot.send(signal.SIGKILL)

    def close(self) -> None:
        """End the processes, which wait for nothing."""
        for slot in [*self._idle, *self._busy.values()]:
            slot.pool.shutdown(wait=True)


class _Slot:
    """A pool of one process, which is there when this returns."""

    def __init__(self, threads: int) -> None:
        self.pool = ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn"))
        self.runs = 0
        self._process = self.pool.submit(start, threads).result()

    def send(self, wish: signal.Signals) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._process, wish)


class Ranks:
    """The ranks of mpirun but the first, which gives the runs out. Signals reach them through mpirun."""

    def __init__(self, executor: Executor, size: int) -> None:
        self.size, self._executor = size, executor

    def submit(self, task: Task, overwrite: bool) -> Future[Outcome]:
        return self._executor.submit(work, task, overwrite)

    def outcome(self, task: Task, future: Future[Outcome]) -> Outcome:
        return future.result()

    def stop(self) -> None:
        pass


@contextlib.contextmanager
def processes(size: int, threads: int) -> Iterator[Processes]:
    """A crew of processes."""
    crew = Processes(size, threads)
    try:
        yield crew
    except BaseException:  # a second Ctrl-C, or a defect of ours
        crew.kill()
        raise
    finally:
        crew.close()


@contextlib.contextmanager
def ranks() -> Iterator[Ranks | None]:
    """A crew of the ranks of mpirun, on the first of them; the others work in here, and get None."""
    from mpi4py import MPI
    from mpi4py.futures import MPICommExecutor

    import coupled.running.run  # noqa: F401  PETSc begins on all ranks together, or waits for them for ever

    with WISH, MPICommExecutor(MPI.COMM_WORLD) as executor:
        yield None if executor is None else Ranks(executor, MPI.COMM_WORLD.size - 1)
