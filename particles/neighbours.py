"""The contact list: which grains and walls may touch soon, and what their contacts remember."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from particles.contact import Contact
from particles.errors import ParticleError
from particles.facets import FacetContacts
from particles.history import fresh_history, history_of
from particles.kernels import cells
from particles.kernels.layout import Grid, PairArrays, WallArrays
from particles.periodic import Period, folded, with_images
from particles.state import Floats, Grains
from particles.walls import Wall

SMALLEST_SKIN, LARGEST_SKIN = 0.06, 0.5  # over the mean radius of the free grains
STEPS_WANTED = 40  # between lists, at the speed of the fastest grain
ONE_BLOCK = 2000  # free grains below which blocks do not pay
LISTS_PER_SORT = 8  # in which a grain moves less than 2 radii


class Level(NamedTuple):
    """Grains of similar size, sorted by cells of their own."""

    members: np.ndarray
    grid: Grid
    order: np.ndarray
    cell_start: np.ndarray


def block_starts(n_free: int, n: int) -> np.ndarray:
    """First grain of each block; their number depends on the number of grains alone."""
    blocks = 1 if n_free < ONE_BLOCK else 8 * -(-n_free // 16_384)
    free = np.linspace(0, n_free, blocks + 1).astype(np.int64)
    return np.append(free, n)


def choose_skin(grains: Grains, dt: float, other_speed: float = 0.0) -> float:
    """Reach of the list beyond contact [m]: STEPS_WANTED steps of the fastest grain or facet, within limits."""
    free = slice(grains.n_free) if grains.n_free else slice(None)
    scale = float(grains.radius[free].mean())
    speed = max(float(np.sqrt(np.max(grains.vx**2 + grains.vy**2))), other_speed)
    return float(np.clip(2.0 * STEPS_WANTED * speed * dt, SMALLEST_SKIN * scale, LARGEST_SKIN * scale))


class ContactList:
    """Half list of near pairs and near walls, with the history of their contacts.

    Parameters
    ----------
    contact : ContactModel or ContactTable
        Decides which histories are kept.
    walls : list of Wall
    smallest : float
        Smallest radius [m].
    ledger : bool
        Whether the dashpot forces of the last step are kept for the energy ledger.
    period : (2,) of float or None
        After which x and y repeat [m].
    facets : FacetContacts, optional
        Listed together with the grains; their own histories are kept in "float64".
    precision : str
        Of the histories, "float64" or "float32".
    skin_factor : float
        On the skin that is chosen for the speed of the grains.
    """

    def __init__(
        self,
        contact: Contact,
        walls: list[Wall],
        *,
        smallest: float,
        ledger: bool,
        period: Period = (None, None),
        facets: FacetContacts | None = None,
        precision: str = "float64",
        skin_factor: float = 1.0,
    ) -> None:
        self.contact, self.skin_factor, self.smallest = contact, skin_factor, smallest
        self.ledger, self.precision = ledger, precision
        self.period, self.facets = period, facets
        self.skin = 0.0
        none = np.zeros(0, np.uint32)
        self.pairs = self._pair_arrays(np.zeros(1, np.int64), none, none, np.zeros(2, np.int64))
        self.walls = self._wall_arrays(walls)

    @property
    def reach2(self) -> float:
        """Square of the displacement at which the list must be made anew [m2], at most half the smallest radius."""
        return (0.5 * min(self.skin, self.smallest)) ** 2

    def rebuild(self, grains: Grains, dt: float, *, sort: bool = True) -> None:
        """List near pairs and walls, carry the histories over; before, if asked, sort the free grains by cell."""
        self._require_finite(grains)
        first = len(self.pairs.start) == 1
        if self.facets is None:
            self.skin = self.skin_factor * choose_skin(grains, dt)
        else:
            self.skin = self.skin_factor * choose_skin(grains, dt, self.facets.speed)
            self.facets.settle(grains)
        old_of = np.arange(len(grains))
        if sort:
            old_of[: grains.n_free] = self._storage_order(grains)
            grains.reorder(old_of[: grains.n_free])
        grains.x_listed[:], grains.y_listed[:] = grains.x, grains.y
        before, rows = self.pairs, cells.rows_of(self._near_pairs(grains), len(grains))
        self.pairs = self._pair_arrays(*rows, block_starts(grains.n_free, len(grains)))
        if first:
            self._require_apart(grains)
        moved = old_of[:0] if first else old_of  # nothing to carry yet, but the code is loaded before the first step
        cells.carry_pairs(moved, before.start, before.partner, history_of(before), *rows[::2], history_of(self.pairs))
        self._rebuild_walls(grains, old_of)
        if self.facets is not None:
            self.facets.rebuild(grains, old_of, self.skin, block_starts(grains.n_free, len(grains)))

    def _storage_order(self, grains: Grains) -> np.ndarray:
        """Order in memory of the free grains: by cells of the smallest size, columns first."""
        free = np.arange(grains.n_free)
        if grains.n_free == 0:
            return free
        x, y = folded(grains.x, self.period[0]), folded(grains.y, self.period[1])
        grid = self._grid(x, y, _levels(grains.radius[: grains.n_free])[0][1])
        return cells.sort_by_cell(x, y, free, grid)[0]

    def _near_pairs(self, grains: Grains) -> np.ndarray:
        """All near pairs (k, 2), lower index first."""
        if self.period == (None, None):
            return self._search(grains.x, grains.y, grains.radius, grains.body)
        x, y, of = with_images(grains.x, grains.y, grains.radius, self.skin, self.period)
        found = self._search(x, y, grains.radius[of], grains.body[of])
        found = found[found[:, 0] < len(grains)]  # two images meet where their originals do
        return np.sort(of[found], axis=1).astype(np.int32)

    def _search(self, x: Floats, y: Floats, radius: Floats, body: np.ndarray) -> np.ndarray:
        levels = []
        for members, largest in _levels(radius):
            grid = self._grid(x, y, largest)
            levels.append(Level(members, grid, *cells.sort_by_cell(x, y, members, grid)))
        state = (x, y, radius, body, self.skin)
        capacity = max(len(self.pairs.partner) * 5 // 4, 4 * len(x)) + 1024
        while True:
            found, count = np.empty((capacity, 2), np.int32), 0
            for k, level in enumerate(levels):
                count = cells.pairs_within(*state, *level[1:], found, count)
                for coarser in levels[k + 1 :]:
                    count = cells.pairs_between(*state, level.members, *coarser[1:], found, count)
            if count <= capacity:
                return found[:count]
            capacity = count

    def take_over(self, saved: Mapping[str, np.ndarray], n: int) -> None:
        """Adopt the histories of a saved list of the same free grains, now followed by others up to `n`."""
        for group in ("pairs", "walls"):
            own = getattr(self, group)
            arrays = {name: np.array(saved[f"{group}.{name}"]) for name in own._fields}
            if group == "walls":
                if len(arrays["px"]) != len(own.px):
                    continue
                arrays |= {
                    name: getattr(own, name)
                    for name in ("px", "py", "nx", "ny", "vx", "vy", "gain_x", "gain_y", "material")
                }
            else:
                more = n + 1 - len(arrays["start"])
                arrays["start"] = np.append(arrays["start"], np.full(more, arrays["start"][-1]))
            slots = len(arrays["partner" if group == "pairs" else "grain"])
            for name, fresh in self._memory(slots).items():
                fits = len(arrays[name]) == len(fresh)
                arrays[name] = arrays[name].astype(self.precision, copy=False) if fits else fresh
            setattr(self, group, type(own)(**arrays))

    def _rebuild_walls(self, grains: Grains, old_of: np.ndarray) -> None:
        old = self.walls
        grain, wall = cells.list_walls(
            grains.x, grains.y, grains.radius, grains.n_free, old.px, old.py, old.nx, old.ny, self.skin
        )
        starts = block_starts(grains.n_free, len(grains))
        block = np.searchsorted(grain, starts)
        force = old.force if len(old.force) == len(starts) - 1 else np.zeros((len(starts) - 1, len(old.px), 2))
        self.walls = old._replace(
            px_listed=old.px.copy(),
            py_listed=old.py.copy(),
            force=force,
            grain=grain,
            wall=wall,
            block=block,
            **self._memory(len(grain)),
        )
        cells.carry_walls(
            old_of, grains.n_free, old.grain, old.wall, history_of(old), grain, wall, history_of(self.walls)
        )

    def _grid(self, x: Floats, y: Floats, largest_radius: float) -> Grid:
        """Cells of the largest diameter plus the skin over the bounding box of all grains."""
        x_min, y_min = float(x.min()), float(y.min())
        width, height = float(x.max()) - x_min, float(y.max()) - y_min
        size = 2.0 * largest_radius + self.skin
        most = max(4 * len(x), 64)
        while (width / size + 1.0) * (height / size + 1.0) > most:
            size *= 1.5
        return Grid(x_min, y_min, size, int(width / size) + 1, int(height / size) + 1)

    def _memory(self, slots: int) -> dict[str, np.ndarray]:
        return fresh_history(self.contact, slots, ledger=self.ledger, precision=self.precision)

    def _pair_arrays(self, start: np.ndarray, owner: np.ndarray, partner: np.ndarray, blocks: np.ndarray) -> PairArrays:
        crossing_start, *incoming = cells.list_crossings(blocks, start, partner)
        return PairArrays(
            start, owner, partner, **self._memory(len(partner)),
            crossing_start=crossing_start, crossing=np.zeros((int(crossing_start[-1]), 3)),
            incoming_grain=incoming[0], incoming_start=incoming[1], incoming=incoming[2],
            incoming_block=incoming[3], first_source=incoming[4],
        )  # fmt: skip

    def _wall_arrays(self, walls: list[Wall]) -> WallArrays:
        point = np.array([w.point for w in walls], float).reshape(-1, 2)
        normal = np.array([w.unit_normal for w in walls], float).reshape(-1, 2)
        velocity = np.array([w.velocity for w in walls], float).reshape(-1, 2)
        columns: dict[str, Any] = {
            "px": point[:, 0].copy(),
            "py": point[:, 1].copy(),
            "nx": normal[:, 0].copy(),
            "ny": normal[:, 1].copy(),
            "vx": velocity[:, 0].copy(),
            "vy": velocity[:, 1].copy(),
            "gain_x": np.zeros(len(walls)),
            "gain_y": np.zeros(len(walls)),
            "material": np.array([w.material for w in walls], np.int64),
            "px_listed": point[:, 0].copy(),
            "py_listed": point[:, 1].copy(),
        }
        return WallArrays(
            **columns,
            force=np.zeros((1, len(walls), 2)),
            grain=np.zeros(0, np.uint32),
            wall=np.zeros(0, np.uint32),
            block=np.zeros(2, np.int64),
            **self._memory(0),
        )

    @staticmethod
    def _require_finite(grains: Grains) -> None:
        lost = np.nonzero(~(np.isfinite(grains.x) & np.isfinite(grains.y)))[0]
        if len(lost):
            number = grains.number[lost[0]]
            raise ParticleError(
                f"grain {number} has left the finite numbers: the run is unstable; use a smaller time step"
            )

    def _require_apart(self, grains: Grains) -> None:
        a, b = self.pairs.owner, self.pairs.partner
        same = np.nonzero((grains.x[a] - grains.x[b]) ** 2 + (grains.y[a] - grains.y[b]) ** 2 == 0.0)[0]
        if len(same):
            first, second = grains.number[a[same[0]]], grains.number[b[same[0]]]
            raise ParticleError(f"grains {first} and {second} have the same centre: move one of them")


def _levels(radius: np.ndarray) -> list[tuple[np.ndarray, float]]:
    """Grains by size, finest first: members and the largest radius of each level, at most twice the smallest."""
    largest = float(radius.max())
    if largest < 2.0 * radius.min():
        return [(np.arange(len(radius)), largest)]
    level = np.floor(np.log2(radius / radius.min()) + 1e-12).astype(np.int64)
    found = [np.nonzero(level == k)[0] for k in np.unique(level)]
    return [(members, float(radius[members].max())) for members in found]
