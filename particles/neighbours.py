"""The contact list: which grains and walls may touch soon, and what their contacts remember."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from particles.contact import ContactModel
from particles.errors import ParticleError
from particles.kernels import cells
from particles.kernels.layout import PairArrays, WallArrays
from particles.state import Grains
from particles.walls import Wall

SMALLEST_SKIN, LARGEST_SKIN = 0.06, 0.5  # over the mean radius of the free grains
STEPS_WANTED = 40  # between lists, at the speed of the fastest grain
ONE_BLOCK = 2000  # free grains below which blocks do not pay


class Grid(NamedTuple):
    """Uniform cells over the bounding box of all grains."""

    x_min: float
    y_min: float
    size: float
    columns: int
    rows: int


def block_starts(n_free: int, n: int) -> np.ndarray:
    """First grain of each block; their number depends on the number of grains alone."""
    blocks = 1 if n_free < ONE_BLOCK else 8 * -(-n_free // 16_384)
    free = np.linspace(0, n_free, blocks + 1).astype(np.int64)
    return np.append(free, n)


def choose_skin(grains: Grains, dt: float) -> float:
    """Reach of the list beyond contact [m]: STEPS_WANTED steps of the fastest grain, within limits."""
    free = slice(grains.n_free) if grains.n_free else slice(None)
    scale = float(grains.radius[free].mean())
    speed = float(np.sqrt(np.max(grains.vx**2 + grains.vy**2)))
    return float(np.clip(2.0 * STEPS_WANTED * speed * dt, SMALLEST_SKIN * scale, LARGEST_SKIN * scale))


class ContactList:
    """Half list of near pairs and near walls, with the history of their contacts.

    Parameters
    ----------
    contact : ContactModel
        Decides which histories are kept.
    walls : list of Wall
    ledger : bool
        Whether the dashpot forces of the last step are kept for the energy ledger.
    """

    def __init__(self, contact: ContactModel, walls: list[Wall], *, ledger: bool) -> None:
        self.contact = contact
        self.ledger = ledger
        self.skin = 0.0
        self.pairs = self._pair_arrays(np.zeros(1, np.int64), np.zeros(0, np.int32))
        self.walls = self._wall_arrays(walls)

    @property
    def reach2(self) -> float:
        """Square of the displacement at which the list must be made anew [m2]."""
        return (0.5 * self.skin) ** 2

    def rebuild(self, grains: Grains, dt: float) -> None:
        """Sort the free grains by cell, list near pairs and walls, carry the histories over."""
        self._require_finite(grains)
        first = len(self.pairs.start) == 1
        self.skin = choose_skin(grains, dt)
        grid = self._grid(grains)
        order, cell_start = cells.sort_by_cell(grains.x, grains.y, 0, grains.n_free, *grid)
        grains.reorder(order)
        grains.x_listed[:], grains.y_listed[:] = grains.x, grains.y
        old_of = np.concatenate([order, np.arange(grains.n_free, len(grains))])
        start, partner = self._near_pairs(grains, grid, cell_start)
        if first:
            self._require_apart(grains, start, partner)
        before, self.pairs = self.pairs, self._pair_arrays(start, partner, block_starts(grains.n_free, len(grains)))
        if not first:
            cells.carry_pairs(
                old_of, before.start, before.partner, _history(before), start, partner, _history(self.pairs)
            )
        self._rebuild_walls(grains, old_of)

    def take_over(self, saved: Mapping[str, np.ndarray], n: int) -> None:
        """Adopt the histories of a saved list of the same free grains, now followed by others up to `n`."""
        for group in ("pairs", "walls"):
            own = getattr(self, group)
            arrays = {name: np.array(saved[f"{group}.{name}"]) for name in own._fields}
            if group == "walls":
                if len(arrays["px"]) != len(own.px):
                    continue
                arrays |= {name: getattr(own, name) for name in ("px", "py", "nx", "ny", "vx", "vy")}
            else:
                more = n + 1 - len(arrays["start"])
                arrays["start"] = np.append(arrays["start"], np.full(more, arrays["start"][-1]))
            slots = len(arrays["partner" if group == "pairs" else "grain"])
            for name, fresh in self._memory(slots).items():
                if len(arrays[name]) != len(fresh):
                    arrays[name] = fresh
            setattr(self, group, type(own)(**arrays))

    def _near_pairs(self, grains: Grains, grid: Grid, cell_start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        start = np.zeros(len(grains) + 1, np.int64)
        shape = (grains.x, grains.y, grains.radius)
        capacity = max(len(self.pairs.partner) * 5 // 4, 4 * grains.n_free) + 16
        while True:
            partner = np.empty(capacity, np.int32)
            needed = cells.list_free_pairs(*shape, grains.n_free, self.skin, *grid, cell_start, start, partner)
            if needed <= capacity:
                break
            capacity = needed
        if grains.n_free == len(grains):
            return start, partner[:needed].copy()
        order, prescribed_start = cells.sort_by_cell(grains.x, grains.y, grains.n_free, len(grains), *grid)
        partner = cells.list_prescribed_pairs(
            *shape, grains.body, grains.n_free, self.skin, *grid, order, prescribed_start, start.copy(), partner, start
        )
        return start, partner

    def _rebuild_walls(self, grains: Grains, old_of: np.ndarray) -> None:
        old = self.walls
        grain, wall = cells.list_walls(
            grains.x, grains.y, grains.radius, grains.n_free, old.px, old.py, old.nx, old.ny, self.skin
        )
        starts = block_starts(grains.n_free, len(grains))
        block = np.searchsorted(grain, starts)
        force = old.force if len(old.force) == len(starts) - 1 else np.zeros((len(starts) - 1, len(old.px), 2))
        self.walls = old._replace(
            px_listed=old.px.copy(), py_listed=old.py.copy(), force=force, grain=grain, wall=wall, block=block,
            **self._memory(len(grain)),
        )
        cells.carry_walls(
            old_of, grains.n_free, old.grain, old.wall, _history(old), grain, wall, _history(self.walls)
        )

    def _grid(self, grains: Grains) -> Grid:
        x_min, y_min = float(grains.x.min()), float(grains.y.min())
        width, height = float(grains.x.max()) - x_min, float(grains.y.max()) - y_min
        size = 2.0 * float(grains.radius.max()) + self.skin
        most = max(4 * len(grains), 64)
        while (width / size + 1.0) * (height / size + 1.0) > most:
            size *= 1.5
        return Grid(x_min, y_min, size, int(width / size) + 1, int(height / size) + 1)

    def _memory(self, slots: int) -> dict[str, np.ndarray]:
        kept = slots if self.contact.spins else 0
        return {
            "spring": np.zeros(kept),
            "moment": np.zeros(kept),
            **{name: np.zeros(slots if self.ledger else 0) for name in ("dash_n", "dash_t", "dash_r")},
        }

    def _pair_arrays(
        self, start: np.ndarray, partner: np.ndarray, blocks: np.ndarray | None = None
    ) -> PairArrays:
        if blocks is None:
            blocks = np.zeros(2, np.int64)
        crossing_start, *incoming = cells.list_crossings(blocks, start, partner)
        return PairArrays(
            start, partner, **self._memory(len(partner)),
            crossing_start=crossing_start, crossing=np.zeros((int(crossing_start[-1]), 3)),
            incoming_grain=incoming[0], incoming_start=incoming[1], incoming=incoming[2], incoming_block=incoming[3],
        )  # fmt: skip

    def _wall_arrays(self, walls: list[Wall]) -> WallArrays:
        point = np.array([w.point for w in walls], float).reshape(-1, 2)
        normal = np.array([w.unit_normal for w in walls], float).reshape(-1, 2)
        velocity = np.array([w.velocity for w in walls], float).reshape(-1, 2)
        columns: dict[str, Any] = {
            "px": point[:, 0].copy(), "py": point[:, 1].copy(), "nx": normal[:, 0].copy(), "ny": normal[:, 1].copy(),
            "vx": velocity[:, 0].copy(), "vy": velocity[:, 1].copy(),
            "px_listed": point[:, 0].copy(), "py_listed": point[:, 1].copy(),
        }
        return WallArrays(
            **columns, force=np.zeros((1, len(walls), 2)), grain=np.zeros(0, np.int32), wall=np.zeros(0, np.int32),
            block=np.zeros(2, np.int64), **self._memory(0),
        )

    @staticmethod
    def _require_finite(grains: Grains) -> None:
        lost = np.nonzero(~(np.isfinite(grains.x) & np.isfinite(grains.y)))[0]
        if len(lost):
            number = grains.number[lost[0]]
            raise ParticleError(
                f"grain {number} has left the finite numbers: the run is unstable; use a smaller time step"
            )

    @staticmethod
    def _require_apart(grains: Grains, start: np.ndarray, partner: np.ndarray) -> None:
        owner = np.repeat(np.arange(len(grains)), np.diff(start))
        same = np.nonzero((grains.x[owner] == grains.x[partner]) & (grains.y[owner] == grains.y[partner]))[0]
        if len(same):
            a, b = grains.number[owner[same[0]]], grains.number[partner[same[0]]]
            raise ParticleError(f"grains {a} and {b} have the same centre: move one of them")


def _history(listed: PairArrays | WallArrays) -> tuple[np.ndarray, ...]:
    return listed.spring, listed.moment, listed.dash_n, listed.dash_t, listed.dash_r
