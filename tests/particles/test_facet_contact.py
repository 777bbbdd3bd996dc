"""Discs that rest, slide and roll on a polyline: nodes are not felt, springs are handed over."""

import numba
import numpy as np
import pytest
from discs import FLOOR, balance, by_number, full_law, normal_only, resting_disc
from polylines import closed, ground, held

from particles import Facets, Grains, ParticleSystem, neighbours, sharp_limit
from particles.spots import deepest_touch

EPS = np.finfo(float).eps
STEPS = 500
RADIUS, MASS, G, K_N, K_T = 0.005, 0.083, 9.81, 6.5e4, 3.3e3
FLAT = ground(np.linspace(-0.05, 0.15, 21))  # nodes every two radii
CENTRE = np.array([0.063, 0.052])


def dragged(
    facets: Facets, *, speed: float, friction: float, steps: int, mu_r: float = 0.0, **law: float
) -> np.ndarray:
    """Force (steps, 2) on a disc that is drawn along flat ground at an overlap of 1 % and does not turn."""
    disc = held(np.array([[-0.001, 0.99 * RADIUS]]), RADIUS)
    options = {"k_n": K_N, "k_t": K_T, "mu": friction, "mu_r": mu_r} | law
    system = full_law(disc, **options, facets=facets, time_step=1e-5)
    system.set_velocity(slice(0, 1), [speed, 0.0])
    force = np.zeros((steps, 2))
    for k in range(steps):
        system.advance(1)
        force[k] = system.grains.fx[0], system.grains.fy[0]
    return force


@pytest.mark.parametrize("start", [0.01, 0.012345, 0.015])  # on a node, anywhere, in the middle of a facet
def test_disc_at_rest_has_its_weight_below_it(start: float) -> None:
    grains = resting_disc(radius=RADIUS, mass=MASS, gravity=G, k_n=K_N)
    grains.x[:] = start
    system = full_law(grains, k_n=K_N, k_t=K_T, mu=0.5, facets=FLAT, gravity=(0.0, -G), time_step=1e-5)
    system.advance(1000)
    force, place = system.facets.force, system.facets.places
    # k eps r over the weight: the overlap is a difference of lengths as large as r
    round_off = 16.0 * EPS * K_N * RADIUS
    np.testing.assert_allclose(force.sum(axis=0), [0.0, -MASS * G], atol=round_off)
    assert force[:, 1] @ place[:, 0] == pytest.approx(-MASS * G * start, abs=round_off)
    assert np.count_nonzero(force[:, 1]) <= 2
    assert np.ravel(by_number(system, "x", "vx", "omega")) == pytest.approx([start, 0.0, 0.0], abs=1e-15)


def test_frictionless_sliding_keeps_its_speed() -> None:
    grains = resting_disc(radius=RADIUS, mass=MASS, gravity=G, k_n=K_N, vx=0.5)
    system = normal_only(grains, k_n=K_N, facets=FLAT, gravity=(0.0, -G), time_step=1e-5)
    for _ in range(20):
        system.advance(1000)  # half a facet
        assert system.grains.vx[0] == pytest.approx(0.5, rel=1e-13)  # eps of the normal at each of 1000 steps
        # the overlap is good to eps of the place of the disc, the speed to its share of omega
        assert abs(system.grains.vy[0]) < 1e-11
    assert system.grains.x[0] == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize("friction", [0.2, 1e9])
@pytest.mark.parametrize("turns", [0.0, 1e-6, -1e-6])
def test_friction_of_a_dragged_disc_has_no_memory_lapse_at_nodes(friction: float, turns: float) -> None:
    """Closed form of the spring, `min(k_t x, mu F_n)`, on straight ground and on one that waves by a millionth."""
    node = np.linspace(-0.05, 0.15, 81)  # half a radius apart
    force = dragged(ground(node, RADIUS * turns * (np.arange(81) % 2)), speed=0.5, friction=friction, steps=2000)
    way = 0.5e-5 * np.arange(1, 2001)
    normal = 0.01 * RADIUS * K_N
    waves = 4.0 * abs(turns) * K_N * RADIUS
    np.testing.assert_allclose(force[:, 1], normal, atol=waves + 16.0 * EPS * K_N * RADIUS)
    expected = -np.minimum(K_T * way, friction * normal)
    # A facet that slopes by 4 turns tilts the normal force, and lengthens the way by its square.
    np.testing.assert_allclose(force[:, 0], expected, atol=2.0 * waves + 1e-12 * K_T * 0.01)


def test_spring_goes_around_a_corner_and_through_a_notch() -> None:
    """A disc led at constant overlap around a corner of 0.6 rad, and into a shallow notch: it keeps what it has.

    The spring of an endless slide without a limit is k_t times the way of the material that passed below the
    disc: of its own rim alone, as the ground rests. Around a corner the foot rests on the node, and a disc that
    does not turn rolls over it by the angle.
    """
    turn, arm = 0.6, 0.99 * RADIUS
    corner = ground(np.array([-0.05, 0.0, 0.05]), np.array([-0.05, 0.0, -0.05]) * np.tan(turn / 2))
    angle = np.linspace(turn / 2, -turn / 2, 201)  # of the normal, from the left
    around = arm * np.column_stack([-np.sin(angle), np.cos(angle)])
    slope = np.array([np.cos(turn / 2), np.sin(turn / 2)])
    before = around[0] - np.linspace(0.004, 0.0, 200, endpoint=False)[:, None] * slope
    after = around[-1] + np.linspace(0.0, 0.004, 201)[1:, None] * slope * [1.0, -1.0]
    path, dt = np.concatenate([before, around, after]), 1e-4
    system = full_law(held(path[:1], RADIUS), k_n=K_N, k_t=K_T, mu=1e9, facets=corner, time_step=dt)
    system.start()
    tangential = []
    for place in path[1:]:
        system.steer(slice(0, 1), place[None], dt)
        system.advance(1)
        push = np.array([system.grains.fx[0], system.grains.fy[0]])
        tangential.append(np.sqrt(max(push @ push - (0.01 * RADIUS * K_N) ** 2, 0.0)))
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])[1:]
    # chords instead of arcs, and the turn of the frame within a step: a share (turn/200)^2
    np.testing.assert_allclose(tangential, K_T * way, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("mu_r", [0.0, 0.05])
def test_rolling_down_a_slope_is_that_on_a_wall(mu_r: float) -> None:
    """The same but for the lever arm, r - delta instead of r - delta/2: a difference of the order of delta/r."""
    slope, found, steps = 0.2, [], 20000
    gravity = (G * np.sin(slope), -G * np.cos(slope))
    delta = MASS * G * np.cos(slope) / K_N
    law = {"k_n": K_N, "k_t": K_T, "mu": 0.8, "mu_r": mu_r, "c_n": 36.5, "c_t": 5.7, "eta_r": 0.3 if mu_r else 0.0}
    options = {"gravity": gravity, "time_step": 1e-5}
    for boundary in ({"walls": [FLOOR]}, {"facets": FLAT}):
        grains = resting_disc(radius=RADIUS, mass=MASS, gravity=G * np.cos(slope), k_n=K_N)
        system = full_law(grains, **law, **options, **boundary)
        system.advance(steps)
        found.append(np.array(by_number(system, "x", "vx", "omega"))[:, 0])
    wall, polyline = found
    assert wall[0] > 3.0 * RADIUS  # over a node and more
    np.testing.assert_allclose(polyline, wall, rtol=1.5 * delta / RADIUS)
    if mu_r == 0.0:  # no slip: m (1 + I/(m a^2)) x'' = m g sin(slope) with the arm a = r - delta
        a = RADIUS - delta
        acceleration = G * np.sin(slope) / (1.0 + 0.5 * (RADIUS / a) ** 2)
        # it sticks from rest but for the spring that must be strained first
        assert polyline[1] == pytest.approx(acceleration * steps * 1e-5, rel=1e-3)
        assert polyline[1] == pytest.approx(-a * polyline[2], rel=1e-3)


def test_nodes_do_not_change_the_motion_of_a_rolling_disc() -> None:
    """Ground of one facet and of many: the same to round-off, with all laws."""
    ends = []
    for facets in (ground(np.array([-0.05, 0.15])), FLAT):
        grains = resting_disc(radius=RADIUS, mass=MASS, gravity=G, k_n=K_N, vx=0.4, spin=30.0)
        system = full_law(
            grains, k_n=K_N, k_t=K_T, mu=0.3, mu_r=0.02, c_n=36.5, c_t=5.7, eta_r=0.3,
            facets=facets, gravity=(0.0, -G), time_step=1e-5,
        )  # fmt: skip
        system.start()
        start = balance(system)
        system.advance(20000)
        ends.append([*np.ravel(by_number(system, "x", "vx", "omega")), *system.energies().values()])
        # the sum of all lines does not know of nodes either: a few roundings of the energy at every step
        assert balance(system) == pytest.approx(start, abs=20000 * 8 * EPS * MASS * 0.4**2)
    np.testing.assert_allclose(ends[1], ends[0], rtol=1e-9, atol=1e-12)


def test_facets_that_move_take_a_disc_along() -> None:
    """A belt: a disc laid on it reaches its speed, and the belt has done the work that friction takes and leaves."""
    speed, mu = 0.1, 0.3
    grains = resting_disc(radius=RADIUS, mass=MASS, gravity=G, k_n=K_N)
    belt = ground(np.linspace(-0.05, 0.05, 11))
    system = full_law(grains, k_n=K_N, k_t=K_T, mu=mu, c_t=5.7, facets=belt, gravity=(0.0, -G), time_step=1e-5)
    system.facets.set_velocity([speed, 0.0])
    system.start()
    start = balance(system)
    system.advance(1000)
    # slip at the limit: x'' = mu g, but for the strain of the spring, mu m g/k_t of the way, at the start
    assert system.grains.vx[0] == pytest.approx(mu * G * 0.01, rel=0.05)
    system.advance(40000)
    # rolling on the belt: m a v = -I w about the foot, v - a w = speed, with the arm a = r - delta
    arm = RADIUS - MASS * G / K_N
    assert system.grains.vx[0] == pytest.approx(speed / (1.0 + 2.0 * (arm / RADIUS) ** 2), rel=1e-5)
    energies = system.energies()
    assert energies["work_facets"] > energies["loss_sliding"] > 0.0
    assert balance(system) - start == pytest.approx(0.0, abs=1e-9 * energies["work_facets"])


def pile(threads: int = 1, **options: object) -> ParticleSystem:
    """Discs that fly about around a spinning, growing polygon with corners and notches."""
    random = np.random.default_rng(5)
    n = 3000
    place = np.column_stack([np.arange(n) % 60 * 2.1e-3, np.arange(n) // 60 * 2.1e-3])
    turn = 2.0 * np.pi * np.arange(40) / 40
    ring = np.column_stack([np.cos(turn), np.sin(turn)]) * (0.02 + 1e-3 * random.uniform(0.0, 1.0, (40, 1)))
    place = place[np.hypot(*(place - CENTRE).T) > 0.022]
    radius = random.uniform(0.8e-3, 1e-3, len(place))
    grains = Grains.discs(place, radius, 1600.0, velocity=random.normal(0.0, 0.5, place.shape))
    system = full_law(
        grains, k_n=2e5, k_t=1e4, c_n=6.0, c_t=1.0, mu=0.5, mu_r=0.1, eta_r=0.3, gravity=(0.0, -G), time_step=3e-6,
        facets=closed(ring + CENTRE), threads=threads, **options,
    )  # fmt: skip
    system.facets.set_velocity(3.0 * np.column_stack([-ring[:, 1], ring[:, 0]]) / 0.02 + 50.0 * ring)
    return system


def test_momentum_angular_momentum_and_energy_pass_to_the_nodes() -> None:
    """Of many discs and a rotating, rising, spreading polygon: forces, moments and works balance to round-off."""
    system = pile()
    system.start()
    start = balance(system)
    worst = 0.0
    for _ in range(40):
        system.advance(25)
        g, facets = system.grains, system.facets
        force, place = facets.force, facets.places
        scale = np.abs(force).sum()
        total = np.array([g.fx.sum(), g.fy.sum()]) + force.sum(axis=0)
        moment = (g.x * g.fy - g.y * g.fx + g.torque).sum() + (
            place[:, 0] * force[:, 1] - place[:, 1] * force[:, 0]
        ).sum()
        worst = max(worst, *np.abs(total) / scale, abs(moment) / scale / 0.1) if scale else worst
    assert scale > 0.0
    assert (system.look().contacts > 0).sum() > 100
    assert worst < 1e3 * EPS  # some hundred forces are added, each of a few roundings
    energies = system.energies()
    turned = energies["kinetic"]
    # the turn of the normals within a step, and births: as for discs alone (test_energy_ledger)
    assert abs(balance(system) - start) < 2e-3 * turned
    assert energies["work_facets"] > 0.01 * turned


def test_impulse_on_the_nodes_is_what_the_discs_lost() -> None:
    system = pile()
    system.start()
    before, scale = system.momentum(), (system.grains.mass * np.abs(system.grains.vy)).sum()
    steps = STEPS
    system.advance(steps)
    weight = -system.grains.mass.sum() * G * steps * 3e-6
    lost = before + [0.0, weight] - system.momentum()
    gained = system.facets.impulse.sum(axis=0)
    assert np.hypot(*gained) > 1e-3 * scale
    np.testing.assert_allclose(gained, lost, atol=steps * EPS * scale)


def same(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> bool:
    return one.keys() == other.keys() and all(np.array_equal(one[name], other[name]) for name in one)


def test_same_bits_with_threads_in_pieces_and_after_a_restore() -> None:
    whole = pile()
    assert len(whole.blocks) > 3
    whole.advance(STEPS)
    reference = whole.state()
    if numba.config.NUMBA_NUM_THREADS > 1:
        threaded = pile(threads=2)
        threaded.advance(STEPS)
        assert same(threaded.state(), reference)
    first, second = pile(), pile()
    for _ in range(10):
        first.advance(13)
    saved = first.state()
    first.advance(20)
    second.advance(7)
    second.restore(saved)
    second.advance(STEPS - 130)
    after = second.state()
    after["facets.impulse"] = reference["facets.impulse"]  # of the last call alone
    assert same(after, reference)


def test_ledger_does_not_touch_the_motion() -> None:
    runs = [pile(ledger=ledger) for ledger in (True, False)]
    for system in runs:
        system.advance(STEPS)
    for name in ("x", "y", "omega"):
        assert np.array_equal(*(getattr(system.grains, name) for system in runs))
    assert np.array_equal(runs[0].facets.force, runs[1].facets.force)


def test_lists_of_any_skin_move_discs_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    """The nodes move too: a list that did not see that would miss contacts."""
    found = []
    for skin in (2e-5, 2e-4, 1e-3):
        monkeypatch.setattr(neighbours, "choose_skin", lambda grains, dt, other=0.0, skin=skin: skin)
        system = pile()
        system.advance(STEPS)
        found.append((system.rebuilds, np.array(by_number(system, "x", "y")), system.facets.force))
    assert found[0][0] > 10 * found[2][0]
    for _, place, force in found[1:]:
        # round-off, grown by the collisions of all steps
        assert np.abs(place - found[0][1]).max() < 1e-9 * 1e-3
        assert np.abs(force - found[0][2]).max() < 1e-7 * np.abs(force).max()


@pytest.mark.parametrize("place", [0.0123, 0.01])
@pytest.mark.parametrize("notch", [0.0, 1e-4])
def test_limit_of_the_step_is_that_on_a_wall(place: float, notch: float) -> None:
    """Beside a node and above one, where in a shallow notch three springs, one of them negative, stand for one."""
    limits = []
    node = np.linspace(-0.05, 0.15, 21)
    for boundary in ({"walls": [FLOOR]}, {"facets": ground(node, notch * np.abs(node - 0.01))}):
        grains = resting_disc(radius=RADIUS, mass=MASS, gravity=G, k_n=K_N)
        grains.x[:] = place
        law = {"k_n": K_N, "k_t": K_T, "mu": 0.8, "mu_r": 0.1, "c_n": 36.5, "c_t": 5.7, "eta_r": 0.3}
        limits.append(sharp_limit(full_law(grains, **law, gravity=(0.0, -G), time_step=1e-5, **boundary)))
    wall, facets = limits
    assert wall.contacts == facets.contacts == 1
    # arm r - delta instead of r - delta/2 in the tangential springs, and a normal that leans by the notch
    assert facets.step == pytest.approx(wall.step, rel=MASS * G / K_N / RADIUS + notch)


def test_message_of_a_contact_knows_facets() -> None:
    """The deepest contact of a disc that a rising facet meets, and one that nothing touches."""
    grains = Grains.discs([[0.01, 0.98 * RADIUS], [0.05, 0.05]], RADIUS, 1000.0, velocity=[[3.0, -0.5], [0.0, 0.0]])
    system = full_law(grains, k_n=K_N, k_t=K_T, mu=0.5, facets=FLAT, time_step=1e-5)
    system.facets.set_velocity([1.0, 0.25])
    system.start()
    place = int(np.argmin(system.grains.number))
    touch = deepest_touch(system, place)
    assert (touch.partner, touch.wall) == (None, None)
    assert touch.depth == pytest.approx(0.02, rel=1e-12)
    # half a kick of the spring, less the dashpot's zero, lies between: k delta dt/(2 m) = 0.4 mm/s
    assert touch.approach == pytest.approx(0.75, abs=1e-3)
    assert deepest_touch(system, 1 - place) is None
