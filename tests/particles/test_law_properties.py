"""What must hold for every contact law, whatever its numbers: one test for all laws at once."""

import math
from dataclasses import replace

import hypothesis.strategies as st
import numpy as np
import pytest
from driven_pair import Drive, Seen, any_drive, driven, driven_at_a_wall, signed, turned, turntable
from every_law import (
    EPS,
    KINDS,
    MANY,
    Pair,
    any_pair,
    contact_of,
    decades,
    discs_of,
    limits,
    or_none,
    system_of,
)
from hypothesis import Phase, given, settings

from particles import Grains, ParticleSystem

FEW = settings(MANY, max_examples=12, phases=[Phase.generate])
SPRUNG = [kind for kind in KINDS if kind != "normal only"]
every_kind = pytest.mark.parametrize("kind", KINDS)


def rounding(pair: Pair, drive: Drive, contact: Seen) -> float:
    """Force [N/m] that a rounding of the lengths and velocities makes, through springs and dashpots."""
    steeper = math.sqrt(max(1.0, contact.delta / pair.delta))  # Hertz's spring beyond the overlap of slope k
    roll = pair.roll + pair.roll_zeta * math.sqrt(pair.roll)
    stiffness = pair.k * steeper * (1.0 + pair.shear * (1.0 + roll))
    dashpot = pair.critical(pair.k * steeper) * (pair.zeta + math.sqrt(pair.shear) * (pair.shear_zeta + roll))
    return EPS * (stiffness * float(pair.radii.sum()) + dashpot * float(np.abs(drive.velocities(pair)).max()))


def clear_of_touching(pair: Pair, *contacts: Seen) -> bool:
    """Whether it is plain that a contact is closed or open: at touching, forces may jump."""
    return all(abs(contact.delta) > 1e3 * EPS * pair.radii.sum() for contact in contacts)


@every_kind
@MANY
@given(pair=any_pair(), drive=any_drive)
def test_action_is_minus_reaction_and_angular_momentum_is_kept(kind: str, pair: Pair, drive: Drive) -> None:
    for contact in driven(kind, pair, drive):
        assert (contact.force[0] == -contact.force[1]).all()
        x, y = contact.apart
        about_the_first = contact.torque.sum() + x * contact.force[1, 1] - y * contact.force[1, 0]
        # Four products, each of a force and an arm known to a few eps of the reach; moments cancel exactly.
        size = np.abs(contact.force[0]).max() * float(pair.radii.sum())
        assert abs(about_the_first) <= 8.0 * EPS * (size + np.abs(contact.torque).max())


@every_kind
@MANY
@given(pair=any_pair(), drive=any_drive)
def test_limits_are_never_passed_and_nothing_pulls(kind: str, pair: Pair, drive: Drive) -> None:
    mu, mu_r = limits(kind, pair)
    for contact in driven(kind, pair, drive):
        noise = 8.0 * EPS * float(np.abs(contact.force[0]).max())  # of the components seen here
        assert pair.may_pull or contact.f_n >= -noise
        assert abs(contact.f_t) <= mu * abs(contact.f_n) + (1.0 + mu) * noise
        noise = 8.0 * EPS * abs(contact.torque[0]) + float(pair.radii.max()) * noise
        if kind != "normal only":
            assert abs(contact.moment) <= mu_r * pair.reduced_radius * abs(contact.f_n) + (1.0 + mu_r) * noise


@every_kind
@MANY
@given(pair=any_pair(), drive=any_drive)
def test_walls_obey_the_same_limits(kind: str, pair: Pair, drive: Drive) -> None:
    mu, mu_r = limits(kind, pair)
    for contact in driven_at_a_wall(kind, pair, drive):
        assert (contact.force[0] == -contact.force[1]).all()
        noise = 8.0 * EPS * float(np.abs(contact.force[0]).max())
        if contact.delta < -4.0 * EPS * pair.radius * (2.0 + abs(drive.gap) * pair.overlap):
            assert (contact.force == 0.0).all()
            assert (contact.torque == 0.0).all()
        assert pair.may_pull or contact.f_n >= -noise
        assert abs(contact.f_t) <= mu * abs(contact.f_n) + (1.0 + mu) * noise
        if kind != "normal only":
            noise = 8.0 * EPS * abs(contact.torque[0]) + pair.radius * noise
            assert abs(contact.moment) <= mu_r * pair.radius * abs(contact.f_n) + (1.0 + mu_r) * noise


@every_kind
@MANY
@given(pair=any_pair(), drive=any_drive)
def test_no_force_without_overlap(kind: str, pair: Pair, drive: Drive) -> None:
    found = driven(kind, pair, replace(drive, gap=abs(drive.gap)))  # starts apart, may meet and part again
    for contact in found:
        if contact.delta < -4.0 * EPS * pair.radii.sum():
            assert (contact.force == 0.0).all()
            assert (contact.torque == 0.0).all()


@every_kind
@MANY
@given(
    pair=any_pair(),
    drive=any_drive,
    turn=st.floats(-math.pi, math.pi),
    shift=signed(-2.0, 1.0),
    wind=signed(-2.0, 0.0),
)
def test_turned_shifted_and_moving_pairs_feel_the_same(
    kind: str, pair: Pair, drive: Drive, turn: float, shift: float, wind: float
) -> None:
    """Objectivity: rotation by any angle, translation by radii, a uniform velocity that adds to all."""
    size = float(pair.radii.sum())
    speed = wind * 0.01 * pair.radii.min() / drive.time_step(pair)
    still = driven(kind, pair, drive)
    moved = driven(kind, pair, drive, turn=turn, shift=shift * size, wind=speed)
    if not clear_of_touching(pair, *still, *moved):
        return
    for before, after in zip(still, moved, strict=True):
        # Lengths and velocities that are (1 + shift) and (1 + wind) times as large are rounded in some ten places.
        tolerance = 40.0 * (1.0 + abs(shift)) * (1.0 + abs(wind)) * rounding(pair, drive, before)
        assert abs(after.f_n - before.f_n) <= tolerance
        assert abs(after.f_t - before.f_t) <= tolerance * (1.0 + pair.mu)
        assert np.abs(after.torque - before.torque).max() <= tolerance * (1.0 + pair.mu + pair.mu_r) * size


@pytest.mark.parametrize("kind", SPRUNG)
@FEW
@given(pair=any_pair(overlap=decades(-4.0, -1.5), mu=st.just(1e12), mu_r=st.just(1e12)), steps=st.integers(200, 400))
def test_pair_that_turns_as_one_body_keeps_its_springs(kind: str, pair: Pair, steps: int) -> None:
    """A whole turn of a sheared and rolled contact, led on the circle: the springs turn with it.

    Leading along chords of the angle phi moves the surfaces by d (sin phi - phi) in a step, the
    only increment there is: of order 2 in the step.
    """
    system = turntable(kind, pair, 1e3 / pair.omega_0)  # slowly: the chords part the discs, which dashpots resist
    path, phi = 1e-3 * pair.distance, 2.0 * math.pi / steps
    turned(system, pair, path=path, roll=1e-3)
    before = turned(system, pair, path=0.0, roll=0.0)  # without motion there is no dashpot
    stored = system.energies()
    g = system.grains
    for step in range(1, steps + 1):
        goal = pair.distance * np.array([math.cos(step * phi), math.sin(step * phi)])
        system.steer(slice(1, 3), np.array([[0.0, 0.0], goal]), system.time_step)
        g.omega[1:] = phi / system.time_step
        system.advance(1)
    system.set_velocity(slice(1, 3), (0.0, 0.0))
    after = turned(system, pair, path=0.0, roll=0.0)
    slip = steps * pair.distance * (math.sin(phi) - phi)
    # Every step rounds the place and with it the overlap, by eps of the distance.
    noise = 10.0 * EPS * steps * pair.distance / min(path, pair.delta)
    assert after.f_t / before.f_t == pytest.approx(1.0 + slip / path, abs=noise * max(1.0, 1e2 * path / pair.delta))
    rolled = system.energies()["rolling_springs"]
    assert rolled == pytest.approx(stored["rolling_springs"], rel=noise)


def gradient(kind: str, pair: Pair, place: np.ndarray, size: float) -> np.ndarray:
    """Central difference of the normal springs' energy in the place of the second disc [N/m]."""
    system = system_of(kind, discs_of(pair, np.array([[0.0, 0.0], place])), contact_of(kind, pair), dt=1.0)
    system.start()
    second = int(np.argmax(system.grains.number))
    slope = np.zeros(2)
    for axis, coordinate in enumerate((system.grains.x, system.grains.y)):
        here = coordinate[second]
        for sign in (1.0, -1.0):
            coordinate[second] = here + sign * size
            slope[axis] += sign * system.look().normal_energy / (2.0 * size)
        coordinate[second] = here
    return slope


@every_kind
@MANY
@given(pair=any_pair(overlap=decades(-3.0, -1.0)), turn=st.floats(-math.pi, math.pi))
def test_normal_force_is_minus_the_gradient_of_the_stored_energy(kind: str, pair: Pair, turn: float) -> None:
    place = pair.distance * np.array([math.cos(turn), math.sin(turn)])
    system = system_of(kind, discs_of(pair, np.array([[0.0, 0.0], place])), contact_of(kind, pair), dt=1.0)
    system.start()  # forces at rest: no dashpots, no tangential springs
    force = system.force_on(slice(0, 2))[int(np.argmax(system.grains.number))]
    h = 1e-4
    # Truncated at h^2 of the overlap (and of the normal's turn, less); the energy loses eps of the reach over 2 h.
    tolerance = h**2 + 8.0 * EPS * pair.distance / (pair.delta * h)
    error = np.abs(force + gradient(kind, pair, place, h * pair.delta)).max()
    assert error <= tolerance * float(np.hypot(*force))


@pytest.mark.parametrize("kind", SPRUNG)
@MANY
@given(
    pair=any_pair(overlap=decades(-4.0, -1.5), mu=st.just(1e12), mu_r=st.just(1e12)),
    path=decades(-6.0, 0.0),
    roll=decades(-6.0, 0.0),
)
def test_springs_give_the_work_done_on_them(kind: str, pair: Pair, path: float, roll: float) -> None:
    """Slip and roll at a fixed overlap: force and moment are the slopes of the stored energy, the torques agree.

    Both springs are linear in their own coordinate, so that the energy is half of force times path.
    """
    system = turntable(kind, pair, 1e-3 / pair.omega_0)
    turned(system, pair, path=path * pair.delta, roll=roll)
    contact = turned(system, pair, path=0.0, roll=0.0)
    energies = system.energies()
    noise = 20.0 * EPS * pair.distance / pair.delta  # of the overlap, in k_t
    path_noise = 20.0 * EPS * (1.0 + pair.distance * roll / (path * pair.delta))  # two turns that nearly cancel
    shear = 0.5 * contact.f_t * path * pair.delta
    assert energies["tangential_springs"] == pytest.approx(shear, rel=noise + path_noise)
    assert contact.f_t > 0.0  # j went along +t: i is dragged after it
    if kind in ("damped rolling", "elastic rolling", "table"):
        moment_noise = 20.0 * EPS * float(pair.radii.max()) * contact.f_t / abs(contact.moment)
        assert energies["rolling_springs"] == pytest.approx(-0.5 * contact.moment * roll, rel=noise + moment_noise)
        assert contact.moment < 0.0  # i rolled forward: it is held back
    else:
        assert energies["rolling_springs"] == 0.0


def led_through_a_contact(
    kind: str, pair: Pair, spins: np.ndarray, steps: int
) -> tuple[ParticleSystem, float, float, float]:
    """Press two discs together and part them while they turn by `spins` (2, 3), amplitudes [rad] of sines.

    Returns the system, the trapezoidal work [J/m] done on the contact, the sum of its magnitude over the steps, and
    ``k s^2`` of the largest slip and roll of one step.
    """
    dt = 0.02 / pair.omega_0
    start = float(pair.radii.sum())
    grains = discs_of(pair, np.array([[0.0, 0.0], [start * (1.0 + 1e-9), 0.0]]))
    system = system_of(kind, grains, contact_of(kind, pair), dt=dt)
    system.start()
    time = np.arange(steps + 1) / steps
    place = start - 2.0 * pair.delta * np.sin(math.pi * time) ** 2
    place[0] = start * (1.0 + 1e-9)
    place[-1] = start + 1e-3 * pair.delta
    angle = spins @ np.sin(math.pi * np.outer([1.0, 2.0, 5.0], time))
    velocity, omega = np.diff(place) / dt, np.diff(angle, axis=1) / dt
    work = turnover = 0.0
    before = np.zeros(3)
    for step in range(steps):
        g, (first, second) = system.grains, np.argsort(system.grains.number)
        g.vx[:] = g.vy[:] = 0.0
        g.vx[second] = velocity[step]
        g.omega[[first, second]] = omega[:, step]
        system.advance(1)
        g, (first, second) = system.grains, np.argsort(system.grains.number)
        now = np.array([g.fx[second], g.torque[first], g.torque[second]])
        done = -0.5 * dt * (before + now) @ [velocity[step], *omega[:, step]]
        work, turnover, before = work + done, turnover + abs(done), now
    slip, roll = (pair.radii @ np.abs(np.diff(angle))).max(), np.abs(np.diff(angle[0] - angle[1])).max()
    k_t = pair.shear * pair.k * (math.sqrt(2.0) if kind == "Mindlin" else 1.0)
    jerk = k_t * (slip**2 + pair.roll * (pair.reduced_radius * roll) ** 2)
    return system, float(work), float(turnover), float(jerk)


@every_kind
@FEW
@given(
    pair=any_pair(overlap=decades(-4.0, -2.0), may_pull=st.just(False)),
    spins=st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6).map(lambda a: np.array(a).reshape(2, 3)),
    slip=decades(-1.0, 2.0),
)
def test_a_contact_never_gives_more_than_it_took(kind: str, pair: Pair, spins: np.ndarray, slip: float) -> None:
    """Every loss is positive over a whole contact up to one step's share, and their sum is the work done on it."""
    angles = spins * slip * pair.delta / pair.radii[:, None]
    system, work, turnover, jerk = led_through_a_contact(kind, pair, angles, 300)
    energies = system.energies()
    losses = np.array([value for name, value in energies.items() if name.startswith("loss")])
    assert all(energies[name] == 0.0 for name in energies if name.endswith("springs"))
    # In one step the trapezoid of a spring of force a that is sheared back by s to the other limit, or opened,
    # takes down to -k s^2/8: twice where the limits are small, at birth and at opening.
    assert losses.min() >= -0.25 * jerk
    # Trapezoids of the steps in which the contact is born and opens, and of Hertz's curve: (2 pi/300)^2/12 at most.
    assert abs(work - losses.sum()) <= 4e-5 * turnover + 0.5 * jerk


def without_underflow(speeds: list[float]) -> np.ndarray:
    """Zero in place of numbers whose products with a unit would lose digits."""
    return np.array([speed if abs(speed) > 1e-100 else 0.0 for speed in speeds])


def unfolded(pair: Pair, length: float, mass: float, time: float) -> Pair:
    """The same pair measured in other units."""
    return replace(
        pair, radius=pair.radius * length, density=pair.density * mass / length**2, k=pair.k * mass / time**2
    )


def collide(kind: str, pair: Pair, speeds: np.ndarray, units: tuple[float, float, float], steps: int) -> np.ndarray:
    """Places, angles, velocities, forces and energies after a collision, over the pair's own scales."""
    length, mass, time = units
    own = unfolded(pair, *units)
    apart = pair.distance + 1.93 * pair.delta  # touching amid a step: Tsuji's dashpot has no slope at touching
    start = np.array([[0.0, 0.0], [0.6, 0.8]]) * (length * apart)
    speed = length / time
    grains = Grains.discs(
        start,
        own.radii,
        own.density,
        material=[0, 1],
        velocity=speeds[:4].reshape(2, 2) * speed,
        spin=speeds[4:] / pair.radii / time,
    )
    contact = contact_of(kind, own)
    system = system_of(kind, grains, contact, dt=0.05 / pair.omega_0 * time, alpha=0.01 * pair.omega_0 / time)
    system.advance(steps)
    g = system.grains
    order = np.argsort(g.number)
    force, fast, push = mass * length / time**2, pair.delta * pair.omega_0, pair.k * pair.delta
    columns = [(g.x, length, pair.delta), (g.y, length, pair.delta), (g.theta, 1.0, pair.delta / pair.radius)]
    columns += [(g.vx, speed, fast), (g.vy, speed, fast), (g.omega, 1.0 / time, fast / pair.radius)]
    columns += [(g.fx, force, push), (g.fy, force, push), (g.torque, force * length, push * pair.radius)]
    energies = np.array(list(system.energies().values())) / (force * length) / (push * pair.delta)
    return np.concatenate([column[order] / unit / scale for column, unit, scale in columns] + [energies])


@every_kind
@FEW
@given(
    pair=any_pair(
        overlap=decades(-3.0, -1.5), zeta=or_none(decades(-3.0, -0.3)), shear_zeta=or_none(decades(-3.0, -0.3))
    ),
    speeds=st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6).map(without_underflow),
    powers=st.tuples(st.integers(-12, 12), st.integers(-20, 20), st.integers(-20, 20)),
)
def test_units_do_not_matter(kind: str, pair: Pair, speeds: np.ndarray, powers: tuple[int, int, int]) -> None:
    """Scaled by powers of two, the same bits; from m, kg, s to mm, g, ms, round-off.

    Powers of four in length: Hertz's stiffness has its root.
    """
    motion = speeds * pair.delta * pair.omega_0
    motion[:2] += np.array([0.6, 0.8]) * 2.0 * pair.delta * pair.omega_0
    steps = 120
    first = collide(kind, pair, motion, (1.0, 1.0, 1.0), steps)
    units = (4.0 ** powers[0], 2.0 ** powers[1], 2.0 ** powers[2])
    assert np.array_equal(collide(kind, pair, motion, units, steps), first)
    decimal = collide(kind, pair, motion, (1e3, 1e3, 1e3), steps)
    # In every step the places round by eps of the distance, which is felt through the overlap.
    noise = 4.0 * steps * EPS * pair.distance / pair.delta
    assert np.abs(decimal - first).max() <= noise * max(1.0, np.abs(first[4:]).max())
