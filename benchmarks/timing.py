"""Taking times: runs that are compared take turns, and medians are kept."""

import statistics
import time
from collections.abc import Callable, Mapping

from particles import ParticleSystem

Task = Callable[[], float]


def seconds(system: ParticleSystem, steps: int) -> float:
    """Wall time of `steps` steps."""
    begin = time.perf_counter()
    system.advance(steps)
    return time.perf_counter() - begin


def per_particle_step(system: ParticleSystem, steps: int) -> Task:
    """A task that takes `steps` steps and returns the time of one step of one disc [s]."""
    return lambda: seconds(system, steps) / (steps * len(system.grains))


def interleaved(tasks: Mapping[str, Task], rounds: int) -> dict[str, float]:
    """Median of each task over rounds in which all tasks take turns, after one round unrecorded."""
    taken: dict[str, list[float]] = {name: [] for name in tasks}
    for turn in range(rounds + 1):
        for name, task in tasks.items():
            value = task()
            if turn > 0:
                taken[name].append(value)
    return {name: statistics.median(values) for name, values in taken.items()}
