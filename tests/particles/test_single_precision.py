"""State stored in single precision: what it keeps, what it costs, and that nothing that a step adds to is lost."""

import numpy as np
import pytest
from discs import by_number, full_law, packing

from particles import Grains, ParticleError, ParticleSystem, box, continued

LAW = {"k_n": 2e5, "k_t": 1e4, "c_n": 6.0, "c_t": 1.0, "mu": 0.5, "mu_r": 0.1, "eta_r": 0.3}
ROUNDING = 2.0**-24  # of one number in single precision, relative
KEPT_WHOLE = ("x", "y", "theta", "vx", "vy", "omega", "radius", "x_listed", "y_listed")


def crowd(precision: str, *, n: int = 300, **options: object) -> ParticleSystem:
    grains, width, height = packing(n, seed=21, ratio=1.5, squeeze=0.95, speed=1.0)
    return full_law(
        grains, **LAW, alpha_t=1.0, alpha_r=1.0, walls=box(width, height), gravity=(0.0, -9.81), time_step=3e-6,
        precision=precision, **options,
    )  # fmt: skip


@pytest.mark.parametrize("step", [4e-5, 1e-7])
def test_a_fall_loses_nothing_of_its_small_increments(step: float) -> None:
    """After n steps from rest v = -g (n + 1/2) dt. With velocities in single precision it is 0.2 % off at 1e-6 s."""
    grains = Grains.discs([[0.0, 1.0]], 2e-3, 1600.0)
    system = full_law(grains, **LAW, time_step=step, gravity=(0.0, -9.81), precision="float32")
    system.advance(10_000)
    assert grains.vy[0] == pytest.approx(-9.81 * 10_000.5 * step, rel=1e-10)  # sums of 1e4 numbers of double precision


def test_a_small_overlap_far_from_the_origin_keeps_its_force() -> None:
    """Two discs 50 m off overlap by 1e-6 of a radius, less than single precision tells places apart there."""
    overlap = 2e-9
    grains = Grains.discs([[50.0, 0.0], [50.0 + 4e-3 - overlap, 0.0]], 2e-3, 1600.0)
    system = full_law(grains, **LAW, time_step=1e-9, precision="float32")
    system.start()
    # 7e-15 m is the rounding of places in double precision there, 3.6e-6 of the overlap.
    assert grains.fx[1] == pytest.approx(LAW["k_n"] * overlap, rel=1e-5)


def test_a_crowd_goes_the_same_way_for_a_while() -> None:
    whole, single = crowd("float64"), crowd("float32")
    for system in (whole, single):
        system.advance(100)
    moved = np.abs(by_number(whole, "x")[0] - by_number(crowd("float64"), "x")[0]).max()
    apart = np.abs(by_number(whole, "x")[0] - by_number(single, "x")[0]).max()
    # Forces are off by a few roundings of single precision, those of the largest contact force.
    assert 0.0 < apart < 3.0 * ROUNDING * moved


def test_balance_of_energy_and_force_is_kept_to_single_precision() -> None:
    system = crowd("float32")
    before = _total(system)
    turned = 0.0
    for _ in range(10):
        system.advance(30)
        turned = max(turned, system.energies()["normal_springs"])
    whole = crowd("float64")
    start = _total(whole)
    whole.advance(300)
    # The error of the integrator is there with both; what single precision adds is far below the energy turned over.
    assert abs((_total(system) - before) - (_total(whole) - start)) < 10.0 * ROUNDING * turned
    assert 0.0 < system.force_residual() < ROUNDING


def _total(system: ParticleSystem) -> float:
    return sum(-e if name.startswith("work") else e for name, e in system.energies().items())


def test_what_is_single_and_what_is_not() -> None:
    system = crowd("float32")
    system.advance(10)
    arrays = system.grains.arrays()
    assert {arrays[name].dtype for name in KEPT_WHOLE} == {np.dtype(np.float64)}
    assert {arrays[name].dtype for name in ("fx", "torque", "mass", "inverse_inertia")} == {np.dtype(np.float32)}
    assert {system.list.pairs.spring.dtype, system.list.walls.dash_n.dtype} == {np.dtype(np.float32)}
    whole = crowd("float64")
    whole.advance(10)
    assert system.list.pairs.spring.nbytes * 2 == whole.list.pairs.spring.nbytes


def test_a_restored_state_goes_on_with_the_same_bits() -> None:
    first = crowd("float32")
    first.advance(83)
    saved = first.state()
    first.advance(50)
    second = crowd("float32")
    second.restore(saved)
    second.advance(50)
    one, other = first.state(), second.state()
    assert all(np.array_equal(one[name], other[name]) for name in one)


@pytest.mark.parametrize(("precision", "dtype"), [("float64", np.float64), ("float32", np.float32)])
def test_a_system_takes_over_a_state_of_the_other_precision(precision: str, dtype: type) -> None:
    other = crowd("float32" if precision == "float64" else "float64")
    other.advance(40)
    saved = other.state()
    options = {"time_step": 3e-6, "walls": other.walls, "damping": other.damping, "gravity": (0.0, -9.81)}
    system = continued(saved, Grains.from_saved(saved), other.contact, **options, precision=precision)
    system.advance(1)
    assert system.grains.fx.dtype == system.list.pairs.spring.dtype == dtype
    assert np.count_nonzero(system.list.pairs.spring) > 0


def test_an_unknown_precision_is_refused() -> None:
    with pytest.raises(ParticleError, match="precision 'float16' must be one of float64, float32"):
        crowd("float16")
