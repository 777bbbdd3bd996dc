"""What a process of a campaign does: one run after the other.

Nothing heavy is loaded before the process has put its surroundings in order.
"""

from __future__ import annotations

import contextlib
import io
import multiprocessing
import os
import signal
import threading
import time
import traceback
from pathlib import Path

from coupled.campaign.folders import begun, done
from coupled.campaign.task import Outcome, Task
from coupled.errors import Interrupted, is_sentence
from coupled.running.interrupt import Stop

# An MPI process marks its environment; one that it starts must not take itself for a part of it.
MARKS = ("OMPI_", "PMIX_", "PMI_", "PRTE_", "ORTE_")
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
PAUSE = 0.2  # seconds between two looks whether a run has written its checkpoint

WISH = Stop()  # of this process and all its runs
_busy = threading.Event()


def limit_threads(threads: int) -> None:
    """Bound the threads of linear algebra in this process, unless the user has; before anything loads it."""
    for name in THREADS:
        os.environ.setdefault(name, str(threads))


def start(threads: int) -> int:
    """Put a new process in order: of its own for Ctrl-C and MPI, gone with its parent. Returns its number."""
    os.setpgid(0, 0)  # the terminal's Ctrl-C goes to the parent, which asks each run once
    for name in [name for name in os.environ if name.startswith(MARKS)]:
        del os.environ[name]
    limit_threads(threads)
    WISH.__enter__()  # for the life of the process
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    return os.getpid()


def work(task: Task, overwrite: bool) -> Outcome:
    """Make or take up a run; whatever goes wrong is its outcome."""
    if WISH.asked:
        return Outcome(task=task, status="stopped", message="not begun")
    _busy.set()
    try:
        return _run(task, overwrite)
    finally:
        _busy.clear()


def _run(task: Task, overwrite: bool) -> Outcome:
    try:
        from mpi4py import MPI

        from coupled.running.run import run_scene

        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            run_scene(
                task.scene,
                out=task.folder,
                resume=begun(task) and not overwrite,
                overwrite=overwrite,
                threads=task.threads,
                progress=False,
                comm=MPI.COMM_SELF,
                stop=WISH,
                shared=task.shared,
            )
        return done(task)
    except Interrupted as stop:
        return Outcome(task=task, status="stopped", message=str(stop))
    except Exception as error:
        message = str(error) if is_sentence(error) else _defect(task, error)
        return Outcome(task=task, status="failed", message=message)


def _defect(task: Task, error: Exception) -> str:
    """A sentence on an error that nobody expected, with its place; a run that was begun has all of it in its log."""
    if begun(task):
        with contextlib.suppress(OSError), open(task.folder / "log.txt", "a") as log:
            log.write("".join(traceback.format_exception(error)))
    place = traceback.extract_tb(error.__traceback__)[-1]
    return (
        f"{type(error).__name__}: {error} ({Path(place.filename).name}, line {place.lineno}); a defect of the program"
    )


def _leave_with_parent() -> None:
    """When the parent is gone: ask the run to stop, and leave when its checkpoint is written."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    parent.join()
    os.kill(os.getpid(), signal.SIGTERM)
    while _busy.is_set():
        time.sleep(PAUSE)
    os._exit(1)
