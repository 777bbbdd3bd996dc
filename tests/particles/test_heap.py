"""The free heap of 25 discs (G 3.3): rolling friction keeps it standing."""

import numpy as np
from discs import FLOOR, full_law

from particles import Grains

RADIUS = 0.005
LAW = {"k_n": 6.5e4, "k_t": 3.3e3, "c_n": 36.5, "c_t": 5.7, "mu": 0.8, "eta_r": 0.6}


def settled_heap(mu_r: float) -> tuple[float, float]:
    """Mean height of the discs above the lowest place and the width they take, in radii."""
    rows, row = np.divmod(np.arange(25), 5)
    # A stack of rows above the floor, each shifted by a tenth of a radius so that it can fall aside.
    place = RADIUS * np.column_stack([2.1 * row + 0.1 * (rows % 2), 1.05 + 2.1 * rows])
    system = full_law(
        Grains.discs(place, RADIUS, 1056.0), **LAW, mu_r=mu_r, walls=[FLOOR], gravity=(0.0, -9.81), time_step=2e-5
    )
    system.advance(75_000)  # 1.5 s, time to fall 400 heights
    x, y = system.grains.x, system.grains.y
    return float(y.mean() / RADIUS - 1.0), float(np.ptp(x) / RADIUS)


def test_heap_stays_higher_with_rolling_friction() -> None:
    high, narrow = settled_heap(0.2)
    low, wide = settled_heap(0.0)
    assert high > 1.2 * low
    assert wide > 1.2 * narrow
