"""Run a scene: settle its bed, advance the model from one due event to the next, write what is due."""

from __future__ import annotations

import contextlib
import json
import os
import sys
import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mpi4py import MPI

from coupled import bed as beds
from coupled.build import Built, build
from coupled.errors import Interrupted, is_sentence
from coupled.output import checkpoint
from coupled.output.folder import BEFORE_FAILURE, SUMMARY, RunFolder, finished, open_folder
from coupled.output.lock import only_process
from coupled.output.provenance import write_json
from coupled.quantities import known_of
from coupled.report import cautions
from coupled.report.contact import contact_sentences
from coupled.report.preset import preset_sentences
from coupled.report.summary import summarise, tell
from coupled.running.guard import LOOK, Failed, Guard
from coupled.running.interrupt import Stop
from coupled.running.observe import Observation, observe
from coupled.running.progress import RunProgress
from coupled.running.ranks import LeaveTogether, on_root, root_alone, together
from coupled.running.record import Record
from coupled.running.remedy import remedy
from coupled.running.schedule import Events, Every
from coupled.running.watchdog import Glance, Unstable, overturned_cell
from coupled.scene import Scene
from coupled.scene.units import in_units, told_in
from coupled.step import with_step
from particles.beds import rest_ratio


def run_scene(
    scene: Scene,
    *,
    out: Path,
    resume: bool = False,
    threads: int | None = None,
    overwrite: bool = False,
    progress: bool = True,
    comm: MPI.Intracomm = MPI.COMM_WORLD,
    stop: Stop | None = None,
    shared: Path | None = None,
) -> Path:
    """Run a scene to its end and return its folder.

    Parameters
    ----------
    scene : Scene
    out : Path
        Folder of the run; refused if it holds one, unless `resume` or `overwrite`, and while another process
        writes into it.
    threads : int, optional
        For the grains; all cores by default, shared among the ranks.
    stop : Stop, optional
        The wish of one who makes many runs; by default the run listens itself.
    shared : Path, optional
        Folder whose `beds` are shared with other runs; the one above `out` by default.

    Raises
    ------
    Interrupted
        After Ctrl-C, when the checkpoint is written.
    Unstable
        When a watchdog has stopped the run, and the last good state is written.
    LeitoError and the errors of the rooms
        One sentence.
    """
    with told_in(scene.units):
        scene = with_step(scene)
    threads = threads or max(1, (os.cpu_count() or 1) // comm.size)
    with LeaveTogether(comm), told_in(scene.units), _holding(comm, out, waits=False):
        way = Way(threads=threads, progress=progress, comm=comm, stop=stop, shared=shared or out.parent)
        return _run(scene, out, resume, overwrite, way)


@dataclass(frozen=True, kw_only=True)
class Way:
    """How a run and that of its bed are made; see `run_scene`."""

    threads: int
    progress: bool
    comm: MPI.Intracomm
    stop: Stop | None
    shared: Path


def _run(scene: Scene, out: Path, resume: bool, overwrite: bool, way: Way) -> Path:
    """Run a scene in a folder that this process holds."""
    comm, seconds, settled = way.comm, {"bed": 0.0}, None
    if scene.bed is not None:
        started = time.perf_counter()
        settled = _settled(scene, way)
        seconds["bed"] = time.perf_counter() - started
    folder = on_root(comm, lambda: open_folder(out, scene, resume=resume, overwrite=overwrite))
    if on_root(comm, lambda: folder.saved is not None and finished(folder.path, scene)):
        if comm.rank == 0:
            _tell_again(folder, scene)
        return folder.path
    started = time.perf_counter()
    built = together(comm, lambda: build(scene, bed=settled, threads=way.threads, comm=comm))
    root_alone(comm, lambda: folder.take(scene))
    run = Run(built, folder, comm, seconds)
    run.record.seconds["setup"] = time.perf_counter() - started
    run.go(progress=way.progress, stop=way.stop)
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
        self.last = max(1, round(self.scene.time.duration / self.model.window))
        self.events = _events(self.scene, self.model.window, self.model.substeps, self.last)
        if self.model.particles is not None:
            self.model.particles.advance(0)  # compiles, or finds the compiled code
        self.record = Record(built, folder, comm, seconds)

    def go(self, *, progress: bool, stop: Stop | None = None) -> None:
        """Advance to the end, to Ctrl-C, or to the first sign that something is wrong."""
        record, model = self.record, self.model
        record.say(cautions.before(self.built))
        for sentence in [*preset_sentences(self.scene), *contact_sentences(self.scene)]:
            record.log(in_units(sentence, self.scene.units))
        record.write_provenance()
        wanted = progress and self.comm.rank == 0
        listening = Stop() if stop is None else contextlib.nullcontext(stop)
        record.begin()
        with listening as stop, RunProgress(self.scene.title, self.last, model.steps_done, wanted=wanted) as bar:
            seen = observe(model, record.start)
            guard = Guard(model, record.start, self.comm)
            if not record.resumed:
                record.write(seen, row=True, frame=self.events.frames is not None)
            try:
                while model.steps_done < self.last:
                    guard.advance(self.events.next(model.steps_done) - model.steps_done)
                    seen = self._look(guard, seen)
                    bar.update(model.steps_done, in_units(f"t = {model.time:.3f} s", self.scene.units))
                    if self.comm.allreduce(int(stop.asked), op=MPI.MAX):
                        self._interrupt(guard)
            except Failed as failed:
                self._fail(failed)
        self._finish(seen)

    def _look(self, guard: Guard, seen: Observation) -> Observation:
        """Do what is due now: observe and write, or only look and keep the state in memory."""
        step, started = self.model.steps_done, time.perf_counter()
        if self.events.writes(step):
            seen = observe(self.model, self.record.start)
            beyond = cautions.beyond_meaning_of_theory(self.built, seen.numbers)
            guard.check(Glance(seen.balance, seen.look, overturned_cell(self.model), beyond))
            self.record.count(seen)
            self._end_at_rest(seen)
            self._write_due(seen)
        if self.events.looks.due(step):
            guard.keep()
        self.record.seconds["output"] += time.perf_counter() - started
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

    def _write_due(self, seen: Observation) -> None:
        step, ended, events = self.model.steps_done, self.model.steps_done == self.last, self.events
        framed = events.frames is not None and (ended or events.frames.due(step))
        self.record.write(seen, row=ended or events.history.due(step), frame=framed)
        if ended or events.checkpoints.due(step):
            self.record.save(self.model.state(), seen.balance.entries)

    def _interrupt(self, guard: Guard) -> None:
        good = guard.keep()
        self.record.save(self.model.state(), good.glance.balance.entries)
        sentence = f"stopped at t = {self.model.time:g} s of {self.scene.time.duration:g} s; go on with --resume"
        self.record.log(in_units(sentence, self.scene.units))
        raise Interrupted(sentence)

    def _fail(self, failed: Failed) -> None:
        """Leave the last good state and the last sound picture, and say what went wrong and what to change."""
        model, record, good = self.model, self.record, failed.good
        record.save(failed.state, good.glance.balance.entries, BEFORE_FAILURE)
        row, frame = on_root(self.comm, lambda: record.lacks(model.time))
        record.write(observe(model, record.start), row=row, frame=frame and self.events.frames is not None)
        change = on_root(self.comm, lambda: remedy(self.built, failed.sign))
        sentence = (
            f"t = {failed.time:g} s, the run is unstable: {failed.sign.what}. To change: {change}. The state at "
            f"t = {good.step * model.window:g} s, before that, is in {self.folder.file(BEFORE_FAILURE)}: --resume goes "
            f"on from there, also with --set time.step at a whole fraction of {self.scene.time.step:g} s"
        )
        record.log(in_units(sentence, self.scene.units))
        raise Unstable(sentence) from None

    def _finish(self, seen: Observation) -> None:
        record, model = self.record, self.model
        record.say(list(cautions.beyond_theory(self.built, record.peaks).values()))
        if self.comm.rank != 0:
            return
        stepping, started = record.stepping, time.perf_counter()
        free = model.particles.grains.n_free if model.particles is not None else 0
        peaks = record.peaks | {"particle_steps": free * model.steps_done * model.substeps}
        pictures = self._draw() if self.scene.output.figures else []
        record.seconds["output"] += time.perf_counter() - started
        summary = summarise(self.built, seen, record.first, peaks, record.seconds | model.seconds, stepping)
        summary["quantities"], unknown = known_of(self.scene, self.folder.path)
        for sentence in unknown:
            record.log(f"note: {sentence}")
        write_json(self.folder.file(SUMMARY), summary)
        record.write_provenance()
        text = tell(summary, pictures, self.folder.path, self.scene)
        record.log(text)
        print(text, flush=True)

    def _draw(self) -> list[Path]:
        """Draw the figures. A picture that fails must not cost the run what it came to."""
        from coupled.report.figures import plot_run  # matplotlib is not loaded for a run without figures

        try:
            return plot_run(self.folder.path)
        except Exception as error:
            self.record.log("".join(traceback.format_exception(error)))
            what = str(error) if is_sentence(error) else f"{type(error).__name__}: {error}; a defect of the program"
            self.record.say([f"not all figures are drawn: {what}"])
            return sorted(self.folder.file("figures").glob("*.png"))


def _tell_again(folder: RunFolder, scene: Scene) -> None:
    """Tell what a finished run came to, with the quantities that its scene asks for now."""
    pictures = sorted((folder.path / "figures").glob("*.png"))
    summary = json.loads(folder.file(SUMMARY).read_text())
    summary["quantities"], _ = known_of(scene, folder.path)
    write_json(folder.file(SUMMARY), summary)
    print(tell(summary, pictures, folder.path, scene))


def _events(scene: Scene, window: float, substeps: int, last: int) -> Events:
    """What is due when, in steps of length `window` [s]."""
    output = scene.output
    frames = None
    if output.frames_per_second > 0.0:
        frames = Every.seconds(1.0 / output.frames_per_second, window, last)
    return Events(
        history=Every.seconds(output.history_interval, window, last),
        frames=frames,
        checkpoints=Every.seconds(output.checkpoint_interval, window, last),
        looks=Every(max(1, LOOK // substeps), last),
    )


@contextlib.contextmanager
def _holding(comm: MPI.Intracomm, folder: Path, *, waits: bool) -> Iterator[None]:
    """Hold a folder on rank 0, for all ranks."""

    def wait() -> None:
        print(f"leito: waiting for another process that settles the bed in {folder}", file=sys.stderr, flush=True)

    with contextlib.ExitStack() as held:
        root_alone(comm, lambda: held.enter_context(only_process(folder, wait if waits else None)))
        yield


def _settled(scene: Scene, way: Way) -> dict[str, Any] | None:
    """State of the bed, settled now if no scene beside this one has done it or is doing it."""
    comm, folder = way.comm, beds.bed_folder(scene, way.shared)
    if not on_root(comm, lambda: (folder / SUMMARY).exists()):
        with _holding(comm, folder, waits=True):
            begun = on_root(comm, lambda: (folder / checkpoint.NAME).exists())
            if not on_root(comm, lambda: (folder / SUMMARY).exists()):
                _run(scene.bed, folder, begun, not begun, way)
    return beds.settled_state(folder) if comm.rank == 0 else None
