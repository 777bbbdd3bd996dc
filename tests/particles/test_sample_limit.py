"""The limit of the time step on a settled sample of grains."""

import math

import pytest

from particles import ContactModel, LinearSpringDashpot, packing_limit, sample_limit
from particles.state import Grains

SPRING = ContactModel(normal=LinearSpringDashpot(stiffness=1e6, damping=0.0))
DENSITY = 1600.0


def test_equal_discs_lie_between_a_crystal_and_a_chain() -> None:
    """Without dashpots ``omega^2 = 6 k/m`` in the hexagonal crystal, 4 k/m in a chain."""
    limit = sample_limit([(2e-3, 1)], DENSITY, SPRING).step
    mass = math.pi * 2e-3**2 * DENSITY
    crystal, chain = (2.0 / math.sqrt(factor * 1e6 / mass) for factor in (6.0, 4.0))
    assert 0.99 * crystal < limit < chain


@pytest.mark.parametrize("sizes", [[(2e-3, 1)], [(2.2e-3, 50), (1.8e-3, 50)], [(3e-3, 10), (1e-3, 300)]])
def test_it_is_not_below_what_holds_in_every_packing(sizes: list[tuple[float, int]]) -> None:
    kinds = Grains.discs([[0.0, 0.0]] * len(sizes), [radius for radius, _ in sizes], DENSITY)
    assert sample_limit(sizes, DENSITY, SPRING).step >= packing_limit(kinds, SPRING)


def test_it_grows_with_the_size_and_falls_with_the_spring() -> None:
    """``sqrt(m/k)``: with the radius, and with the root of the spring."""
    small, large = (sample_limit([(scale * 2e-3, 3), (scale * 1e-3, 8)], DENSITY, SPRING).step for scale in (1.0, 10.0))
    assert large == pytest.approx(10 * small, rel=1e-6)
    stiff = ContactModel(normal=LinearSpringDashpot(stiffness=9e6, damping=0.0))
    assert sample_limit([(2e-3, 3), (1e-3, 8)], DENSITY, stiff).step == pytest.approx(small / 3, rel=1e-6)
