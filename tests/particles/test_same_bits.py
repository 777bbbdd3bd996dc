"""The same bits: with any number of threads, in any cut of the steps, and after a restore."""

from collections.abc import Mapping

import numba
import numpy as np
import pytest
from discs import full_law, packing

from particles import ParticleError, ParticleSystem, box

LAW = {"k_n": 2e5, "k_t": 1e4, "c_n": 6.0, "c_t": 1.0, "mu": 0.5, "mu_r": 0.1, "eta_r": 0.3}
N = 2500  # enough for several blocks
STEPS = 200


def crowd(threads: int = 1, n: int = N) -> ParticleSystem:
    grains, width, height = packing(n, seed=21, ratio=3.0, squeeze=0.95, speed=1.0)
    grains = grains.with_prescribed([[0.5 * width, 0.5 * height], [0.2 * width, 0.2 * height]], 2e-3, 0)
    grains.vx[n:] = 0.5
    return full_law(
        grains, **LAW, alpha_t=1.0, alpha_r=1.0, walls=box(width, height), gravity=(0.0, -9.81), time_step=3e-6,
        threads=threads,
    )  # fmt: skip


def same(one: Mapping[str, np.ndarray], other: Mapping[str, np.ndarray]) -> bool:
    return one.keys() == other.keys() and all(np.array_equal(one[name], other[name]) for name in one)


@pytest.fixture(scope="module")
def reference() -> dict[str, np.ndarray]:
    system = crowd()
    assert len(system.blocks) > 3
    system.advance(STEPS)
    assert system.rebuilds > 2
    return system.state()


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="this machine lends one thread")
def test_two_threads_give_the_bits_of_one(reference: dict[str, np.ndarray]) -> None:
    system = crowd(threads=2)
    assert system.threads == 2
    system.advance(STEPS)
    assert same(system.state(), reference)


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="this machine lends one thread")
def test_a_system_keeps_its_threads_when_another_is_made() -> None:
    system = crowd(threads=2)
    crowd(threads=1)
    system.advance(1)
    assert numba.get_num_threads() == 2


def test_steps_one_by_one_give_the_bits_of_many(reference: dict[str, np.ndarray]) -> None:
    system = crowd()
    for _ in range(STEPS):
        system.advance(1)
    now = system.state()
    assert same(now, reference)


def test_looking_changes_nothing(reference: dict[str, np.ndarray]) -> None:
    system = crowd()
    for _ in range(10):
        system.advance(STEPS // 10)
        system.energies(system.look())
    assert same(system.state(), reference)


def test_restored_state_goes_on_with_the_same_bits(reference: dict[str, np.ndarray]) -> None:
    first = crowd()
    first.advance(83)
    saved = first.state()
    first.advance(50)  # the saved state must not follow
    second = crowd()
    second.advance(10)
    second.restore(saved)
    second.advance(STEPS - 83)
    assert same(second.state(), reference)


def test_state_of_another_system_is_refused() -> None:
    with pytest.raises(ParticleError, match="saved state has 402 grains, this system has 2502"):
        crowd().restore(crowd(n=400).state())
