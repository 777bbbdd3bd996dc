"""An elastic beam falls on two short rows of fixed discs and leaves them, vibrating."""

import pytest
from falling_beam import coupled, independent
from ways import INTERFACES, WAYS, Way, assert_order, relative


@pytest.mark.parametrize("way", WAYS, ids=str)
def test_fall_and_rebound_converge_to_those_of_the_same_cells(way: Way) -> None:
    coarse, fine = (independent(way.interface, along=20, across=2, step=step) for step in (4e-6, 2e-6))
    expected = fine.face + (fine.face - coarse.face) / 3
    falls = [coupled(way, window, along=20, element="standard") for window in (5e-6, 2.5e-6)]
    # 1.9 with an exchange of order 2: the first touch, a jump of the speeds, excites modes beyond these steps.
    assert_order(way, [relative(fall.face, expected) for fall in falls], within=0.15)
    largest = 0.01 if way.exchange == "lagged" else 5e-6
    assert falls[-1].speed[-1] == pytest.approx(fine.speed[-1], abs=largest)
    # what the exchange made of energy, over that of the fall
    assert falls[-1].kinetic[-1] + falls[-1].strain[-1] == pytest.approx(1.0, abs=largest)


@pytest.mark.parametrize("interface", INTERFACES)
def test_restitution_and_energy_left_are_those_of_a_fine_mesh(interface: str) -> None:
    """A quarter of the speed and 44 % of the energy stay in the beam's vibrations, whatever the discs meet."""
    first, second = (independent("glued", along=along, across=along // 10, step=4e-6) for along in (60, 80))
    seen = coupled(Way(interface, "predicted"), 5e-6, along=40, element="enhanced")
    for name in ("rebound", "left"):
        coarse, fine = getattr(first, name), getattr(second, name)
        limit = fine + (fine - coarse) / ((80 / 60) ** 2 - 1)  # bilinear cells are of order 2 in their size
        assert abs(fine - limit) < 0.04
        assert getattr(seen, name) == pytest.approx(limit, abs=0.005)
