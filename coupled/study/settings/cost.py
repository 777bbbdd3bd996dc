"""What a setting will cost, from one short trial of the base and from what the scenes say."""

from __future__ import annotations

import time
from typing import NamedTuple

from coupled.build import build
from coupled.report.check import SETTLED_OVER_LOOSE, on_lattice
from coupled.scene import Scene
from coupled.scene.shape import Tube
from coupled.step import with_step

TRIED_SECONDS = 1.0  # of a trial
THEORY = {None: 1.0, "linear": 1.0, "corotational": 8.0, "large_strain": 35.0}  # of a step, over the linear one
ITERATIONS = 2.5  # of an iterated exchange
GROWTH = 1.1  # power of the number of nodes with which a step of the structure grows


class Trial(NamedTuple):
    """Cost of the base: seconds of its run, and the shares of its parts [s, -, -]."""

    seconds: float
    grains: float
    structure: float


def try_out(scene: Scene) -> Trial:
    """Time some steps of a scene in this process, its grains on their lattice if it stands on a bed.

    The code that it needs is compiled before.
    """
    loose = on_lattice(scene)
    model = build(loose).model
    model.advance(1)
    before = dict(model.seconds)
    started, steps = time.perf_counter(), 0
    while steps == 0 or (time.perf_counter() - started < TRIED_SECONDS and steps * model.window < scene.time.duration):
        model.advance(20)
        steps += 20
    spent = {name: seconds - before[name] for name, seconds in model.seconds.items()}
    if loose is not scene:
        spent["grains"] *= SETTLED_OVER_LOOSE
    total = max(sum(spent.values()), 1e-9)
    share = {name: seconds / total for name, seconds in spent.items()}
    whole = total / steps * scene.time.duration / model.window
    return Trial(whole, share["grains"], share["structure"])


def work(scene: Scene, base: Scene, trial: Trial, threads: int = 1) -> float:
    """Estimate the cost of a run over that of the base [-]."""
    mine, other = _Size.of(scene), _Size.of(base)
    rest = 1.0 - trial.grains - trial.structure
    grains = mine.grains / other.grains / threads
    body = (mine.nodes / other.nodes) ** GROWTH * mine.theory / other.theory
    windows = mine.windows / other.windows
    parts = trial.grains * grains * mine.steps / other.steps + (trial.structure * body + rest) * windows
    return parts * mine.iterations / other.iterations


class _Size(NamedTuple):
    steps: float
    windows: float
    grains: float
    nodes: float
    theory: float
    iterations: float

    @classmethod
    def of(cls, scene: Scene) -> _Size:
        scene = with_step(scene)
        steps = scene.time.duration / scene.time.step
        interface, body = scene.interface, scene.structure
        nodes = 1.0
        if body is not None and body.kind == "elastic":
            shape = body.shape
            cells = shape.around * shape.layers if isinstance(shape, Tube) else shape.along * shape.across
            nodes = float(cells * shape.order**2)
        return cls(
            steps=steps,
            windows=steps if interface is None else steps / interface.substeps,
            grains=float(scene.first_grains.count if scene.first_grains is not None else 1),
            nodes=nodes,
            theory=THEORY[body.theory] if body is not None else 1.0,
            iterations=ITERATIONS if interface is not None and interface.exchange == "iterated" else 1.0,
        )
