"""Profiles and granular temperature of samples whose answer is known."""

import math

import numpy as np
import pytest

from particles import ParticleError
from particles.measures import Cells, MovingGrains, coordination_in_strips, granular_temperature, mean_in_strips

CELLS = Cells(left=-1.0, bottom=2.0, width=40.0, height=30.0, columns=40, rows=30)


def sample(seed: int, n: int, energy: float, turning: float) -> MovingGrains:
    """Places at random over `CELLS`, masses 1:4, velocities of Maxwell."""
    rng = np.random.default_rng(seed)
    mass = rng.uniform(1.0, 4.0, n)
    inertia = 0.5 * mass * rng.uniform(0.2, 0.4, n) ** 2
    place = [-1.0 + 40.0 * rng.random(n), 2.0 + 30.0 * rng.random(n)]
    velocity = [math.sqrt(energy) * rng.standard_normal(n) / np.sqrt(mass) for _ in range(2)]
    return MovingGrains(
        *place, *velocity, math.sqrt(turning) * rng.standard_normal(n) / np.sqrt(inertia), mass, inertia
    )


@pytest.mark.parametrize(("mean", "unknowns"), [("constant", 1), ("linear", 3)])
def test_a_sample_of_maxwell_is_not_underestimated_however_few_grains_a_cell_has(mean, unknowns):
    found = granular_temperature(sample(1, 8 * CELLS.count, 0.7, 0.2), CELLS, mean=mean)
    count = found.count
    for known, least, freedoms, energy in (
        (found.translational, unknowns, 2 * (count - unknowns), 0.7),
        (found.rotational, 1, count - 1, 0.2),
    ):
        own = count > least
        assert np.isnan(known[~own]).all()
        # chi squared of f freedoms has the relative variance 2/f: the standard error of the mean over the cells
        error = energy * math.sqrt((2.0 / freedoms[own]).sum()) / own.sum()
        assert known[own].mean() == pytest.approx(energy, abs=4.0 * error)


def test_a_linear_flow_has_no_temperature_and_adds_none():
    grains = sample(2, 9000, 0.7, 0.2)
    flow_x = 3.0 - 1.7 * grains.y + 0.4 * grains.x
    flow_y = -2.0 + 0.9 * grains.x
    flowing = grains._replace(vx=grains.vx + flow_x, vy=grains.vy + flow_y, omega=grains.omega + 5.0)
    still, moving = (granular_temperature(g, CELLS) for g in (grains, flowing))
    np.testing.assert_allclose(moving.translational, still.translational, rtol=1e-8, atol=1e-10)  # speeds of 50 cancel
    np.testing.assert_allclose(moving.rotational, still.rotational, rtol=1e-8, atol=1e-10)
    smooth = granular_temperature(grains._replace(vx=flow_x, vy=flow_y), CELLS)
    assert np.nanmax(smooth.translational) < 1e-24 * 50.0**2 / np.finfo(float).eps


def test_shear_within_a_cell_counts_against_a_constant_mean():
    side = np.arange(20) + 0.5
    x, y = (axis.ravel() / 20.0 for axis in np.meshgrid(side, side))
    one = np.ones(400)
    shear = MovingGrains(x, y, 2.0 * y, 0.0 * one, 0.0 * one, one, one)
    cell = Cells(width=1.0, height=1.0, columns=1, rows=1)
    # variance of 20 equal steps of 1/20, (1 - 1/400)/12, times the squared rate 4, over two directions
    expected = 4.0 * (1.0 - 1.0 / 400.0) / 12.0 / 2.0 * 400.0 / 399.0
    assert granular_temperature(shear, cell, mean="constant").translational[0, 0] == pytest.approx(expected, rel=1e-12)
    assert granular_temperature(shear, cell).translational[0, 0] == pytest.approx(0.0, abs=1e-25)


def test_the_flow_across_a_seam_is_one_flow():
    rng = np.random.default_rng(4)
    x, y = rng.uniform(9.0, 11.0, 50), rng.random(50)
    one = np.ones(50)
    grains = MovingGrains(x, y, 0.3 * (x - 10.0), 0.0 * one, 0.0 * one, one, one)
    cells = Cells(left=9.0, width=10.0, height=1.0, columns=5, rows=1, period=(10.0, None))
    for shift in (0.0, 10.0, -30.0):
        found = granular_temperature(grains._replace(x=x + shift), cells)
        assert found.count.tolist() == [[50, 0, 0, 0, 0]]
        assert found.translational[0, 0] < 1e-25


def test_coordination_of_a_crystal_by_rows():
    row, column = np.divmod(np.arange(8 * 6), 6)
    place = np.column_stack([0.99 * (column + 0.5 * (row % 2)), 0.99 * 0.5 * math.sqrt(3.0) * row])
    apart = place[:, None] - place
    apart[..., 0] -= 0.99 * 6 * np.round(apart[..., 0] / (0.99 * 6))  # periodic in x
    contacts = (np.hypot(apart[..., 0], apart[..., 1]) < 1.0).sum(axis=1) - 1
    edges = 0.99 * 0.5 * math.sqrt(3.0) * (np.arange(9) - 0.5)
    found = coordination_in_strips(contacts, place[:, 1], edges)
    assert found.mean.tolist() == [4.0] + [6.0] * 6 + [4.0]
    assert found.count.tolist() == [6] * 8


def test_rattlers_are_left_out_of_the_mean_alone():
    contacts, y = np.array([4, 4, 1, 0, 2]), np.array([0.5, 0.5, 0.5, 0.5, 1.5])
    assert coordination_in_strips(contacts, y, [0.0, 1.0, 2.0]).mean.tolist() == [2.25, 2.0]
    kept = coordination_in_strips(contacts, y, [0.0, 1.0, 2.0], without_rattlers=True)
    assert kept.mean[0] == 4.0 and np.isnan(kept.mean[1]) and kept.count.tolist() == [2, 0]


def test_a_strip_holds_its_lower_edge_and_nothing_beyond_the_last():
    found = mean_in_strips([1.0, 2.0, 4.0, 8.0], np.array([0.0, 1.0, 2.0, -0.1]), [0.0, 1.0, 2.0])
    assert found.mean.tolist() == [1.0, 2.0] and found.count.tolist() == [1, 1]


def test_temperature_refuses_an_unknown_mean():
    with pytest.raises(ParticleError, match='"constant" or "linear"'):
        granular_temperature(sample(1, 10, 1.0, 1.0), CELLS, mean="cubic")
