"""The stiffness ratios up to which a scene is accepted are those at which the real model begins to grow.

`make validate` measures the whole map with the same functions (`docs/validation/stability.md`).
"""

from typing import Any

import numpy as np
import pytest
from small_models import discs_on_free_beam
from stability import Press, spectral_radius

from coupled.exchange.limit import CONSERVING, CONSERVING_SUBCYCLED, ITERATED
from coupled.report import cautions


def test_eigenvalues_of_a_known_map_are_found() -> None:
    turn, size = 0.4, 1.003
    step = size * np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    place, seen = np.array([1.0, 0.2]), []
    for n in range(60):
        seen.append([place[0] + 0.5 * (-0.7) ** n, place[1]])
        place = step @ place
    assert spectral_radius(np.array(seen)) == pytest.approx(size, abs=1e-9)


@pytest.mark.parametrize("interface", ["glued", "facets"])
@pytest.mark.parametrize("damping", [0.0, 0.3])
def test_predicted_exchange_begins_to_grow_at_its_limit(interface: str, damping: float) -> None:
    press = Press(interface=interface, damping=damping)
    assert press.growth(0.98 * CONSERVING) < 1.0 < press.growth(1.02 * CONSERVING)


def test_sub_cycled_limit_is_the_smallest_of_the_map() -> None:
    """With 20 substeps and strong dashpots it is nearly reached; below there is no growth."""
    for substeps, damping in ((2, 0.0), (5, 0.3), (20, 0.05), (20, 10.0)):
        press = Press(substeps=substeps, damping=damping)
        for ratio in np.geomspace(0.1, CONSERVING_SUBCYCLED, 6).tolist():
            assert press.growth(ratio) < 1.0, (substeps, damping, ratio)
    assert Press(substeps=20, damping=10.0).growth(1.1 * CONSERVING_SUBCYCLED) > 1.0


@pytest.mark.parametrize("substeps", [1, 5])
def test_iterated_exchange_is_stable_on_fixed_partners(substeps: int) -> None:
    for ratio in (0.1, 1.0, 10.0, ITERATED):
        # neutral without damping: 1 to what iterations leave
        assert abs(Press(exchange="iterated", substeps=substeps).growth(ratio) - 1.0) < 1e-5
        assert Press(exchange="iterated", substeps=substeps, damping=0.05).growth(ratio) < 1.0


@pytest.mark.parametrize("substeps", [1, 5])
def test_iterated_exchange_is_stable_up_to_the_limit_of_the_free_grains_themselves(substeps: int) -> None:
    """A disc of mass mu m/2 between two springs: ``dt^2 2 k/(mu m/2) < 4``, hence ``r < 2 mu substeps^2``."""
    press = Press(exchange="iterated", substeps=substeps, mass_ratio=0.3)
    own = 2 * 0.3 * substeps**2
    assert press.growth(0.95 * own) < 1.0 + 1e-4
    assert press.growth(1.1 * own) > 1.0 + 1e-4


def test_sub_cycling_without_dashpots_feeds_light_free_grains_and_a_tenth_of_critical_damping_prevents_it() -> None:
    assert Press(substeps=20, mass_ratio=0.1).growth(0.5) > 1.1
    assert Press(substeps=20, mass_ratio=0.1, damping=0.1).growth(0.5) < 1.0


def test_windows_too_long_for_undamped_grains_are_told_before_the_run() -> None:
    """A disc of radius 0.01 m and 1000 kg/m3 between two springs of 1e6 N/m: half a period is 1.25 ms."""
    half_period = np.pi * np.sqrt(np.pi * 0.01**2 * 1000.0 / 2e6)

    def said(window: float, **interface: Any) -> str:
        options = {"substeps": 10, "largest_stiffness_ratio": 1e3} | interface
        built = discs_on_free_beam([[0.0, 0.05, 0.0, 0.0, 0.0]], step=window / 10, interface=options)
        return " ".join(cautions.before(built))

    assert "interface.substeps = 10" in said(1.01 * half_period) and "0.00125 s" in said(1.01 * half_period)
    assert "interface.substeps" not in said(0.99 * half_period)
    assert "interface.substeps" not in said(1.01 * half_period, exchange="iterated")
