"""What a run adds to its grains, per grain and step: structure, exchange, watchdogs, rows, frames, checkpoints."""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from unittest import mock

import beds
import coupled_share
import numpy as np
from features import FULL, Cost
from mpi4py import MPI

from coupled.build import Built
from coupled.model import Model
from coupled.output.folder import open_folder
from coupled.running.guard import LOOK, Guard
from coupled.running.observe import observe
from coupled.running.record import Record
from coupled.running.schedule import Every
from coupled.scene import Scene, load_scene
from particles import box, continued
from particles.state import Grains

ROUNDS, STEPS = 9, 200
SCENE = "bed"


def of_structure() -> list[Cost]:
    """Structure and exchange of the tube pressed into the bed, one structural step per grain step."""
    found = []
    model = coupled_share.pressed(beds.reference(), 1)
    n, taken = model.particles.grains.n_free, {name: [] for name in coupled_share.PARTS}
    with mock.patch.object(time, "perf_counter", time.thread_time):  # which other processes do not lengthen
        for _ in range(ROUNDS):
            before = dict(model.seconds)
            model.advance(STEPS)
            for name in taken:
                taken[name].append(1e9 * (model.seconds[name] - before[name]) / (STEPS * n))
    grains = float(np.median(taken["grains"]))
    for name, part in (("elastic structure", "structure"), ("exchange with 180 glued grains", "exchange")):
        low, added, high = np.quantile(taken[part], [0.25, 0.5, 0.75]).tolist()
        found.append(Cost(name, "grains under a tube", grains + added, added, low, high, 100.0 * added / grains))
    return found


def of_output(whole: float) -> list[Cost]:
    """What the run of a bed writes and watches, at the intervals of its scene; `whole` is its step [ns per grain]."""
    scene = load_scene(SCENE)
    with tempfile.TemporaryDirectory() as folder:
        record = _record(scene, Path(folder) / "run")
        return [_spread(name, steps, act, whole, record.model) for name, steps, act in _acts(scene, record)]


def _record(scene: Scene, folder: Path) -> Record:
    saved = beds.reference()
    grains = Grains.from_saved(saved)
    system = continued(
        saved, grains, beds.FULL, time_step=scene.time.step, walls=box(beds.WIDTH, beds.HEIGHT), gravity=scene.gravity
    )
    model = Model(particles=system, time_step=scene.time.step)
    built = Built(model, scene, system.contact, 0.0, 0.0)
    return Record(built, open_folder(folder, scene, resume=False, overwrite=False), MPI.COMM_WORLD, {})


def _acts(scene: Scene, record: Record) -> list[tuple[str, int, Callable[[], object]]]:
    """What is done, and after how many steps each time."""
    output, model = scene.output, record.model
    guard = Guard(model, record.start, MPI.COMM_WORLD)
    seen = observe(model, record.start)
    last = round(scene.time.duration / scene.time.step)

    def every(interval: float) -> int:
        return Every.seconds(interval, scene.time.step, last).interval

    return [
        ("watchdogs", LOOK, guard.keep),
        (
            "history",
            every(output.history_interval),
            lambda: record.write(observe(model, record.start), row=True, frame=False),
        ),
        ("frames", every(1.0 / output.frames_per_second), lambda: record.write(seen, row=False, frame=True)),
        ("checkpoints", every(output.checkpoint_interval), lambda: record.save(model.state(), seen.balance.entries)),
    ]


def _spread(name: str, steps: int, act: Callable[[], object], whole: float, model: Model) -> Cost:
    taken = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        act()
        taken.append(1e9 * (time.perf_counter() - begin) / (steps * model.particles.grains.n_free))
    low, added, high = np.quantile(taken, [0.25, 0.5, 0.75]).tolist()
    return Cost(f"{name}, every {steps} steps", FULL, whole + added, added, low, high, 100.0 * added / whole)


def costs(whole: float) -> list[Cost]:
    """All that this module measures."""
    return [*of_structure(), *of_output(whole)]
