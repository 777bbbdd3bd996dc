"""An elastic beam that moves on a row of fixed discs against independent motions, and a running load."""

import numpy as np
import pytest
from pressed_beam import CASES, coupled, independent
from running_load import CRITICAL, deflection, expected
from ways import INTERFACES, WAYS, Way, assert_order, relative


@pytest.mark.parametrize("case", list(CASES))
@pytest.mark.parametrize("way", WAYS, ids=str)
def test_beam_on_springs_moves_as_the_independent_one(way: Way, case: str) -> None:
    reference = independent(way.interface, case)
    errors = [relative(coupled(way, CASES[case], window), reference) for window in (1e-5, 5e-6)]
    assert_order(way, errors)
    assert errors[-1] < (0.03 if way.exchange == "lagged" else 2e-4)


@pytest.mark.parametrize("interface", INTERFACES)
@pytest.mark.parametrize("share", [0.3, 0.6])  # of the critical speed, (4 k EI)^(1/4)/sqrt(m)
def test_running_load_on_a_long_beam_is_that_of_an_infinite_one(interface: str, share: float) -> None:
    """Euler and Bernoulli on Winkler's foundation; the beam is 20 wave lengths over 2 pi long.

    What the load left when it began has decayed by exp(-6) and exp(-3) where it is seen, halfway.
    """
    ahead, seen = deflection(interface, share * CRITICAL, 1e-5)
    reference = expected(ahead, share * CRITICAL)
    near = np.abs(ahead) < 0.3
    error = np.abs(seen - reference)[near].max() / np.abs(reference).max()
    # Left out: shear and the inertia of turning, which lower the critical speed; 0.3 % at 0.3 of it, 2.6 % at 0.6.
    assert error < 0.09 * share**2
