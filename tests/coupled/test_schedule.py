"""When rows and frames are due."""

import numpy as np
import pytest

from coupled.running.schedule import Every


def steps_of(every: Every) -> list[int]:
    found = [0]
    while found[-1] < every.last:
        found.append(every.next(found[-1]))
    return found


@pytest.mark.parametrize("interval", [1, 7, 250])
def test_whole_intervals_are_multiples_and_the_end(interval: int) -> None:
    assert steps_of(Every(interval, 1003)) == [*range(0, 1003, interval), 1003]


@pytest.mark.parametrize(("seconds", "window"), [(1.0, 0.003465735), (0.4, 0.003465735), (0.0125, 0.01), (1e-2, 2e-5)])
def test_what_is_due_keeps_its_time(seconds: float, window: float) -> None:
    """Half a step at most after a hundred thousand of them; whole numbers of steps would drift away."""
    every = Every.seconds(seconds, window, 100_000)
    steps = np.array(steps_of(every))
    due = np.arange(len(steps) - 1) * seconds / window
    assert np.abs(steps[:-1] - due).max() < 0.5 + 1e-6
    assert np.diff(steps).min() >= 1 and steps[-1] == 100_000


@pytest.mark.parametrize("interval", [1.0, 1.25, 2.5, 115.417, 1e9])
def test_due_and_next_say_the_same(interval: float) -> None:
    every = Every(interval, 1000)
    steps = steps_of(every)
    assert [step for step in range(1001) if every.due(step)] == steps
    assert all(every.next(step) == min(due for due in steps if due > step) for step in range(1000))


def test_no_interval_is_shorter_than_a_step_or_longer_than_the_run() -> None:
    assert steps_of(Every.seconds(1e-9, 1e-3, 5)) == [0, 1, 2, 3, 4, 5]
    assert steps_of(Every.seconds(1e9, 1e-3, 5)) == [0, 5]
