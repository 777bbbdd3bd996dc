"""What a run keeps beside its model and leaves in its folder: first numbers, peaks, times, rows, frames, states."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from coupled.build import Built
from coupled.errors import LeitoError
from coupled.output import checkpoint
from coupled.output.folder import RunFolder
from coupled.output.provenance import provenance, write_json
from coupled.output.writers import Writers
from coupled.report import cautions
from coupled.running.observe import Observation, observe
from coupled.running.ranks import root_alone
from coupled.running.restep import FORMER_STEP, STEP
from coupled.scene.units import in_units
from structure import solver_options

PEAKS = (
    "max_von_mises", "max_strain", "momentum_residual", "reaction_y", "rotation", "local_rotation", "compression",
    "stiffness_ratio",
)  # fmt: skip
FIRST = ("centroid_y",)
STEPPING = "stepping"  # beside the parts, which it spans


class Record:
    """Files and sums of a run, begun or taken up again. Rank 0 alone writes.

    Parameters
    ----------
    built : Built
    folder : RunFolder
        If it holds a state, the model goes back to it.
    comm : MPI communicator
    seconds : dict
        Wall time per part [s] so far.

    Attributes
    ----------
    start : dict
        The ledger's entries at the beginning [J/m].
    first, peaks : dict
        Numbers of the first observation; largest magnitudes over all of them.
    resumed : bool
    """

    def __init__(self, built: Built, folder: RunFolder, comm: MPI.Intracomm, seconds: dict[str, float]) -> None:
        self.built, self.model, self.folder, self.comm = built, built.model, folder, comm
        self.seconds = seconds | {"output": 0.0}
        self._stepped = np.zeros(2)
        self._begun: NDArray[np.float64] | None = None
        seen = observe(self.model, None)
        self.start = seen.balance.entries
        self.first = {name: seen.numbers.get(name, 0.0) for name in FIRST}
        self.peaks = dict.fromkeys(PEAKS, 0.0)
        self._warned: set[str] = set()
        saved = comm.bcast(folder.saved, root=0)
        self.resumed = saved is not None
        if saved is not None:
            self._take_up(saved)
        self.writers = None
        if comm.rank == 0:
            self.writers = Writers(folder.path, self.model, keep_until=self.model.time if self.resumed else None)

    def _take_up(self, saved: Mapping[str, NDArray[Any]]) -> None:
        needed = {name for name in self.model.state() if not name.startswith("exchange.")}  # another may go on
        if missing := sorted(needed - saved.keys()):
            raise LeitoError(
                f"the state in {self.folder.path} lacks {missing[0]}, it is of another version: start anew with "
                "--overwrite"
            )
        self.model.restore(saved)
        self.start = dict(zip(self.start, saved["run.start"].tolist(), strict=True))
        self.first = dict(zip(self.first, saved["run.first"].tolist(), strict=True))
        self.peaks |= dict(zip(PEAKS, saved["run.peaks"].tolist(), strict=False))  # older runs kept fewer
        before = json.loads(bytes(saved["run.seconds"]).decode())
        self._stepped = np.array(before.pop(STEPPING, [0.0, 0.0]))  # older runs did not count it
        for name, spent in before.items():
            into = self.model.seconds if name in self.model.seconds else self.seconds
            into[name] = into.get(name, 0.0) + spent
        if FORMER_STEP in saved:
            self._rebase(saved["run.entries"])

    def begin(self) -> None:
        """The run's own work begins: all is loaded, compiled and built."""
        self._begun = _clocks()

    @property
    def stepping(self) -> NDArray[np.float64]:
        """Wall time and processor time (all threads of this rank) of the steps and their output so far [s]."""
        return self._stepped if self._begun is None else self._stepped + _clocks() - self._begun

    def _rebase(self, entries: NDArray[np.float64]) -> None:
        """Take out of the ledger what its lines [J/m] change by where a state is seen with another step.

        Kinetic energy is ``m v(n-1/2) v(n+1/2)/2``, which depends on the step to second order.
        """
        now = observe(self.model, self.start).balance.entries
        for name, before in zip(self.start, entries.tolist(), strict=True):
            self.start[name] += now[name] - before

    def count(self, seen: Observation) -> None:
        """Enter the peaks of an observation; say once of each that it leaves the theory in use."""
        for name in PEAKS:
            self.peaks[name] = max(self.peaks[name], abs(seen.numbers.get(name, 0.0)))
        beyond = cautions.beyond_theory(self.built, seen.numbers) | cautions.beyond_exchange(self.built, seen.numbers)
        self.say([f"t = {self.model.time:g} s: {beyond[name]}" for name in beyond if name not in self._warned])
        self._warned |= beyond.keys()

    def write(self, seen: Observation, *, row: bool, frame: bool) -> None:
        """Write a row of the history, a frame of each body, or both. Collective."""
        fields = None
        if frame and self.model.structure is not None:
            fields = self.model.structure.fields()

        def put() -> None:
            if row:
                self.writers.history.write(seen.row(self.built.scene.units))
            if frame:
                self.writers.write_frame(self.model, seen, fields)

        self._written(put)

    def _written(self, action: Callable[[], None]) -> None:
        """Write on rank 0; a disk that refuses is a sentence on all ranks."""

        def put() -> None:
            try:
                action()
            except OSError as error:
                raise LeitoError(
                    f"{self.folder.path} cannot be written to ({error.strerror or error}): make room, then go on from "
                    f"the last state there with --resume"
                ) from None

        root_alone(self.comm, put)

    def lacks(self, time: float) -> tuple[bool, bool]:
        """Whether there is no row and no frame of a time [s] or a later one yet. On rank 0."""
        frames = [series.last_time for series in (self.writers.grains, self.writers.structure) if series is not None]
        return self.writers.history.last_time < time, max(frames) < time

    def save(self, state: dict[str, NDArray[Any]], entries: dict[str, float], name: str = checkpoint.NAME) -> None:
        """Write a state of the model, with its entries of the ledger [J/m] and the sums that belong to it."""
        parts = self.seconds | self.model.seconds
        spent = json.dumps(parts | {STEPPING: self.stepping.tolist()}).encode()
        sums = {
            "run.start": np.array(list(self.start.values())),
            "run.entries": np.array(list(entries.values())),
            "run.first": np.array(list(self.first.values())),
            "run.peaks": np.array(list(self.peaks.values())),
            STEP: np.array(self.built.scene.time.step),
            "run.seconds": np.frombuffer(spent, np.uint8),
        }
        self._written(lambda: checkpoint.save(self.folder.file(name), state | sums, scene=self.built.scene.title))

    def write_provenance(self) -> None:
        """Versions, machine, threads and wall times so far."""
        if self.comm.rank == 0:
            grains, particles = self.built.scene.first_grains, self.model.particles
            about = provenance(
                threads=particles.threads if particles is not None else 0,
                ranks=self.comm.size,
                seed=grains.seed if grains is not None else None,
                petsc=solver_options(),
            )
            write_json(self.folder.file("provenance.json"), about | {"wall_seconds": self.seconds | self.model.seconds})

    def say(self, sentences: list[str]) -> None:
        """Notes to the user, kept in the log."""
        for sentence in (in_units(each, self.built.scene.units) for each in sentences):
            self.log(f"note: {sentence}")
            if self.comm.rank == 0:
                print(f"leito: note: {sentence}", file=sys.stderr, flush=True)

    def log(self, text: str) -> None:
        """A line of the log."""
        if self.comm.rank == 0:
            with open(self.folder.file("log.txt"), "a") as log:
                log.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {text}\n")


def _clocks() -> NDArray[np.float64]:
    return np.array([time.perf_counter(), time.process_time()])
