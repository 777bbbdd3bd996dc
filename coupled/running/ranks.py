"""What the ranks of a run agree on: results, errors, and how they leave."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, TypeVar

from mpi4py import MPI

Result = TypeVar("Result")
PATIENCE = 20.0  # seconds in which the other ranks must have met the same error
DELIVERY = 1.0  # seconds for the last words: mpirun may drop what is under way when it ends the ranks


def on_root(comm: MPI.Intracomm, action: Callable[[], Result]) -> Result:
    """Do something on rank 0 and have its result, or its error, on all ranks."""
    outcome: tuple[Any, Exception | None] = (None, None)
    if comm.rank == 0:
        try:
            outcome = (action(), None)
        except Exception as error:  # every rank must stop, whatever it is
            outcome = (None, error)
    outcome = comm.bcast(outcome, root=0)
    if outcome[1] is not None:
        raise outcome[1]
    return outcome[0]


def root_alone(comm: MPI.Intracomm, action: Callable[[], Any]) -> None:
    """Do something on rank 0; its error, if any, is raised on all ranks, its result is dropped."""
    on_root(comm, lambda: action() and None)


def together(comm: MPI.Intracomm, action: Callable[[], Result]) -> Result:
    """Do something on all ranks; if one fails alone, all fail instead of waiting for it."""
    error: Exception | None = None
    result = None
    try:
        result = action()
    except Exception as raised:  # told to the other ranks below
        error = raised
    errors = [e for e in comm.allgather(error) if e is not None]
    if errors:
        raise error or errors[0]
    return result


class LeaveTogether:
    """Context of a parallel run: an error that one rank met alone ends the others, too.

    An error that all ranks met, as agreed errors are, passes as it is. Where the others have not
    come after `patience` seconds, they wait for this rank somewhere and always would: this rank
    says its sentence and ends them all.

    Parameters
    ----------
    comm : MPI communicator
        All ranks enter and leave at the same places.
    patience : float
        [s].
    """

    def __init__(self, comm: MPI.Intracomm, patience: float = PATIENCE) -> None:
        self._comm, self._patience = comm, patience

    def __enter__(self) -> None:
        # Its own: the others may be waiting in a message of the run.
        self._goodbye = self._comm.Dup() if self._comm.size > 1 else None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: Any) -> None:
        if self._goodbye is None:
            return
        if error is None:
            self._goodbye.Free()
            return
        arrived, begun = self._goodbye.Ibarrier(), time.monotonic()
        while not arrived.Test():
            if time.monotonic() - begun > self._patience:
                print(f"leito: rank {self._comm.rank}: {error or kind.__name__}", file=sys.stderr, flush=True)
                time.sleep(DELIVERY)
                self._comm.Abort(1)
            time.sleep(0.05)
