"""The cost of features in one scene, measured: short runs of the scene and of the scene without a feature, in turns."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from coupled.build import build
from coupled.errors import LeitoError, SceneError
from coupled.model import Model
from coupled.report import modelled as m
from coupled.scene import Scene

ROUNDS = 7
STEPS_OF_MANY, MANY = 50, 1000  # grains; fewer take ten times as many steps
OF_FRICTION, OF_ROLLING = ("friction", "tangential_"), ("rolling",)

Tables = dict[str, Any]


class Measured(NamedTuple):
    """Share of the time of a step [-], median and quartiles of the rounds."""

    share: float
    low: float
    high: float


def measured_shares(scene: Scene, bed: Mapping[str, NDArray[Any]] | None) -> dict[str, Measured]:
    """Shares of the features that can be left out of a scene, by name; on one thread, in processor time.

    Every round goes back to the same moment, so that both ways begin with the same contacts.

    Raises
    ------
    LeitoError
        Under MPI.
    """
    if MPI.COMM_WORLD.size > 1:
        raise LeitoError("--measure takes its times on one process: leave out mpirun")
    turns = {name: _Turn(build(tried, bed=bed).model) for name, tried in _ways(scene)}
    whole = turns.pop("")
    taken: dict[str, list[float]] = {name: [] for name in turns}
    for _ in range(ROUNDS):
        beside = whole.seconds()
        for name, turn in turns.items():
            taken[name].append(1.0 - turn.seconds() / beside)
    return {name: Measured(*np.quantile(values, [0.5, 0.25, 0.75]).tolist()) for name, values in taken.items()}


class _Turn:
    """One model, always taken through the same steps."""

    def __init__(self, model: Model) -> None:
        self._model = model
        many = model.particles is not None and model.particles.grains.n_free > MANY
        self._steps = STEPS_OF_MANY if many else 10 * STEPS_OF_MANY
        model.advance(1)  # loads the compiled code
        self._moment = model.snapshot()

    def seconds(self) -> float:
        self._model.rewind(self._moment)
        begin = time.thread_time()
        self._model.advance(self._steps)
        return time.thread_time() - begin


def _ways(scene: Scene) -> Iterator[tuple[str, Scene]]:
    """The scene (""), and the scene without each of its features that can be taken out of it."""
    yield "", scene
    for name, take_out in _TAKEN_OUT.items():
        if name in m.models(scene):
            tables = scene.model_dump(exclude_none=True)
            take_out(tables)
            try:
                yield name, Scene.model_validate(tables)
            except (SceneError, ValueError):
                continue  # it needs the feature


def _without(names: tuple[str, ...]) -> Callable[[Tables], None]:
    """Takes all keys that begin so out of the contact law and its pairs."""

    def take_out(tables: Tables) -> None:
        contact = tables["contact"]
        for table in (contact, *contact.get("pairs", ())):
            for key in [key for key in table if key.startswith(names)]:
                del table[key]
        contact["pairs"] = [pair for pair in contact.get("pairs", ()) if len(pair) > 1]

    return take_out


def _materials(tables: Tables) -> None:
    tables["contact"]["pairs"] = []
    tables["contact"].pop("materials", None)


def _damping(tables: Tables) -> None:
    del tables["damping"]


def _walls(tables: Tables) -> None:
    tables["box"]["walls"] = []


def _leapfrog(tables: Tables) -> None:
    tables["time"]["integrator"] = "leapfrog"


_TAKEN_OUT: dict[str, Callable[[Tables], None]] = {
    m.FRICTION: _without(OF_FRICTION + OF_ROLLING),
    m.ROLLING: _without(OF_ROLLING),
    m.MATERIALS: _materials,
    m.DAMPING: _damping,
    m.WALLS: _walls,
    m.VERLET: _leapfrog,
}
