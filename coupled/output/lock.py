"""One process at a time writes into a folder."""

from __future__ import annotations

import contextlib
import fcntl
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from coupled.errors import LeitoError

PAUSE = 0.2  # seconds between two looks whether the folder is free


@contextlib.contextmanager
def only_process(path: Path, wait: Callable[[], None] | None = None) -> Iterator[None]:
    """Hold a folder, made if need be, as the only process; a lock of the system that goes with its process.

    Parameters
    ----------
    path : Path
        Removed again if it is left empty.
    wait : callable, optional
        Called once where another process holds the folder; then this one waits. Without it: refused.

    Raises
    ------
    LeitoError
        If another process holds the folder, or it cannot be made.
    """
    handle = _held(path, wait)
    try:
        yield
    finally:
        with contextlib.suppress(OSError):
            path.rmdir()  # refused by the system if there is anything in it
        os.close(handle)


def require_place(path: Path) -> None:
    """Refuse a folder that is a file, or would have to be made inside of one.

    Raises
    ------
    LeitoError
        Naming the file.
    """
    there = next(place for place in (path, *path.absolute().parents) if place.exists())
    if not there.is_dir():
        raise LeitoError(f"{there} is a file; give another folder with --out")


def _held(path: Path, wait: Callable[[], None] | None) -> int:
    told = False
    while True:
        handle = _opened(path)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(handle)
        else:
            with contextlib.suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(handle), path.stat()):
                    return handle
            os.close(handle)  # the folder was removed before it was held
            continue
        if wait is None:
            raise LeitoError(
                f"{path} is being written by another process: wait until it ends, or give another folder with --out"
            )
        if not told:
            wait()
            told = True
        time.sleep(PAUSE)


def _opened(path: Path) -> int:
    require_place(path)
    try:
        path.mkdir(parents=True, exist_ok=True)
        return os.open(path, os.O_RDONLY)
    except OSError as error:
        raise LeitoError(f"{path} cannot be made: {error.strerror}; give another folder with --out") from None
