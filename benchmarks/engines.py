"""Other codes as processes that take commands from their standard input.

LAMMPS and LIGGGHTS speak the same language: a script is read by `include`, `run N pre no post no`
goes on where the last run ended, and what `print` says is the sign that the orders before it are
done. One clock, ours, times all of them. A process is stopped outside its turn, because the ranks
of an MPI program spin while they wait for the next command.
"""

import os
import signal
import subprocess
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np

DONE = "all orders carried out"
COLUMNS = "id x y vx vy radius mass"


class EngineError(RuntimeError):
    """A code that ended by itself."""


class Engine:
    """One run of another code: a process, or the launcher of several."""

    def __init__(
        self, name: str, program: Sequence[str], deck: Sequence[str], *, discs: int, folder: Path,
        environment: Mapping[str, str],
    ) -> None:  # fmt: skip
        self.name, self.discs, self.folder = name, discs, folder
        script = folder / f"{name}.in"
        script.write_text("\n".join(deck) + "\n")
        self.process = subprocess.Popen(
            program, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            env=environment, cwd=folder,
        )  # fmt: skip
        self.version = self.order(f"include {script}", "run 0 post no")[0].strip()

    def order(self, *commands: str) -> list[str]:
        """Have commands carried out and return what the code said."""
        self.send(*commands)
        return self.answer()

    def send(self, *commands: str) -> None:
        """Give orders without waiting; `answer` must follow."""
        assert self.process.stdin is not None
        self._signal(signal.SIGCONT)
        with suppress(BrokenPipeError):  # it ended: `answer` says so
            self.process.stdin.write("\n".join([*commands, f'print "{DONE}"', ""]))
            self.process.stdin.flush()

    def answer(self) -> list[str]:
        """Wait until the last orders are carried out, then stop the process."""
        assert self.process.stdout is not None
        said: list[str] = []
        for line in self.process.stdout:
            if line.strip() == DONE:
                self._signal(signal.SIGSTOP)
                return said
            said.append(line)
        raise EngineError(f"{self.name} ended, look at {self.name}.in in {self.folder}: {''.join(said[-3:]).strip()}")

    def _signal(self, which: signal.Signals) -> None:
        for number in _family(self.process.pid):
            with suppress(ProcessLookupError):
                os.kill(number, which)

    def cost(self, steps: int) -> float:
        """Seconds of one particle-step."""
        begin = time.perf_counter()
        self.order(f"run {steps} pre no post no")
        return (time.perf_counter() - begin) / (steps * self.discs)

    def end_state(self) -> np.ndarray:
        """Columns x, y, vx, vy, radius, mass in the order of the discs."""
        place = self.folder / f"{self.name}.dump"
        self.order(f"write_dump all custom {place} {COLUMNS} modify sort id format {self.number_format}")
        return np.loadtxt(place, skiprows=9)[:, 1:]

    @property
    def number_format(self) -> str:
        """All digits, in the words of this code."""
        if self.version.startswith("LIGGGHTS"):
            return '"%d' + " %.17g" * (len(COLUMNS.split()) - 1) + '"'
        return "float %.17g"

    def close(self) -> None:
        """End the input, and the code with it."""
        assert self.process.stdin is not None
        self._signal(signal.SIGCONT)
        with suppress(BrokenPipeError):
            self.process.stdin.close()
        self.process.wait()


def _family(number: int) -> list[int]:
    """A process and all that it started: a launcher of MPI gives its ranks sessions of their own."""
    try:
        children = Path(f"/proc/{number}/task/{number}/children").read_text().split()
    except FileNotFoundError:  # it ended, or this system does not tell: then nothing is stopped
        return []
    return [number, *(kin for child in children for kin in _family(int(child)))]
