"""Periodic sides: nothing may depend on where the seams lie."""

import numpy as np
import pytest
from discs import full_law, normal_only

from particles import Grains, ParticleError, ParticleSystem

LAW = {"k_n": 2e5, "k_t": 1e4, "c_n": 6.0, "c_t": 1.0, "mu": 0.5, "mu_r": 0.1, "eta_r": 0.3}
RADIUS, DENSITY, STIFFNESS = 1e-3, 1000.0, 1e5


def hexagonal(columns: int, rows: int, overlap: float) -> tuple[np.ndarray, tuple[float, float]]:
    """Centres and periods of a hexagonal crystal (rows even)."""
    pitch = 2 * RADIUS - overlap
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    x = pitch * (column + 0.5 * (row % 2))
    y = pitch * np.sqrt(0.75) * row
    return np.column_stack([x.ravel(), y.ravel()]), (pitch * columns, pitch * np.sqrt(0.75) * rows)


@pytest.mark.parametrize(("columns", "rows"), [(3, 4), (7, 10), (40, 30)])
def test_crystal_has_its_closed_form_energy(columns: int, rows: int) -> None:
    """Six neighbours each, three contacts per grain, k delta^2 / 2 in each, no force on any."""
    overlap = 0.02 * RADIUS
    place, period = hexagonal(columns, rows, overlap)
    system = normal_only(
        Grains.discs(place, RADIUS, DENSITY), k_n=STIFFNESS, time_step=1e-6, period=period, ledger=False
    )
    look = system.look()
    assert look.count == 3 * columns * rows
    assert np.all(look.contacts == 6)
    # the overlap is a difference of lengths 100 times larger
    np.testing.assert_allclose(look.normal_energy, 3 * columns * rows * 0.5 * STIFFNESS * overlap**2, rtol=1e-11)
    # six forces k delta that cancel, each known to some eps r / delta
    assert np.abs([system.grains.fx, system.grains.fy]).max() < 1e-11 * STIFFNESS * overlap


def gas(shift: tuple[float, float], drift: float = 0.0) -> tuple[Grains, tuple[float, float]]:
    """Overlapping discs of sizes 1 to 3 that move and spin, everything shifted and drifting."""
    rng = np.random.default_rng(3)
    pitch, columns, rows = 3.6e-3, 8, 6
    column, row = np.meshgrid(np.arange(columns), np.arange(rows))
    place = pitch * np.column_stack([column.ravel(), row.ravel()]) + rng.uniform(-0.3e-3, 0.3e-3, (columns * rows, 2))
    radius = rng.uniform(1e-3, 3e-3, columns * rows)
    velocity = rng.normal(0.0, 0.1, place.shape) + [drift, 0.5 * drift]
    spin = rng.normal(0.0, 30.0, len(place))
    return Grains.discs(place + shift, radius, DENSITY, velocity=velocity, spin=spin), (pitch * columns, pitch * rows)


def moved(shift: tuple[float, float], steps: int, drift: float = 0.0) -> tuple[ParticleSystem, np.ndarray]:
    """Displacements and turns after `steps`, in the order of the beginning."""
    grains, period = gas(shift, drift)
    start = grains.position
    system = full_law(grains, **LAW, time_step=2e-6, period=period)
    system.advance(steps)
    order = np.argsort(system.grains.number)
    where = np.column_stack([system.grains.position[order] - start, RADIUS * system.grains.theta[order]])
    return system, where


def test_shifted_scene_moves_alike() -> None:
    """Friction, rolling and their springs across the seams: the same motion wherever the seams are."""
    here, motion = moved((0.0, 0.0), 500)
    assert here.rebuilds > 2, "the contacts were carried over to new lists"
    size = np.abs(motion).max()
    for shift in [(1.1e-3, 0.0), (0.0, 7.7e-3), (13.7e-3, -5.2e-3), (-1.0, 2.0)]:
        _, shifted = moved(shift, 500)
        # round-off of positions some periods away, grown by the collisions of 500 steps
        np.testing.assert_allclose(shifted, motion, atol=1e-8 * size)


def test_drift_of_everything_changes_nothing() -> None:
    """Every grain goes around the box twice: with a drag on none, the relative motion is that at rest."""
    _, still = moved((0.0, 0.0), 500)
    drift = 2 * 8 * 3.6e-3 / (500 * 2e-6)
    _, going = moved((0.0, 0.0), 500, drift)
    path = drift * 500 * 2e-6 * np.array([1.0, 0.5, 0.0])
    # round-off of velocities 500 times as large as their differences
    np.testing.assert_allclose(going - path, still, atol=1e-6 * np.abs(still).max())


def test_momentum_is_kept_to_round_off() -> None:
    grains, period = gas((0.0, 0.0))
    system = full_law(grains, **LAW, time_step=2e-6, period=period)
    before, scale = system.momentum(), np.abs(grains.mass * grains.vx).sum()
    system.advance(1000)
    assert np.abs(system.momentum() - before).max() < 1e-13 * scale


@pytest.mark.parametrize("ratio", [1.0, 2.0, 10.0, 50.0])
@pytest.mark.parametrize("axes", [(True, True), (True, False), (False, True)])
def test_every_contact_is_found_once(ratio: float, axes: tuple[bool, bool]) -> None:
    """Against all pairs with all images, for one large disc among small ones at a corner of the box."""
    rng = np.random.default_rng(5)
    width, height = 6.0 * ratio * RADIUS + 10 * RADIUS, 5.2 * ratio * RADIUS + 8 * RADIUS
    n = 150
    place = rng.uniform(0, 1, (n, 2)) * [width, height]
    place[0] = [0.1 * RADIUS, height - 0.2 * RADIUS]
    radius = rng.uniform(1.0, 1.5, n) * RADIUS
    radius[0] = ratio * RADIUS
    period = (width if axes[0] else None, height if axes[1] else None)
    system = normal_only(
        Grains.discs(place, radius, DENSITY), k_n=STIFFNESS, time_step=1e-9, period=period, ledger=False
    )
    look = system.look()
    order = np.argsort(system.grains.number)
    gap = place[None] - place[:, None]
    for axis, length in enumerate(period):
        if length is not None:
            gap[..., axis] -= length * np.round(gap[..., axis] / length)
    touching = np.hypot(*np.moveaxis(gap, -1, 0)) < radius[:, None] + radius
    np.fill_diagonal(touching, False)
    np.testing.assert_array_equal(look.contacts[order], touching.sum(axis=1))
    assert touching[0].any()


def test_short_period_is_refused() -> None:
    with pytest.raises(ParticleError, match="period in x = 0.004 m must be at least 5 of the largest radii"):
        normal_only(Grains.discs([[0.0, 0.0]], RADIUS, DENSITY), k_n=1.0, time_step=1.0, period=(4e-3, None))
