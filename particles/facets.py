"""A polyline that moves with its nodes: the boundary of another body, met at facets and corners."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particles.contact import Contact
from particles.errors import ParticleError
from particles.history import fresh_history, history_of
from particles.kernels import cells, facet_cells, features
from particles.kernels.layout import FacetArrays, Grid
from particles.state import Floats, Grains

Whole = NDArray[np.int64]
CELLS_PER_FEATURE = 4
KEPT = ("x", "y", "vx", "vy", "fx", "fy", "impulse", "work", "x_listed", "y_listed")


@dataclass(frozen=True, kw_only=True)
class Facets:
    """Straight facets between nodes; discs meet them under the laws of walls.

    A disc meets the foot of its centre on a facet, or a node that no facet next to it has a foot
    beside. The facets form closed or open chains; an open end is a tip.

    Parameters
    ----------
    points : (n, 2) floats
        Nodes [m].
    facets : (m, 2) ints
        Start and end of each facet: its body lies to the left of the way from start to end.
    material : int
        Row of a `ContactTable`.

    Raises
    ------
    ParticleError
        If a number is not finite, a facet has no length, or a node begins or ends two facets.
    """

    points: Floats
    facets: Whole
    material: int = 0

    def __post_init__(self) -> None:
        points, facets = np.asarray(self.points, float), np.asarray(self.facets, np.int64)
        if points.ndim != 2 or points.shape[1] != 2 or facets.ndim != 2 or facets.shape[1] != 2 or not len(facets):
            raise ParticleError("facets need nodes (n, 2) and at least one pair (start, end) of them")
        if facets.min() < 0 or facets.max() >= len(points):
            raise ParticleError(f"facets name nodes {facets.min()} to {facets.max()}, but there are {len(points)}")
        if not np.isfinite(points).all():
            raise ParticleError(f"node {np.nonzero(~np.isfinite(points))[0][0]} of the facets is not finite")
        for column, does in enumerate(("begins", "ends")):
            twice = np.nonzero(np.bincount(facets[:, column]) > 1)[0]
            if len(twice):
                raise ParticleError(f"node {twice[0]} {does} two facets: one chain passes a node once")
        short = np.nonzero(~(np.hypot(*(points[facets[:, 1]] - points[facets[:, 0]]).T) > 0.0))[0]
        if len(short):
            raise ParticleError(f"facet {short[0]} has no length: remove it or move a node")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "facets", facets)

    @property
    def closed(self) -> bool:
        """Whether no chain has an end."""
        return bool(np.array_equal(np.sort(self.facets[:, 0]), np.sort(self.facets[:, 1])))


class FacetContacts:
    """Facets in a system of discs: motion of the nodes, near grains, memory of the contacts, forces.

    Parameters
    ----------
    facets : Facets
    contact : ContactModel or ContactTable
        Decides which histories are kept.
    ledger : bool
        Whether the dashpot forces of the last step are kept for the energy ledger.

    Attributes
    ----------
    arrays : FacetArrays
        What the kernels work on.
    """

    def __init__(self, facets: Facets, contact: Contact, *, ledger: bool) -> None:
        self.facets, self.contact, self.ledger = facets, contact, ledger
        n, none = len(facets.points), np.zeros(0, np.uint32)
        zeros = {name: np.zeros(n) for name in ("vx", "vy", "fx", "fy", "work", "x_listed", "y_listed")}
        self.arrays = FacetArrays(
            x=facets.points[:, 0].copy(), y=facets.points[:, 1].copy(), impulse=np.zeros((n, 2)), **zeros,
            **_chain(facets.facets), material=np.array([facets.material], np.int64),
            grain=none, feature=none, block=np.zeros(2, np.int64), **self._slots(np.zeros(0, np.uint8)),
        )  # fmt: skip

    def __len__(self) -> int:
        return len(self.arrays.x)

    def _slots(self, side: np.ndarray) -> dict[str, np.ndarray]:
        near = len(side)
        return {
            "side": side, "side_now": side.copy(), "pushes": np.zeros(near, np.bool_), "push": np.zeros((near, 3, 2)),
            **fresh_history(self.contact, near, ledger=self.ledger),
        }  # fmt: skip

    # -- the list of near grains ----------------------------------------------------------------

    def settle(self, grains: Grains) -> None:
        """Hand memories over as the grains stand now: after it sides may be seen anew."""
        features.note_sides(0, len(self.arrays.grain), grains.x, grains.y, self.arrays)

    def rebuild(self, grains: Grains, old_of: Whole, skin: float, block_start: Whole) -> None:
        """List near grains anew, whose numbers were `old_of` (n,) when `settle` was called."""
        old = self.arrays
        old.x_listed[:], old.y_listed[:] = old.x, old.y
        low, high = self._boxes(float(grains.radius.max()) + skin)
        disc = (grains.x, grains.y, grains.radius)
        grain, feature, side = facet_cells.list_features(*disc, old, skin, low, high, _grid(low, high))
        block = np.searchsorted(grain, block_start)
        self.arrays = old._replace(grain=grain, feature=feature, block=block, **self._slots(side))
        cells.carry_walls(
            old_of, len(grains), old.grain, old.feature, history_of(old), grain, feature, history_of(self.arrays)
        )

    def _boxes(self, reach: float) -> tuple[Floats, Floats]:
        """Lower and upper corners (n_features, 2) [m] of what is within reach [m] of each feature."""
        a = self.arrays
        place = np.column_stack([a.x, a.y])
        first = place[np.where(a.at < 0, a.before, a.at)]
        second = place[np.where(a.at < 0, a.after, a.at)]
        return np.minimum(first, second) - reach, np.maximum(first, second) + reach

    # -- motion and forces ----------------------------------------------------------------------

    def steer(self, target: ArrayLike, interval: float) -> None:
        """Send the nodes to `target` (n, 2) [m] within `interval` [s], each on a straight line."""
        goal = np.asarray(target, float)
        self.arrays.vx[:] = (goal[:, 0] - self.arrays.x) / interval
        self.arrays.vy[:] = (goal[:, 1] - self.arrays.y) / interval

    def set_velocity(self, velocity: ArrayLike) -> None:
        """Give the nodes a velocity (n, 2) or (2,) [m/s]."""
        speed = np.asarray(velocity, float)
        self.arrays.vx[:], self.arrays.vy[:] = speed[..., 0], speed[..., 1]

    @property
    def places(self) -> Floats:
        """Nodes (n, 2) [m], a copy."""
        return np.column_stack([self.arrays.x, self.arrays.y])

    @property
    def force(self) -> Floats:
        """Force (n, 2) [N/m] of the grains on the nodes at the present time, couples included."""
        return np.column_stack([self.arrays.fx, self.arrays.fy])

    @property
    def impulse(self) -> Floats:
        """Impulse (n, 2) [N s/m] of the grains on the nodes during the last `advance`."""
        return self.arrays.impulse.copy()

    @property
    def work(self) -> float:
        """Work [J/m] that the nodes did on the grains since the start."""
        if not self.ledger:
            raise ParticleError("ledger = False keeps no works: build the system with ledger=True")
        return float(self.arrays.work.sum())

    def force_by_grain(self, grains: int) -> Floats:
        """Force (n_grains, 2) [N/m] of each grain on the facets at the present time."""
        a = self.arrays
        force = np.zeros((grains, 2))
        np.add.at(force, a.grain[a.pushes], a.push[a.pushes].sum(axis=1))
        return force

    def touching(self, grains: Grains) -> Floats:
        """Touching grains and features (k, 7): place of the grain, charge, overlap [m], normal into the body, its
        velocity [m/s]."""
        return features.touching_features(grains.x, grains.y, grains.radius, self.arrays)

    @property
    def speed(self) -> float:
        """Of the fastest node [m/s]."""
        return float(np.sqrt(np.max(self.arrays.vx**2 + self.arrays.vy**2)))

    # -- checkpoint -----------------------------------------------------------------------------

    def state(self) -> dict[str, np.ndarray]:
        """Everything that is needed to go on with the same bits."""
        return {name: array.copy() for name, array in self.arrays._asdict().items()}

    def restore(self, saved: Mapping[str, np.ndarray]) -> None:
        """Go back to a state of the same facets.

        Raises
        ------
        ParticleError
            If the state has other facets.
        """
        for name in ("before", "at", "after"):
            if not np.array_equal(saved[name], getattr(self.arrays, name)):
                raise ParticleError("saved state has other facets: use the scene the state was saved from")
        self.arrays = FacetArrays(**{name: np.array(saved[name]) for name in FacetArrays._fields})


def _chain(facets: Whole) -> dict[str, Whole]:
    """Features in the order of the chains: before each facet its first node, at an open end the last one."""
    begins = {int(start): k for k, (start, _) in enumerate(facets)}
    ends = {int(end): k for k, (_, end) in enumerate(facets)}
    heads = [start for start in begins if start not in ends]
    rows: list[tuple[int, int, int]] = []
    links: list[tuple[int, int]] = []
    left = set(begins)
    while left:
        open_chain = bool(heads)
        node = head = heads.pop() if heads else min(left)
        first = len(rows)
        while node in left:
            left.remove(node)
            end = int(facets[begins[node], 1])
            before = int(facets[ends[node], 0]) if node in ends else -1
            rows += [(before, node, end), (node, -1, end)]
            node = end
        if open_chain:
            rows.append((int(facets[ends[node], 0]), node, -1))
        assert open_chain or node == head, "a chain that began at its head closes there"
        links += [(k, k + 1) for k in range(first, len(rows) - 1)]
        if not open_chain:
            links.append((len(rows) - 1, first))
    before, at, after = np.array(rows, np.int64).T
    previous, following = np.full(len(rows), -1), np.full(len(rows), -1)
    for one, other in links:
        following[one], previous[other] = other, one
    columns = (before.copy(), at.copy(), after.copy(), previous, following)
    return dict(zip(("before", "at", "after", "previous", "following"), columns, strict=True))


def _grid(low: Floats, high: Floats) -> Grid:
    """Cells over all boxes, some for each feature, at least as large as most boxes are; few however far they reach."""
    x_min, y_min = low.min(axis=0)
    width, height = high.max(axis=0) - (x_min, y_min)
    most = CELLS_PER_FEATURE * len(low)
    size = max(float((high - low).min()), np.sqrt(width / most) * np.sqrt(height), max(width, height) / most)
    return Grid(float(x_min), float(y_min), size, int(width / size) + 1, int(height / size) + 1)
