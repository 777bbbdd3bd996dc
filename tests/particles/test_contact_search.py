"""The fast search against every pair: same forces, same paths, whatever the lists."""

import numpy as np
import pytest
from dense_reference import Dense
from discs import by_number, full_law, packing

from particles import Grains, ParticleSystem, box, neighbours

LAW = {"k_n": 2e5, "k_t": 1e4, "c_n": 6.0, "c_t": 1.0, "mu": 0.5, "mu_r": 0.1, "eta_r": 0.3}
GRAVITY = (0.5, -9.81)
DT = 2e-6
EPS = np.finfo(float).eps


def crowd(n: int, ratio: float) -> tuple[Grains, dict[str, object]]:
    """A dense random packing in a box with two prescribed bodies inside, and the system's options."""
    grains, width, height = packing(n, seed=n, ratio=ratio)
    biggest = grains.radius.max()
    for body, at in enumerate((0.3, 0.6)):
        ring = at * np.array([width, height]) + 3.0 * biggest * np.column_stack(
            [np.cos(turn := np.linspace(0.0, 2.0 * np.pi, 20, endpoint=False)), np.sin(turn)]
        )
        grains = grains.with_prescribed(ring, 0.5 * biggest, body)
        grains.vx[grains.body == body], grains.vy[grains.body == body] = 0.2, -0.1
    return grains, {"walls": box(width, height), "gravity": GRAVITY, "time_step": DT}


def dense_of(grains: Grains, options: dict[str, object]) -> Dense:
    walls = [(np.array(wall.point), np.array(wall.unit_normal)) for wall in options["walls"]]
    return Dense(
        n_free=grains.n_free, x=grains.position, v=np.column_stack([grains.vx, grains.vy]),
        omega=grains.omega.copy(), radius=grains.radius.copy(), mass=grains.mass.copy(), walls=walls, law=LAW,
        gravity=np.array(GRAVITY), body=grains.body.copy(),
    )  # fmt: skip


@pytest.mark.parametrize(("n", "ratio"), [(300, 10.0), (2500, 10.0), (2500, 1.1)])
def test_forces_equal_those_of_all_pairs(n: int, ratio: float) -> None:
    grains, options = crowd(n, ratio)
    reference = dense_of(grains, options)
    system = full_law(grains, **LAW, **options)
    assert (len(system.blocks) > 3) == (n > 2000)  # several blocks of free grains above 2000
    system.start()
    force, torque = reference.forces(0.0)
    assert np.count_nonzero(force) > 0.9 * force.size
    # A grain has up to some 50 contacts, each good to a few eps of the largest force around it; the
    # overlap loses eps of the position (width 0.2 m) over the overlap itself.
    scale = LAW["k_n"] * np.ptp(reference.x)
    fx, fy, turn = by_number(system, "fx", "fy", "torque")
    assert np.abs(np.column_stack([fx, fy]) - force).max() < 50.0 * EPS * scale
    assert np.abs(turn - torque).max() < 50.0 * EPS * scale * grains.radius.max()


def test_histories_survive_many_rebuilds(monkeypatch: pytest.MonkeyPatch) -> None:
    # Against the dense code, whose springs never move: a skin so small that lists are made anew
    # every few steps, and grains fast enough to meet, part and slip.
    grains, options = crowd(150, 4.0)
    reference = dense_of(grains, options)
    monkeypatch.setattr(neighbours, "choose_skin", lambda grains, dt: 5e-6)
    system = full_law(grains, **LAW, **options)
    steps = 400
    system.advance(steps)
    reference.run(steps, DT)
    assert system.rebuilds > 50
    x, y, spin = by_number(system, "x", "y", "omega")
    moved = np.abs(reference.x - dense_of(*crowd(150, 4.0)).x).max()
    assert moved > 1e-4
    # Round-off grows where discs collide; a lost or misplaced spring shows at 1e-6 of the motion.
    assert np.abs(np.column_stack([x, y]) - reference.x).max() < 1e-10 * moved
    assert np.abs(spin - reference.omega).max() < 1e-9 * np.abs(reference.omega).max()


def run_with_skin(skin: float, steps: int, monkeypatch: pytest.MonkeyPatch) -> ParticleSystem:
    monkeypatch.setattr(neighbours, "choose_skin", lambda grains, dt: skin)
    grains, options = crowd(2500, 5.0)
    system = full_law(grains, **LAW, **options)
    system.advance(steps)
    return system


def test_skin_does_not_change_the_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    small, large = (run_with_skin(skin, 300, monkeypatch) for skin in (1e-5, 1e-2))
    assert small.rebuilds > 20
    assert large.rebuilds < 4
    scale = np.hypot(small.grains.vx, small.grains.vy).max()
    for name, size in (("x", 300 * DT * scale), ("y", 300 * DT * scale), ("vx", scale), ("vy", scale)):
        # Forces are summed in another order: round-off, grown by the collisions of 300 steps.
        assert np.abs(by_number(small, name)[0] - by_number(large, name)[0]).max() < 1e-9 * size


def test_grains_that_leave_the_box_are_still_found() -> None:
    # Two discs far outside any wall, and a third at the origin that stretches the grid.
    far = 1e3
    grains = Grains.discs([[0.0, 0.0], [far, far], [far + 1.9e-3, far]], 1e-3, 1600.0)
    system = full_law(grains, **LAW, time_step=DT)
    system.start()
    # eps of the position 1e3 over the overlap 1e-4.
    assert by_number(system, "fx")[0] == pytest.approx([0.0, -20.0, 20.0], rel=1e-8)


def test_prescribed_bodies_that_touch_exert_finite_forces_without_moment() -> None:
    # Glued grains on a row of fixed ones: no inertia from which a rolling dashpot could follow.
    grains = Grains.discs([[0.1, 0.1]], 1e-3, 1600.0)
    grains = grains.with_prescribed([[0.0, 0.0]], 1e-3, 0).with_prescribed([[1.9e-3, 0.0]], 1e-3, 1)
    system = full_law(grains, **LAW, time_step=DT)
    system.advance(3)
    assert system.force_on(slice(1, 3)) == pytest.approx(np.array([[-20.0, 0.0], [20.0, 0.0]]), rel=1e-9)
    assert system.grains.torque[1:] == pytest.approx([0.0, 0.0])
    assert np.isfinite(list(system.energies().values())).all()
