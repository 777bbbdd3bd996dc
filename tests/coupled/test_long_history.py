"""The history of a long run: read to the bit, in memory of the size of its numbers, taken up in less."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from coupled.output.history import History, read_history

ROWS, COLUMNS = 4000, 30


@pytest.fixture(scope="module")
def table() -> np.ndarray:
    """Times, and numbers of all sizes."""
    rng = np.random.default_rng(5)
    numbers = rng.normal(size=(ROWS, COLUMNS)) * 10.0 ** rng.integers(-300, 300, (ROWS, COLUMNS))
    numbers[:, 0] = 0.1 * np.arange(ROWS)
    return numbers


@pytest.fixture
def path(table: np.ndarray, tmp_path: Path) -> Path:
    """They as rows of a history, and the beginning of one more that a kill has cut."""
    history = History(tmp_path / "history.csv")
    names = ["time [s]", *(f"column_{k} [J/m]" for k in range(1, COLUMNS))]
    history.write(dict(zip(names, table[0].tolist(), strict=True)))
    with open(history.path, "a") as file:
        file.writelines(",".join(map(repr, row)) + "\n" for row in table[1:].tolist())
    return history.path


def largest_memory(action: Callable[[], object]) -> int:
    """Most bytes held at a time."""
    action()  # what is loaded once is loaded
    tracemalloc.start()
    try:
        action()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_numbers_come_back_to_the_bit(path: Path, table: np.ndarray) -> None:
    seen = read_history(path)
    assert list(seen)[:2] == ["time", "column_1"]
    np.testing.assert_array_equal(np.column_stack(list(seen.values())), table)


def test_reading_takes_the_memory_of_the_numbers(path: Path, table: np.ndarray) -> None:
    # an array that grows while it is read holds its former self beside it; as texts they would be ten times as much
    assert largest_memory(lambda: read_history(path)) < 3 * table.nbytes


def test_taking_up_keeps_rows_before_a_time_and_holds_few_of_them(path: Path, table: np.ndarray) -> None:
    whole = path.read_text().splitlines()
    with open(path, "a") as file:
        file.write("1.5,2")
    taken = []
    assert largest_memory(lambda: taken.append(History(path, keep_until=table[3000, 0]))) < table.nbytes / 4
    assert taken[0].last_time == table[3000, 0]
    assert path.read_text().splitlines() == whole[:3002]
    History(path, keep_until=-1.0)
    assert path.read_text().splitlines() == whole[:1] and read_history(path)["time"].size == 0
