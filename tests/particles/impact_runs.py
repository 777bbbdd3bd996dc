"""Benchmark impacts through the code under test, and how far they are from the reference."""

import math
from collections.abc import Sequence

import numpy as np
from impact_benchmarks import Benchmark, Kind
from impacts import Impact, Springs
from numpy.typing import NDArray
from scipy.special import beta, betainc

from particles import ContactModel, Grains, ParticleSystem, Wall

Floats = NDArray[np.float64]
FLOOR = Wall(point=(0.0, 0.0), normal=(0.0, 1.0))


def grains_before(impacts: Sequence[Impact], dt: float) -> Grains:
    """The bodies of `impacts` side by side, each to touch within the second step, all at different parts of it.

    Before a plane, the floor, they stand in a row; pairs lie along x, above one another, and their
    centre of mass rests.
    """
    gap = dt * (1.0 + np.arange(1, len(impacts) + 1) * 0.6180339887 % 1.0) * np.array([-i.v_n for i in impacts])
    first, second = impacts[0].first, impacts[0].second
    u = np.array([(i.v_n, i.u_t) for i in impacts])
    spins = np.array([i.spins for i in impacts])
    apart = 4.0 * np.arange(len(impacts))
    areal = [b.mass / (math.pi * b.radius**2) for b in (first, second) if b is not None]
    if second is None:  # n down, t to the right: the plane's velocity against the disc is (u_t, -v_n)
        place = np.column_stack([apart * first.radius, first.radius + gap])
        return Grains.discs(
            place, first.radius, areal[0], velocity=np.column_stack([-u[:, 1], u[:, 0]]), spin=spins[:, 0]
        )
    share, row = first.mass / (first.mass + second.mass), apart * max(first.radius, second.radius)
    place = np.vstack([np.column_stack([-first.radius - gap, row]), np.column_stack([0.0 * gap + second.radius, row])])
    return Grains.discs(
        place, np.repeat([first.radius, second.radius], len(impacts)), np.repeat(areal, len(impacts)),
        velocity=np.vstack([-(1.0 - share) * u, share * u]), spin=spins.T.ravel(),
    )  # fmt: skip


def run(impacts: Sequence[Impact], contact: ContactModel, dt: float, duration: float) -> Floats:
    """What the code makes of `impacts` within `duration` [s] of touching: rows like `Rebound.numbers`."""
    n, walls = len(impacts), [FLOOR] if impacts[0].second is None else []
    system = ParticleSystem(grains_before(impacts, dt), contact, time_step=dt, walls=walls, ledger=False)
    system.advance(math.ceil(duration / dt) + 3)
    order = np.argsort(system.grains.number)
    vx, vy, spin = (getattr(system.grains, name)[order] for name in ("vx", "vy", "omega"))
    if walls:
        return np.column_stack([vy, -vx, spin, np.zeros(n)])
    left, right = impacts[0].first.mass, impacts[0].second.mass
    for v in (vx, vy):  # the momentum of every pair was zero: round-off of the kicks
        assert np.abs(left * v[:n] + right * v[n:]).max() <= 1e-13 * left * max(
            abs(i.v_n) + abs(i.u_t) for i in impacts
        )
    return np.column_stack([vx[n:] - vx[:n], vy[n:] - vy[:n], spin[:n], spin[n:]])


def compare(benchmark: Benchmark, kind: Kind, impacts: Sequence[Impact], steps: int) -> tuple[Floats, Floats, Floats]:
    """Reference and code (n, 4) with `steps` per undamped contact, and the largest deviation of each impact.

    Deviations are those of velocities and of surface speeds r omega, over the speed of the surfaces
    against each other before the impact.
    """
    found = [impact.solve() for impact in impacts]
    reference = np.array([rebound.numbers() for rebound in found])
    dt = impacts[0].springs.duration(impacts[0].mass, benchmark.speed) / steps
    ours = run(impacts, benchmark.contact(kind), dt, 1.05 * max(rebound.duration for rebound in found))
    return reference, ours, deviation(impacts, reference, ours)


def deviation(impacts: Sequence[Impact], reference: Floats, ours: Floats) -> Floats:
    radii = (impacts[0].first.radius, impacts[0].second.radius if impacts[0].second else 0.0)
    speed = np.array([math.hypot(i.v_n, i.look_at_start().v_t) for i in impacts])
    return (np.abs(ours - reference) * [1.0, 1.0, *radii]).max(axis=1) / speed


def errors(benchmark: Benchmark, kind: Kind, impacts: Sequence[Impact], steps: Sequence[int]) -> Floats:
    """Root mean square deviation from the reference at each number of steps per contact.

    The force has kinks, so the error depends on where in a step they fall: 16 copies of every impact
    touch at different moments, and the contact time over dt keeps its fractional part 1/3.
    """
    found = [impact.solve() for impact in impacts]
    copies = [impact for impact in impacts for _ in range(16)]
    reference = np.repeat([rebound.numbers() for rebound in found], 16, axis=0)
    duration = impacts[0].springs.duration(impacts[0].mass, benchmark.speed)
    late = 1.05 * max(rebound.duration for rebound in found)
    contact, result = benchmark.contact(kind), []
    for n in steps:
        ours = run(copies, contact, duration / (n + 1.0 / 3.0), late)
        result.append(math.sqrt(np.mean(deviation(copies, reference, ours) ** 2)))
    return np.array(result)


def orders(errors: Floats) -> Floats:
    """Orders in dt where each error was taken at half the step of the one before."""
    return -np.diff(np.log2(errors))


def force_curve(benchmark: Benchmark, kind: Kind, steps: int) -> tuple[Floats, Floats, Floats]:
    """Time since touching [s], overlap [m] and force [N] at every step from before the contact to after it."""
    impact = benchmark.impacts(kind)[0]
    dt = impact.springs.duration(impact.mass, benchmark.speed) / (steps + 1.0 / 3.0)
    grains = grains_before([impact], dt)
    walls = [] if impact.second else [FLOOR]
    system = ParticleSystem(grains, benchmark.contact(kind), time_step=dt, walls=walls, ledger=False)
    rows = []
    for _ in range(steps + 4):
        system.advance(1)
        if impact.second:
            overlap = 2.0 * benchmark.radius - abs(grains.x[1] - grains.x[0])
            rows.append((system.time, overlap, abs(grains.fx[0])))
        else:
            rows.append((system.time, benchmark.radius - grains.y[0], grains.fy[0]))
    time, overlap, force = np.array(rows).T
    return time + overlap[0] / benchmark.speed - time[0], overlap, force  # free flight until the first overlap


def fall_time(springs: Springs, mass: float, speed: float, overlap: Floats) -> Floats:
    """Time [s] from touching to an overlap, from the energy: ``v dt = d delta / sqrt(1 - (delta/deepest)^(p+1))``."""
    q, deep = springs.power + 1.0, springs.deepest(mass, speed)
    return deep / speed * beta(1.0 / q, 0.5) * betainc(1.0 / q, 0.5, (overlap / deep) ** q) / q
