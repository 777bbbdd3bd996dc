"""Cost of finding contacts against the number of grains: brute force, lists, cells (M A.2).

Four ways, each step for each grain:

- brute: all pairs at every step;
- list: a list with a skin out of all pairs, made anew every `LIFE` steps;
- cells: grains sorted into cells and looked up there at every step;
- cells and list: the product's, a list with a skin out of cells, made anew every `LIFE` steps.

The state is a dense packing, discs of +-2.5 % jittered about a hexagonal lattice, row by row in memory; the skin is a
tenth of a diameter. Making a list and walking through it are timed apart, so that another life can be put in.
"""

import time
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

import numba
import numpy as np
import search_kernels as kernels
from timing import interleaved

from particles.kernels import cells
from particles.kernels.layout import Grid

SIZES = (100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000)
BRUTE_UP_TO = 100_000  # where a step of all pairs takes seconds
LIFE = 20  # steps between lists
SKIN = 0.1  # of a diameter
LEAST_SECONDS, ROUNDS = 0.05, 5
WAYS = ("brute", "list", "cells", "cells and list")


class Cost(NamedTuple):
    """Seconds of one list (0 without) and of one step, for one way, number of grains and threads."""

    way: str
    grains: int
    threads: int
    list_seconds: float
    step_seconds: float

    def per_step(self, life: int = LIFE) -> float:
        """Seconds per step with lists that last `life` steps."""
        return self.step_seconds + self.list_seconds / life


class State(NamedTuple):
    """Places and radii of the discs [mean diameter], the grid, and nobody's body."""

    x: np.ndarray
    y: np.ndarray
    radius: np.ndarray
    body: np.ndarray


def dense(n: int) -> State:
    """About three touching pairs for two discs, half of the contacts of the lattice closed."""
    rng = np.random.default_rng(1)
    columns = max(1, round(np.sqrt(n)))
    column, row = np.divmod(np.arange(n), columns)
    x, y = np.sqrt(0.75) * column, row + 0.5 * (column % 2)
    x, y = (place + 0.02 * rng.standard_normal(n) for place in (x, y))
    return State(x, y, 0.5 * rng.uniform(0.975, 1.025, n), np.full(n, -1, np.int32))


def grid_of(state: State, size: float) -> Grid:
    """Cells of `size` over all grains."""
    x_min, y_min = float(state.x.min()), float(state.y.min())
    extent = (float(state.x.max()) - x_min, float(state.y.max()) - y_min)
    return Grid(x_min, y_min, size, *(int(length / size) + 1 for length in extent))


class Ways:
    """All ways to find the contacts of one state on some threads; each method is one list or one step."""

    def __init__(self, state: State, threads: int) -> None:
        self.state, self.threads = state, threads
        self.found: dict[str, tuple[int, float]] = {}
        n = len(state.x)
        self._members, self._grid = np.arange(n), grid_of(state, 2.0 * float(state.radius.max()))
        self._wide, self._held = np.empty((n, kernels.WIDEST), np.int32), np.zeros(n, np.int64)
        self._near = np.empty((4 * n + 1024, 2), np.int32)
        self._rows = self._made = None

    def brute(self) -> None:
        """Step: all pairs."""
        self.found["brute"] = self._kernel(kernels.brute)(*self.state[:3])

    def make_list(self) -> None:
        """List: out of all pairs."""
        self._kernel(kernels.list_by_brute)(*self.state[:3], SKIN, self._wide, self._held)

    def walk_list(self) -> None:
        """Step: that list."""
        x, y, radius, _ = self.state
        found = self._kernel(kernels.walk_wide)(x, y, radius, x, y, self._wide, self._held)
        self.found["list"] = found[:2]

    def cells(self) -> None:
        """Step: sort into cells, look up."""
        x, y, radius, _ = self.state
        order, start = cells.sort_by_cell(x, y, self._members, self._grid)
        self.found["cells"] = self._kernel(kernels.through_cells)(
            x[order], y[order], radius[order], self._grid.rows, start
        )

    def make_cells_list(self) -> None:
        """List: the product's kernels, which run on one thread."""
        grid = grid_of(self.state, 2.0 * float(self.state.radius.max()) + SKIN)
        order, start = cells.sort_by_cell(self.state.x, self.state.y, self._members, grid)
        count = cells.pairs_within(*self.state, SKIN, grid, order, start, self._near, 0)
        assert count <= len(self._near)
        self._rows = cells.rows_of(self._near[:count], len(self.state.x))

    def walk_cells_list(self) -> None:
        """Step: that list."""
        x, y, radius, _ = self.state
        found = self._kernel(kernels.walk_rows)(x, y, radius, x, y, self._rows[0], self._rows[2])
        self.found["cells and list"] = found[:2]

    def require_equal(self) -> None:
        """All ways have found the same contacts, and no row was too short."""
        assert self._held.max() <= kernels.WIDEST
        (count, overlap), *others = self.found.values()
        for other in others:
            assert other[0] == count and np.isclose(other[1], overlap, rtol=1e-10), self.found

    def _kernel(self, build: kernels.Build) -> Callable[..., Any]:
        return build.one if self.threads == 1 else build.several


def costs(sizes: Iterable[int] = SIZES, threads: Iterable[int] = (1, 2)) -> list[Cost]:
    """Measure all ways at all sizes."""
    return [cost for n in sizes for k in threads for cost in _costs_of(n, k)]


def _costs_of(n: int, threads: int) -> list[Cost]:
    numba.set_num_threads(threads)
    ways = Ways(dense(n), threads)
    lists = {"cells and list": ways.make_cells_list}
    steps = {"cells": ways.cells, "cells and list": ways.walk_cells_list}
    if n <= BRUTE_UP_TO:
        lists["list"], steps["list"], steps["brute"] = ways.make_list, ways.walk_list, ways.brute
    tasks = {("list", way): _timed(make) for way, make in lists.items()}  # lists first: steps walk through them
    tasks |= {("step", way): _timed(step) for way, step in steps.items()}
    taken = interleaved(tasks, ROUNDS if n < BRUTE_UP_TO else 3)
    ways.require_equal()
    return [Cost(way, n, threads, taken.get(("list", way), 0.0), taken["step", way]) for way in WAYS if way in steps]


def _timed(action: Callable[[], None]) -> Callable[[], float]:
    """A task that repeats an action for a while and returns the seconds of one."""

    def task() -> float:
        times, begin = 0, time.perf_counter()
        while (spent := time.perf_counter() - begin) < LEAST_SECONDS or times == 0:
            action()
            times += 1
        return spent / times

    return task


def crossovers(found: Iterable[Mapping[str, Any]], threads: int = 1) -> dict[str, float | None]:
    """Numbers of grains from which a list out of all pairs beats all pairs, and cells with a list beat that."""
    table: dict[str, dict[int, float]] = {}
    for row in found:
        if row["threads"] == threads:
            table.setdefault(row["way"], {})[row["grains"]] = row["step_seconds"] + row["list_seconds"] / LIFE
    pairs = {
        "search_list_beats_brute_from": ("list", "brute"),
        "search_cells_beat_list_from": ("cells and list", "list"),
    }
    return {name: _first_win(table[winner], table[loser]) for name, (winner, loser) in pairs.items()}


def _first_win(winner: Mapping[int, float], loser: Mapping[int, float]) -> float | None:
    """Where the ratio of two costs crosses one for good, straight on logarithmic axes; the least size if always."""
    sizes = sorted(winner.keys() & loser.keys())
    ratio = np.log([winner[n] / loser[n] for n in sizes])
    behind = np.nonzero(ratio >= 0.0)[0]
    if not len(behind):
        return float(sizes[0])
    last = int(behind[-1])
    if last == len(sizes) - 1:
        return None
    share = ratio[last] / (ratio[last] - ratio[last + 1])
    return float(np.exp(np.log(sizes[last]) + share * np.log(sizes[last + 1] / sizes[last])))
