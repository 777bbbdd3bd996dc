"""The command `leito` in a process that is watched: a time limit, a limit of memory, what it said.

One process serves many commands, as FEniCSx and compiled kernels take seconds to load; after a command that hung or
died comes a new one.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import resource
import select
import subprocess
import sys
import time
import traceback
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

MEMORY = 10 * 2**30  # bytes of address space; loaded libraries take some 3 of them
STARTING = 300.0  # seconds until the process must have loaded what it needs


@dataclass(frozen=True)
class Said:
    """What a command came to: its exit code (None if it hung or died), what it wrote to stderr, wall time [s]."""

    code: int | None
    text: str
    seconds: float


class LeitoProcess:
    """Runs `leito` with arguments, one command after the other."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None

    def __enter__(self) -> LeitoProcess:
        return self

    def __exit__(self, *error: Any) -> None:
        self._end()

    def run(self, arguments: Sequence[str], limit: float) -> Said:
        """Run one command for at most `limit` seconds."""
        if self._process is None:
            self._start()
        started = time.perf_counter()
        process = self._process
        print(json.dumps(list(arguments)), file=process.stdin, flush=True)
        answer = self._answer(limit)
        seconds = time.perf_counter() - started
        if answer is None:
            died = process.poll()
            self._end()
            text = f"no answer within {limit:g} s" if died is None else f"the process died with code {died}"
            return Said(None, text, seconds)
        return Said(answer["code"], answer["text"], seconds)

    def _start(self) -> None:
        paths = os.pathsep.join(path for path in sys.path if path)
        self._process = subprocess.Popen(
            [sys.executable, __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env=os.environ | {"PYTHONPATH": paths, "OMP_NUM_THREADS": "1"},
        )
        if self._answer(STARTING) is None:
            raise RuntimeError("the process that runs leito did not start")

    def _answer(self, limit: float) -> Any:
        """The next line of the process, or None."""
        ready, _, _ = select.select([self._process.stdout], [], [], limit)
        line = self._process.stdout.readline() if ready else ""
        return json.loads(line) if line else None

    def _end(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process.stdin.close()
            self._process.stdout.close()
            self._process = None


def serve() -> None:
    """Be the process: arguments come as lines, answers go as lines. Nothing else reaches the pipe."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    from coupled.cli import main
    from coupled.running import run  # noqa: F401  loads what every command needs

    warnings.simplefilter("always", RuntimeWarning)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    print(json.dumps({"code": 0, "text": ""}), file=answers, flush=True)
    for line in sys.stdin:
        sys.argv = ["leito", *json.loads(line)]
        code, told = 0, io.StringIO()
        with contextlib.redirect_stderr(told), contextlib.redirect_stdout(io.StringIO()):
            try:
                main()
            except SystemExit as end:
                code = end.code if isinstance(end.code, int) else int(end.code is not None)
            except BaseException:
                traceback.print_exc()
                code = 1
        print(json.dumps({"code": code, "text": told.getvalue()}), file=answers, flush=True)


if __name__ == "__main__":
    serve()
