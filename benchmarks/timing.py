"""Taking times: runs that are compared take turns, and medians are kept."""

import statistics
import time
from collections.abc import Callable, Hashable, Mapping
from typing import TypeVar
from unittest import mock

from particles import ParticleSystem

Task = Callable[[], float]
Name = TypeVar("Name", bound=Hashable)


def seconds(system: ParticleSystem, steps: int) -> float:
    """Wall time of `steps` steps."""
    begin = time.perf_counter()
    system.advance(steps)
    return time.perf_counter() - begin


def per_particle_step(system: ParticleSystem, steps: int) -> Task:
    """A task that takes `steps` steps and returns the time of one step of one disc [s]."""
    return lambda: seconds(system, steps) / (steps * len(system.grains))


def rebuild_share(system: ParticleSystem, steps: int) -> float:
    """Share of the wall time of `steps` steps that goes into new contact lists [%]."""
    spent, rebuild = 0.0, system._rebuild

    def timed() -> None:
        nonlocal spent
        begin = time.perf_counter()
        rebuild()
        spent += time.perf_counter() - begin

    with mock.patch.object(system, "_rebuild", timed):
        whole = seconds(system, steps)
    return 100.0 * spent / whole


def interleaved(tasks: Mapping[Name, Task], rounds: int) -> dict[Name, float]:
    """Median of each task over rounds in which all tasks take turns, after one round unrecorded."""
    taken: dict[Name, list[float]] = {name: [] for name in tasks}
    for turn in range(rounds + 1):
        for name, task in tasks.items():
            value = task()
            if turn > 0:
                taken[name].append(value)
    return {name: statistics.median(values) for name, values in taken.items()}
