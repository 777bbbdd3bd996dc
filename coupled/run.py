"""Run a scene: settle its bed, advance the model from one due event to the next, write what is due."""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any, TypeVar

import numpy as np
from mpi4py import MPI

from coupled import bed as beds
from coupled import cautions
from coupled.build import Built, build
from coupled.contact_report import contact_sentences
from coupled.errors import Interrupted
from coupled.observe import Observation, observe
from coupled.output import checkpoint
from coupled.output.folder import SUMMARY, RunFolder, open_folder
from coupled.output.provenance import provenance, write_json
from coupled.output.writers import Writers
from coupled.progress import RunProgress
from coupled.scene import Scene
from coupled.schedule import Every
from coupled.step import with_step
from coupled.summary import summarise, tell
from coupled.watchdog import watch
from particles.beds import rest_ratio
from structure import solver_options

Result = TypeVar("Result")
PEAKS = (
    "max_von_mises", "max_strain", "momentum_residual", "reaction_y", "rotation", "local_rotation", "compression",
)  # fmt: skip
LONGEST_CHUNK = 2000  # steps between two looks at Ctrl-C


def run_scene(
    scene: Scene,
    *,
    out: Path,
    resume: bool = False,
    threads: int | None = None,
    overwrite: bool = False,
    progress: bool = True,
    comm: MPI.Intracomm = MPI.COMM_WORLD,
) -> Path:
    """Run a scene to its end and return its folder.

    Parameters
    ----------
    scene : Scene
    out : Path
        Folder of the run; refused if it holds one, unless `resume` or `overwrite`.
    threads : int, optional
        For the grains; all cores by default, shared among the ranks.

    Raises
    ------
    Interrupted
        After Ctrl-C, when the checkpoint is written.
    LeitoError and the errors of the rooms
        One sentence.
    """
    scene = with_step(scene)
    threads = threads or max(1, (os.cpu_count() or 1) // comm.size)
    seconds = {"bed": 0.0}
    settled = None
    if scene.bed is not None:
        started = time.perf_counter()
        settled = _settled(scene, out, threads, progress, comm)
        seconds["bed"] = time.perf_counter() - started
    folder = _on_root(comm, lambda: open_folder(out, scene, resume=resume, overwrite=overwrite))
    finished = _on_root(comm, lambda: _finished(folder, scene))
    if finished:
        if comm.rank == 0:
            pictures = sorted((folder.path / "figures").glob("*.png"))
            print(tell(json.loads(folder.file(SUMMARY).read_text()), pictures, folder.path))
        return folder.path
    started = time.perf_counter()
    built = _together(comm, lambda: build(scene, bed=settled, threads=threads, comm=comm))
    _on_root(comm, lambda: folder.take(scene))
    run = Run(built, folder, comm, seconds)
    run.seconds["setup"] = time.perf_counter() - started
    run.go(progress=progress)
    return folder.path


class Run:
    """A model on its way through its duration, with the files it leaves.

    Parameters
    ----------
    built : Built
    folder : RunFolder
    comm : MPI communicator
    seconds : dict
        Wall time per part [s] so far.
    """

    def __init__(self, built: Built, folder: RunFolder, comm: MPI.Intracomm, seconds: dict[str, float]) -> None:
        self.built, self.model, self.scene = built, built.model, built.scene
        self.folder, self.comm = folder, comm
        self.seconds = seconds | {"output": 0.0}
        output, window = self.scene.output, self.model.window
        self.last = max(1, round(self.scene.time.duration / window))
        self.history = Every.seconds(output.history_interval, window, self.last)
        self.frames = None
        if output.frames_per_second > 0.0:
            self.frames = Every.seconds(1.0 / output.frames_per_second, window, self.last)
        self.checkpoints = Every.seconds(output.checkpoint_interval, window, self.last)
        if self.model.particles is not None:
            self.model.particles.advance(0)  # compiles, or finds the compiled code
        self._begin()

    def _begin(self) -> None:
        """First observation, or the state and the sums of the checkpoint."""
        seen = observe(self.model, None)
        self.start = seen.balance.entries
        self.first = {name: seen.numbers.get(name, 0.0) for name in ("centroid_y",)}
        self.peaks = dict.fromkeys(PEAKS, 0.0)
        self.warned: set[str] = set()
        saved = self.comm.bcast(self.folder.saved, root=0)
        self.resumed = saved is not None
        if saved is not None:
            self.model.restore(saved)
            self.start = dict(zip(self.start, saved["run.start"].tolist(), strict=True))
            self.first = dict(zip(self.first, saved["run.first"].tolist(), strict=True))
            self.peaks |= dict(zip(PEAKS, saved["run.peaks"].tolist(), strict=False))  # older runs kept fewer
            for name, spent in json.loads(bytes(saved["run.seconds"]).decode()).items():
                into = self.model.seconds if name in self.model.seconds else self.seconds
                into[name] = into.get(name, 0.0) + spent
        self.writers = None
        if self.comm.rank == 0:
            self.writers = Writers(self.folder.path, self.model, keep_until=self.model.time if self.resumed else None)

    def go(self, *, progress: bool) -> None:
        """Advance to the end, or to Ctrl-C."""
        self._say(cautions.before(self.built))
        for sentence in contact_sentences(self.scene):
            self._log(sentence)
        self._write_provenance()
        with (
            _Stop() as stop,
            RunProgress(
                self.scene.title, self.last, self.model.steps_done, wanted=progress and self.comm.rank == 0
            ) as bar,
        ):
            seen = observe(self.model, self.start)
            self._on_root_alone(lambda: watch(self.model, seen))
            if not self.resumed:
                self._write_due(seen, first=True)
            while self.model.steps_done < self.last:
                step = self.model.steps_done
                due = min(s.next(step) for s in (self.history, self.frames, self.checkpoints) if s is not None)
                self.model.advance(min(due - step, LONGEST_CHUNK))
                seen = self._look(seen)
                bar.update(self.model.steps_done, f"t = {self.model.time:.3f} s")
                if self.comm.allreduce(int(stop.asked), op=MPI.MAX):
                    self._interrupt()
        self._finish(seen)

    def _look(self, seen: Observation) -> Observation:
        """Observe and write what is due now."""
        step, started = self.model.steps_done, time.perf_counter()
        events = (self.history, self.frames, self.checkpoints)
        if any(event is not None and event.due(step) for event in events):
            seen = observe(self.model, self.start)
            for name in PEAKS:
                self.peaks[name] = max(self.peaks[name], abs(seen.numbers.get(name, 0.0)))
            self._warn(seen)
            self._on_root_alone(lambda: watch(self.model, seen))
            self._end_at_rest(seen)
            self._write_due(seen)
        self.seconds["output"] += time.perf_counter() - started
        return seen

    def _end_at_rest(self, seen: Observation) -> None:
        """Make this step the last one if the grains have come to rest."""
        wanted = self.scene.time.stop_at_rest
        if wanted is None:
            return
        ratio = None
        if self.model.particles is not None:
            ratio = rest_ratio(self.model.particles.grains, self.scene.gravity, seen.numbers["grains_kinetic"])
        if self.comm.bcast(ratio, root=0) < wanted:
            self.last = self.model.steps_done

    def _write_due(self, seen: Observation, *, first: bool = False) -> None:
        step, ended = self.model.steps_done, self.model.steps_done == self.last
        fields = None
        if self.frames is not None and (first or ended or self.frames.due(step)) and self.model.structure is not None:
            fields = self.model.structure.fields()
        if self.writers is not None:
            if first or ended or self.history.due(step):
                self.writers.history.write(seen.row())
            if self.frames is not None and (first or ended or self.frames.due(step)):
                self.writers.write_frame(self.model, seen, fields)
        if not first and (ended or self.checkpoints.due(step)):
            self._checkpoint()

    def _checkpoint(self) -> None:
        state = self.model.state()
        if self.comm.rank == 0:
            spent = json.dumps(self.seconds | self.model.seconds).encode()
            state |= {
                "run.start": np.array(list(self.start.values())),
                "run.first": np.array(list(self.first.values())),
                "run.peaks": np.array(list(self.peaks.values())),
                "run.seconds": np.frombuffer(spent, np.uint8),
            }
            checkpoint.save(self.folder.file(checkpoint.NAME), state, scene=self.scene.title)

    def _interrupt(self) -> None:
        seen = observe(self.model, self.start)
        self._on_root_alone(lambda: watch(self.model, seen))
        self._checkpoint()
        sentence = f"stopped at t = {self.model.time:g} s of {self.scene.time.duration:g} s; go on with --resume"
        self._log(sentence)
        raise Interrupted(sentence)

    def _finish(self, seen: Observation) -> None:
        self._say(list(cautions.beyond_theory(self.built, self.peaks).values()))
        if self.comm.rank != 0:
            return
        started = time.perf_counter()
        free = self.model.particles.grains.n_free if self.model.particles is not None else 0
        peaks = self.peaks | {"particle_steps": free * self.model.steps_done * self.model.substeps}
        pictures = []
        if self.scene.output.figures:
            from coupled.figures import plot_run  # matplotlib is not loaded for a run without figures

            pictures = plot_run(self.folder.path)
        self.seconds["output"] += time.perf_counter() - started
        summary = summarise(self.built, seen, self.first, peaks, self.seconds | self.model.seconds)
        write_json(self.folder.file(SUMMARY), summary)
        self._write_provenance()
        text = tell(summary, pictures, self.folder.path)
        self._log(text)
        print(text, flush=True)

    def _write_provenance(self) -> None:
        if self.comm.rank == 0:
            grains = self.scene.first_grains
            threads = self.model.particles.threads if self.model.particles is not None else 0
            seed = grains.seed if grains is not None else None
            about = provenance(threads=threads, ranks=self.comm.size, seed=seed, petsc=solver_options())
            write_json(self.folder.file("provenance.json"), about | {"wall_seconds": self.seconds | self.model.seconds})

    def _warn(self, seen: Observation) -> None:
        """Say once of each quantity that it leaves the theory in use, when it is first seen."""
        beyond = cautions.beyond_theory(self.built, seen.numbers)
        self._say([f"t = {self.model.time:g} s: {beyond[name]}" for name in beyond if name not in self.warned])
        self.warned |= beyond.keys()

    def _say(self, sentences: list[str]) -> None:
        for sentence in sentences:
            self._log(f"note: {sentence}")
            if self.comm.rank == 0:
                print(f"leito: note: {sentence}", file=sys.stderr, flush=True)

    def _log(self, text: str) -> None:
        if self.comm.rank == 0:
            with open(self.folder.file("log.txt"), "a") as log:
                log.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {text}\n")

    def _on_root_alone(self, action: Callable[[], Result]) -> None:
        _on_root(self.comm, lambda: action() and None)


class _Stop:
    """Ctrl-C asks for a stop at the next event; a second one stops at once."""

    asked = False

    def __enter__(self) -> _Stop:
        self._before = signal.signal(signal.SIGINT, self._ask)
        return self

    def __exit__(self, *error: Any) -> None:
        signal.signal(signal.SIGINT, self._before)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True


def _settled(scene: Scene, out: Path, threads: int, progress: bool, comm: MPI.Intracomm) -> dict[str, Any] | None:
    """State of the bed, settled now if no scene beside this one has done it."""
    folder = beds.bed_folder(scene, out.parent)
    begun = comm.bcast((folder / checkpoint.NAME).exists(), root=0)
    if not _on_root(comm, lambda: (folder / SUMMARY).exists()):
        run_scene(
            scene.bed, out=folder, resume=begun, overwrite=not begun, threads=threads, progress=progress, comm=comm
        )
    return beds.settled_state(folder) if comm.rank == 0 else None


def _finished(folder: RunFolder, scene: Scene) -> bool:
    """Whether the run in a folder that is taken up again has nothing left to do."""
    if folder.saved is None or not folder.file(SUMMARY).exists():
        return False
    done = json.loads(folder.file(SUMMARY).read_text())["simulated_seconds"]
    return scene.time.stop_at_rest is not None or done >= scene.time.duration * (1.0 - 1e-9)


def _on_root(comm: MPI.Intracomm, action: Callable[[], Result]) -> Result:
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


def _together(comm: MPI.Intracomm, action: Callable[[], Result]) -> Result:
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
