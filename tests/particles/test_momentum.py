"""Forces between discs come in pairs: linear and angular momentum are kept to round-off."""

import numpy as np
import pytest
from discs import full_law, packing

from particles import ParticleSystem, box

LAW = {"k_n": 2e5, "k_t": 1e4, "c_n": 6.0, "c_t": 1.0, "mu": 0.5, "mu_r": 0.1, "eta_r": 0.3}
EPS = np.finfo(float).eps
POINT = np.array([1.0, -2.0])  # about 10 diameters of the cluster away


def cluster(n: int) -> ParticleSystem:
    """Overlapping discs in free flight: they burst, slip and spin."""
    grains, _, _ = packing(n, seed=7, ratio=3.0, squeeze=0.85, speed=0.5)
    grains.vx += 1.0
    return full_law(grains, **LAW, time_step=2e-6)


def momenta(system: ParticleSystem) -> tuple[np.ndarray, np.ndarray]:
    """Momentum and angular momentum about POINT, and the sums of the magnitudes of their terms."""
    g = system.grains
    linear = np.array([g.mass * g.vx, g.mass * g.vy])
    angular = linear[1] * (g.x - POINT[0]) - linear[0] * (g.y - POINT[1])
    terms = [*linear, np.concatenate([angular, g.inertia * g.omega])]
    return np.array([term.sum() for term in terms]), np.array([np.abs(term).sum() for term in terms])


@pytest.mark.parametrize("n", [400, 2500])  # one block, several
def test_free_cluster_keeps_its_momenta(n: int) -> None:
    system = cluster(n)
    system.start()
    before, _ = momenta(system)
    contacts = system.look().count
    steps = 300
    system.advance(steps)
    after, scale = momenta(system)
    assert contacts > n
    assert np.ptp(system.grains.omega) > 0.0
    # Every step rounds every velocity once or twice; errors add up like a random walk at best, and
    # at worst as steps * eps.
    assert (np.abs(after - before) < steps * EPS * scale).all()


def test_forces_on_grains_and_walls_sum_to_zero() -> None:
    grains, width, height = packing(2500, seed=11)
    grains = grains.with_prescribed([[0.5 * width, 0.5 * height]], 2e-3, 0)
    system = full_law(grains, **LAW, walls=box(width, height), time_step=2e-6)
    system.advance(50)
    g = system.grains
    for axis, force in enumerate((g.fx, g.fy)):
        # One rounding per contact and block.
        assert abs(force.sum() + system.wall_force[:, axis].sum()) < 10.0 * EPS * np.abs(force).sum()
    assert np.abs(system.wall_force).max() > 0.0
    assert np.hypot(*system.force_on(slice(g.n_free, len(g)))[0]) > 0.0


def test_impulse_on_a_prescribed_disc_is_what_the_others_lost() -> None:
    grains, width, height = packing(400, seed=12)
    grains = grains.with_prescribed([[0.5 * width, 0.5 * height]], 2e-3, 0)
    system = full_law(grains, **LAW, time_step=2e-6)
    system.start()
    before = system.momentum()
    steps = 200
    system.advance(steps)
    gained = system.impulse_on(slice(400, 401))[0]
    scale = np.abs(system.grains.mass * system.grains.vx).sum()
    assert np.hypot(*gained) > 1e-3 * scale
    assert np.abs(before - system.momentum() - gained).max() < steps * EPS * scale
