"""Walls that shake: a column of discs on the floor against the motion of a chain of springs in closed form."""

import numpy as np
import pytest
from discs import FLOOR, balance, by_number, normal_only
from numpy.typing import NDArray
from scipy.linalg import eigh, expm

from particles import Grains, ParticleError, ParticleSystem, Shaking, Wall

K_N, RADIUS, MASS, GRAVITY = 1000.0, 0.5, 0.25, 1.0
DENSITY = MASS / (np.pi * RADIUS**2)
SHAKEN = Wall(point=(0.0, 0.0), normal=(0.0, 1.0), name="floor", shaken=True)
N = 5
PERIOD = 3.0
GAMMA = 0.3  # the response stays below the weight: no contact opens
AMPLITUDE = GAMMA * GRAVITY * (PERIOD / (2 * np.pi)) ** 2


def stiffness() -> NDArray[np.float64]:
    """Of N equal springs in a row over the mass, the first of them on the floor."""
    matrix = 2.0 * np.eye(N) - np.eye(N, k=1) - np.eye(N, k=-1)
    matrix[-1, -1] = 1.0
    return K_N / MASS * matrix


def column(dt: float, motion: Shaking, *, c_n: float = 0.0, scheme: str = "leapfrog") -> ParticleSystem:
    """N discs at rest on each other and on the floor."""
    overlap = MASS * GRAVITY / K_N * np.arange(N, 0, -1)
    height = RADIUS + 2 * RADIUS * np.arange(N) - np.cumsum(overlap)
    place = np.column_stack([np.zeros(N), height])
    grains = Grains.discs(place, RADIUS, DENSITY)
    return normal_only(
        grains, k_n=K_N, c_n=c_n, time_step=dt, walls=[SHAKEN], shaking=motion, gravity=(0.0, -GRAVITY), scheme=scheme
    )


def elastic_chain(time: float) -> NDArray[np.float64]:
    """Displacements under a floor ``A (1 - cos)``, mode by mode: ``q'' + w^2 q = f (1 - cos W t)`` from rest."""
    squared, modes = eigh(stiffness())
    force = K_N / MASS * AMPLITUDE * modes[0]
    drive = 2 * np.pi / PERIOD
    own = np.cos(np.sqrt(squared) * time)
    amplitude = (1 - own) / squared - (np.cos(drive * time) - own) / (squared - drive**2)
    return modes @ (force * amplitude)


def damped_chain(time: float, c_n: float) -> NDArray[np.float64]:
    """The same with dashpots beside the springs, by the exponential of the system with a constant and an oscillator."""
    springs, drive = stiffness(), 2 * np.pi / PERIOD
    rate = np.zeros((2 * N + 3, 2 * N + 3))  # u, v, 1, cos, sin
    rate[:N, N : 2 * N] = np.eye(N)
    rate[N : 2 * N, :N], rate[N : 2 * N, N : 2 * N] = -springs, -c_n / K_N * springs
    rate[N, 2 * N], rate[N, 2 * N + 1] = AMPLITUDE * K_N / MASS, -AMPLITUDE * K_N / MASS
    rate[N, 2 * N + 2] = AMPLITUDE * drive * c_n / MASS
    rate[2 * N + 1, 2 * N + 2], rate[2 * N + 2, 2 * N + 1] = -drive, drive
    start = np.zeros(2 * N + 3)
    start[2 * N : 2 * N + 2] = 1.0
    return (expm(rate * time) @ start)[:N]


def errors(scheme: str, c_n: float, exact: NDArray[np.float64], end: float) -> NDArray[np.float64]:
    """Largest error of a displacement at the end over A, for steps that are halved.

    The first has 100 steps per period of the fastest mode, whose phase is then off by 0.02 at the end.
    """
    found = []
    for steps in (2000, 4000, 8000):
        system = column(end / steps, Shaking(amplitude=AMPLITUDE, period=PERIOD), c_n=c_n, scheme=scheme)
        (start,) = by_number(system, "y")
        system.advance(steps)
        assert system.look().count == N, "no contact has opened"
        (height,) = by_number(system, "y")
        found.append(np.abs(height - start - exact).max() / AMPLITUDE)
    return np.array(found)


def orders(error: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.log2(error[:-1] / error[1:])


def test_elastic_column_follows_its_modes_with_order_two() -> None:
    end = 0.4 * PERIOD
    np.testing.assert_allclose(orders(errors("leapfrog", 0.0, elastic_chain(end), end)), 2.0, atol=0.1)


def test_dashpots_see_the_present_velocity_of_the_floor_in_velocity_verlet() -> None:
    """Order 2 with the floor accelerating; the leapfrog's dashpots lag by half a step: order 1."""
    end, c_n = 0.4 * PERIOD, 3.0
    exact = damped_chain(end, c_n)
    np.testing.assert_allclose(orders(errors("velocity_verlet", c_n, exact, end)), 2.0, atol=0.1)
    np.testing.assert_allclose(orders(errors("leapfrog", c_n, exact, end)), 1.0, atol=0.1)


def test_floor_that_sets_out_with_a_jump_costs_velocity_verlet_no_order() -> None:
    """A sine without a ramp: dashpots see the velocity after the jump from the first step on."""
    end, c_n, drive = 0.1 * PERIOD, 1.0, 2 * np.pi / PERIOD
    amplitude = 0.02 * AMPLITUDE  # the jump swings the contacts by less than their overlap
    motion = Shaking(amplitude=amplitude, period=PERIOD, from_rest=False)
    squared = stiffness()
    rate = np.zeros((2 * N + 2, 2 * N + 2))  # u, v, sin, cos
    rate[:N, N : 2 * N] = np.eye(N)
    rate[N : 2 * N, :N], rate[N : 2 * N, N : 2 * N] = -squared, -c_n / K_N * squared
    rate[N, 2 * N], rate[N, 2 * N + 1] = amplitude * K_N / MASS, amplitude * drive * c_n / MASS
    rate[2 * N, 2 * N + 1], rate[2 * N + 1, 2 * N] = drive, -drive
    exact = (expm(rate * end) @ np.eye(2 * N + 2)[-1])[:N]
    found = []
    for steps in (500, 1000, 2000):
        system = column(end / steps, motion, c_n=c_n, scheme="velocity_verlet")
        (start,) = by_number(system, "y")
        system.advance(steps)
        assert system.look().count == N, "no contact has opened"
        found.append(np.abs(by_number(system, "y")[0] - start - exact).max() / amplitude)
    np.testing.assert_allclose(orders(np.array(found)), 2.0, atol=0.1)


def test_work_of_the_floor_is_the_energy_of_the_chain() -> None:
    """Elastic: what the floor has done is what is stored, at every time to round-off, and that of the closed form."""
    system = column(1e-3, Shaking(amplitude=AMPLITUDE, period=PERIOD))
    start, stored = balance(system), system.energies()
    for _ in range(10):
        system.advance(417)
        # sums of some thousand terms of the size of the work
        assert abs(balance(system) - start) < 1e-11 * K_N * AMPLITUDE**2
    u = elastic_chain(system.time)
    h = 1e-5
    v = (elastic_chain(system.time + h) - elastic_chain(system.time - h)) / (2 * h)
    stretch = np.diff(np.concatenate([[system.shaking.displacement(system.time)], u]))
    overlap = MASS * GRAVITY / K_N * np.arange(N, 0, -1)
    lifted = 0.5 * K_N * np.sum((overlap - stretch) ** 2 - overlap**2) + MASS * GRAVITY * u.sum()
    work = system.energies()["work_walls"] - stored["work_walls"]
    # the leapfrog's own error of order 2 at 30 steps per shortest period
    np.testing.assert_allclose(work, 0.5 * MASS * v @ v + lifted, rtol=5e-3)


@pytest.mark.parametrize("c_n", [0.0, 4.0])
def test_disc_leaves_the_floor_at_its_threshold(c_n: float) -> None:
    """The contact force is ``m g + m A W^2 |T| cos``: it reaches zero at ``Gamma = 1/|T|``, 1 for a rigid contact.

    ``|T|^2 = (1 + (2 z r)^2)/((1 - r^2)^2 + (2 z r)^2)`` with r = W/w, the transmissibility of spring and dashpot.
    """
    own, period = np.sqrt(K_N / MASS), 0.8
    r, z = 2 * np.pi / period / own, c_n / (2 * np.sqrt(K_N * MASS))
    threshold = np.sqrt(((1 - r**2) ** 2 + (2 * z * r) ** 2) / (1 + (2 * z * r) ** 2))
    opened = {}
    for share in (0.99, 1.01):
        amplitude = share * threshold * GRAVITY * (period / (2 * np.pi)) ** 2
        # a slow ramp leaves nothing of the disc's own swing; at most the share of 1 % is sought
        motion = Shaking(amplitude=amplitude, period=period, from_rest=False, ramp=40 * period)
        grains = Grains.discs([[0.0, RADIUS - MASS * GRAVITY / K_N]], RADIUS, DENSITY)
        system = normal_only(
            grains, k_n=K_N, c_n=c_n, time_step=period / 4000, walls=[SHAKEN], shaking=motion, gravity=(0.0, -GRAVITY),
            scheme="velocity_verlet",
        )  # fmt: skip
        system.advance(int(40 * 4000))
        least = np.inf
        for _ in range(4000):
            system.advance(5)
            least = min(least, -float(system.wall_force[0, 1]))
        opened[share] = least <= 0.0
    assert opened == {0.99: False, 1.01: True}


def test_place_and_velocity_follow_from_the_step_alone() -> None:
    """After ten million steps the floor is where its phase says, whatever way the steps were taken in."""
    motion = Shaking(amplitude=0.3, period=25_000 * 1e-3)
    for done in (0, 9_999_999, 25_000 * 400):
        grains = Grains.discs([[0.0, 5.0]], RADIUS, DENSITY)
        system = normal_only(grains, k_n=K_N, time_step=1e-3, walls=[SHAKEN, FLOOR], shaking=motion)
        system.start()
        system.steps_done = done
        system.advance(6_000)
        system.advance(250)
        floor = system.list.walls
        # a quarter of a period; t/period is known to one part in 1e16 of 400 turns
        np.testing.assert_allclose(
            floor.py[0], 0.3 * (1 - np.cos(2 * np.pi * (done % 25_000 + 6250) / 25_000)), atol=1e-12
        )
        half = 2 * np.pi * (done % 25_000 + 6249.5) / 25_000
        np.testing.assert_allclose(floor.vy[0], 0.3 * 2 * np.pi / motion.period * np.sin(half), rtol=1e-8, atol=1e-10)
        assert floor.py[1] == 0.0, "a wall that is not shaken stays"


def test_motion_begins_and_ends_without_a_jump() -> None:
    """Displacement and velocity are continuous over start, ramps and stop, and zero outside."""
    for motion in (
        Shaking(amplitude=1.0, period=1.0, start=0.7, stop=3.2),
        Shaking(amplitude=1.0, period=1.0, start=0.7, stop=3.2, from_rest=False, ramp=1.0),
        Shaking(amplitude=1.0, period=1.0, start=0.7, stop=3.2, ramp=1.5),
    ):
        dt = 1e-4
        place = np.array([motion.displacement(k * dt) for k in range(60_000)])
        speed, largest = np.diff(place) / dt, 2 * np.pi * (2 * np.pi + 6.0)  # of the acceleration, ramps included
        assert np.abs(np.diff(speed)).max() < largest * dt
        assert np.all(place[:7_000] == 0.0)
        end = 3.7 if motion.ramp == 0.0 else 3.2 + motion.ramp
        assert np.all(np.abs(place[int(end / dt) + 1 :]) == 0.0)
        assert np.abs(place[30_000:31_000]).max() > 0.05, "it moves in between"


def test_wall_that_slides_along_itself_asks_for_no_new_list() -> None:
    side = Wall(point=(-1.0, 0.0), normal=(1.0, 0.0), name="left", shaken=True)
    grains = Grains.discs([[0.0, 5.0]], RADIUS, DENSITY)
    system = normal_only(grains, k_n=K_N, time_step=1e-3, walls=[side], shaking=Shaking(amplitude=3.0, period=2.0))
    system.advance(5_000)
    assert system.rebuilds == 1


REFUSED = {
    "no motion": ({"walls": [SHAKEN]}, "floor is shaken, but nothing says how"),
    "no wall": ({"walls": [FLOOR], "shaking": Shaking(amplitude=1.0, period=1.0)}, "shaking moves no wall"),
    "own velocity": (
        {
            "walls": [Wall(point=(0, 0), normal=(0, 1), velocity=(0, 1), shaken=True)],
            "shaking": Shaking(amplitude=1.0, period=1.0),
        },
        "has a velocity of its own",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refusal(name: str) -> None:
    options, words = REFUSED[name]
    with pytest.raises(ParticleError, match=words):
        normal_only(Grains.discs([[0.0, 5.0]], RADIUS, DENSITY), k_n=K_N, time_step=1e-3, **options)


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({"amplitude": 0.0}, "shaking amplitude = 0 must be greater than 0"),
        ({"period": -1.0}, "shaking period = -1 must be greater than 0"),
        ({"direction": (0.0, 0.0)}, "shaking direction must not be zero"),
        ({"start": 2.0, "stop": 1.0}, "shaking stop = 1 must be greater than 2"),
    ],
)
def test_numbers_out_of_range_are_refused(numbers: dict, words: str) -> None:
    with pytest.raises(ParticleError, match=words):
        Shaking(**({"amplitude": 1.0, "period": 1.0} | numbers))
