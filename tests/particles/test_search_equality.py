"""Every search for contacts gives the same forces: brute force, cells at every step, lists with any skin.

Brute force in two forms: a dense code of its own, whose sums have another order (round-off), and a list of all
pairs in the order of the others (the same bits).
"""

from dataclasses import dataclass

import numpy as np
import pytest
from dense_reference import Dense
from discs import by_number, full_law, packing

from particles import Grains, ParticleSystem, Wall, box, neighbours

LAW = {"k_n": 2e5, "k_t": 1e4, "c_n": 6.0, "c_t": 1.0, "mu": 0.5, "mu_r": 0.1, "eta_r": 0.3}
GRAVITY = (0.5, -9.81)
DT, STEPS = 2e-6, 60
EPS = np.finfo(float).eps
R = 1e-3  # of the small grains
NAMES = ("x", "y", "theta", "vx", "vy", "omega", "fx", "fy", "torque")
RATIOS = (1.0, 2.0, 10.0, 50.0)
SIDES = ("walls", "open", "periodic in x", "periodic in both")
ALL_PAIRS = 1e6  # skin [m] that lists everything at once


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Grains and what surrounds them."""

    grains: Grains
    walls: tuple[Wall, ...]
    period: tuple[float | None, float | None]

    def system(self) -> ParticleSystem:
        return full_law(
            self.grains, **LAW, walls=self.walls, gravity=GRAVITY, time_step=DT, period=self.period
        )  # fmt: skip

    def dense(self) -> Dense:
        g = self.grains
        return Dense(
            n_free=g.n_free, x=g.position, v=np.column_stack([g.vx, g.vy]), omega=g.omega.copy(),
            radius=g.radius.copy(), mass=g.mass.copy(), law=LAW, gravity=np.array(GRAVITY), body=g.body.copy(),
            walls=[(np.array(wall.point), np.array(wall.unit_normal)) for wall in self.walls], period=self.period,
        )  # fmt: skip


def scene(ratio: float, sides: str) -> Scene:
    """Two large discs `ratio` times as large as the small ones that crowd around them, and a prescribed trio.

    The box ends where the grains do: walls and seams are in contact with many of them.
    """
    rng = np.random.default_rng(int(ratio))
    big = ratio * R
    width = height = 5.2 * big + 16.0 * R
    large = np.array([[0.3 * width, 0.5 * height], [0.3 * width + 1.98 * big, 0.5 * height + 0.1 * big]])
    cells = 1.8 * R * np.stack(np.meshgrid(np.arange(int(width / 1.8 / R)), np.arange(int(height / 1.8 / R))), axis=-1)
    small = cells.reshape(-1, 2) + 0.5 * R + rng.uniform(-0.2, 0.2, (cells.size // 2, 2)) * R
    clear = np.hypot(*(small[:, None] - large).transpose(2, 0, 1)).min(axis=1) - big
    edge = np.minimum(np.minimum(small[:, 0], width - small[:, 0]), np.minimum(small[:, 1], height - small[:, 1]))
    small = small[clear > 0.8 * R]
    order = np.argsort(np.minimum(clear, edge + 0.3 * R)[clear > 0.8 * R])
    trio = small[order[:3]]
    place = np.concatenate([large, small[order[3:140]]])
    radius = np.concatenate([[big, big], R * rng.uniform(0.9, 1.1, len(place) - 2)])
    velocity = rng.normal(0.0, 0.5, place.shape)
    if sides == "open":  # a couple that left long ago, others that are leaving fast
        place[-2:] = [[1e3 * width, 2.0], [1e3 * width + 1.9 * R, 2.0]]
        velocity[2:12] = 100.0 * np.abs(velocity[2:12])
    spin = rng.normal(0.0, 300.0, len(place))
    grains = Grains.discs(place, radius, 1600.0, velocity=velocity, spin=spin).with_prescribed(trio, R, 0)
    grains.vx[-3:], grains.vy[-3:], grains.omega[-3:] = 0.3, -0.2, 50.0
    every = ("left", "right", "floor", "lid")
    shown = {"walls": every, "open": ("floor",), "periodic in x": ("floor", "lid"), "periodic in both": ()}[sides]
    # A period that nothing can reach across is none, and compiles nothing anew.
    period = (width, height if sides == "periodic in both" else 1e4 * height) if "periodic" in sides else (None, None)
    return Scene(grains=grains, walls=tuple(box(width, height, shown)), period=period)


def with_skin(skin: float | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Lists of this skin [m]; None: the code's own choice, 0: cells anew at every step."""
    if skin is not None:
        monkeypatch.setattr(neighbours, "choose_skin", lambda grains, dt: skin)


def in_one_order(monkeypatch: pytest.MonkeyPatch, *, every_pair: bool) -> None:
    """Let grains stay in their order and list pairs by both numbers; all of them instead of the near ones, if asked."""
    search = neighbours.ContactList._near_pairs

    def all_pairs(listing: neighbours.ContactList, grains: Grains) -> np.ndarray:
        pairs = np.column_stack(np.triu_indices(len(grains), 1)).astype(np.int32)
        a, b = grains.body[pairs].T
        return pairs[(a != b) | (a < 0)]

    def near_pairs(listing: neighbours.ContactList, grains: Grains) -> np.ndarray:
        pairs = search(listing, grains)
        return pairs[np.lexsort(pairs.T[::-1])]

    monkeypatch.setattr(neighbours.ContactList, "_near_pairs", all_pairs if every_pair else near_pairs)
    monkeypatch.setattr(neighbours.ContactList, "_storage_order", lambda listing, grains: np.arange(grains.n_free))


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("sides", SIDES)
def test_lists_move_grains_as_all_pairs_do(ratio: float, sides: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Against the dense code, whose springs never move in memory, over contacts that begin, slip and end."""
    start = scene(ratio, sides)
    reference = start.dense()
    places = reference.x.copy()
    born = reference.kinematics()["delta"] > 0.0
    reference.run(STEPS, DT)
    changed = (reference.kinematics()["delta"] > 0.0) != born
    assert changed.any(axis=1).sum() > 10
    free = slice(start.grains.n_free)
    # Places are rounded at every step, and forces by k eps x, which moves a grain by (omega dt)^2 = 1e-4 of that.
    within = np.hypot(*(places[free] - places[0]).T) < 100.0 * ratio * R
    size = np.where(within, np.abs(places[free][within]).max(), np.abs(places[free]).max())
    for skin in (0.0, 0.01 * R, None, 0.5 * R):
        with monkeypatch.context() as patch:
            with_skin(skin, patch)
            system = scene(ratio, sides).system()
            system.advance(STEPS)
        assert system.rebuilds > (STEPS if skin == 0.0 else 0)
        x, y, omega = by_number(system, "x", "y", "omega")
        error = np.abs(np.column_stack([x, y]) - reference.x)[free].max(axis=1)
        assert (error <= STEPS * EPS * size).all()
        # The far couple: eps of its place over its overlap, 1e-10, in a spring that turns it by 1e-3 of its spin.
        assert np.abs(omega - reference.omega).max() < 1e-12 * np.abs(reference.omega).max()


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("sides", SIDES)
def test_every_search_gives_the_same_bits(ratio: float, sides: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """One order of summation, whatever finds the pairs: forces, places and springs after many steps."""
    found = []
    for skin in (ALL_PAIRS, 0.0, 0.01 * R, None, 0.5 * R):
        with monkeypatch.context() as patch:
            with_skin(skin, patch)
            in_one_order(patch, every_pair=skin == ALL_PAIRS)
            system = scene(ratio, sides).system()
            system.list.smallest = np.inf  # the skin alone decides when a list is stale
            system.advance(STEPS)
            assert system.rebuilds == 1 or skin != ALL_PAIRS
            found.append((np.array(by_number(system, *NAMES)), system.wall_force, system.energies()))
    for state, wall_force, _ in found[1:]:
        assert np.array_equal(state, found[0][0])
        assert np.array_equal(wall_force, found[0][1])
    # Losses are summed over the slots of a list. Without a skin, a contact that opens is not listed any more
    # when its last half step is entered.
    for _, _, energies in found[3:]:
        assert energies == pytest.approx(found[0][2], rel=1e-12)


def crowd(n: int, ratio: float) -> Scene:
    """A dense random packing, several blocks of it above 2000 grains, with two prescribed bodies inside."""
    grains, width, height = packing(n, seed=n, ratio=ratio)
    biggest = grains.radius.max()
    for body, at in enumerate((0.3, 0.6)):
        turn = np.linspace(0.0, 2.0 * np.pi, 20, endpoint=False)
        ring = at * np.array([width, height]) + 3.0 * biggest * np.column_stack([np.cos(turn), np.sin(turn)])
        grains = grains.with_prescribed(ring, 0.5 * biggest, body)
        grains.vx[grains.body == body], grains.vy[grains.body == body] = 0.2, -0.1
    return Scene(grains=grains, walls=tuple(box(width, height)), period=(None, None))


def test_forces_of_several_blocks_equal_those_of_all_pairs() -> None:
    start = crowd(2100, 10.0)
    reference, system = start.dense(), start.system()
    assert len(system.blocks) > 3
    system.start()
    force, torque = reference.forces(0.0)
    assert np.count_nonzero(force) > 0.9 * force.size
    # A grain has up to some 50 contacts, each good to a few eps of the largest force around it; the
    # overlap loses eps of the position (width 0.2 m) over the overlap itself.
    scale = LAW["k_n"] * np.ptp(reference.x)
    fx, fy, turn = by_number(system, "fx", "fy", "torque")
    assert np.abs(np.column_stack([fx, fy]) - force).max() < 50.0 * EPS * scale
    assert np.abs(turn - torque).max() < 50.0 * EPS * scale * start.grains.radius.max()


def test_skin_does_not_change_the_motion_of_several_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sorted anew by every list: sums in other orders."""
    runs = []
    for skin in (1e-5, 1e-2):
        with monkeypatch.context() as patch:
            with_skin(skin, patch)
            runs.append(crowd(2500, 5.0).system())
            runs[-1].list.smallest = np.inf  # the skin alone decides when a list is stale
            runs[-1].advance(300)
    small, large = runs
    assert small.rebuilds > 20
    assert large.rebuilds < 4
    scale = np.hypot(small.grains.vx, small.grains.vy).max()
    for name, size in (("x", 300 * DT * scale), ("y", 300 * DT * scale), ("vx", scale), ("vy", scale)):
        # Round-off, grown by the collisions of 300 steps.
        assert np.abs(by_number(small, name)[0] - by_number(large, name)[0]).max() < 1e-9 * size


def test_histories_survive_many_rebuilds(monkeypatch: pytest.MonkeyPatch) -> None:
    """A long run, whose lists are made anew every few steps, of grains fast enough to meet, part and slip."""
    reference = crowd(150, 4.0).dense()
    with_skin(5e-6, monkeypatch)
    system = crowd(150, 4.0).system()
    places, steps = reference.x.copy(), 400
    system.advance(steps)
    reference.run(steps, DT)
    assert system.rebuilds > 50
    x, y, spin = by_number(system, "x", "y", "omega")
    moved = np.abs(reference.x - places).max()
    assert moved > 1e-4
    # Round-off grows where discs collide; a lost or misplaced spring shows at 1e-6 of the motion.
    assert np.abs(np.column_stack([x, y]) - reference.x).max() < 1e-10 * moved
    assert np.abs(spin - reference.omega).max() < 1e-9 * np.abs(reference.omega).max()


def test_prescribed_bodies_that_touch_exert_finite_forces_without_moment() -> None:
    # Glued grains on a row of fixed ones: no inertia from which a rolling dashpot could follow.
    grains = Grains.discs([[0.1, 0.1]], R, 1600.0)
    grains = grains.with_prescribed([[0.0, 0.0]], R, 0).with_prescribed([[1.9 * R, 0.0]], R, 1)
    system = full_law(grains, **LAW, time_step=DT)
    system.advance(3)
    assert system.force_on(slice(1, 3)) == pytest.approx(np.array([[-20.0, 0.0], [20.0, 0.0]]), rel=1e-9)
    assert system.grains.torque[1:] == pytest.approx([0.0, 0.0])
    assert np.isfinite(list(system.energies().values())).all()
