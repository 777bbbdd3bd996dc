"""A bar alone in space, from which the axes of the structure start: 0.2 x 0.02 m, 10 x 2 cells, 7e10 Pa, 2700 kg/m3."""

from __future__ import annotations

import math
from typing import Any

LENGTH, HEIGHT, ALONG, ACROSS = 0.2, 0.02, 10, 2
MODULUS, POISSON, DENSITY = 70e9, 0.3, 2700.0
MASS = LENGTH * HEIGHT * DENSITY  # [kg/m]
INERTIA = MASS * (LENGTH**2 + HEIGHT**2) / 12  # [kg m]
FIRST_MODE = 4.730040744862704  # of a free beam: cos x cosh x = 1


def bar(*, step: float, duration: float, beam: dict[str, Any] | None = None, **structure: Any) -> dict[str, Any]:
    """Scene of the bar alone; keys of its structure by name. History: first and last row."""
    shape = {"length": LENGTH, "height": HEIGHT, "along": ALONG, "across": ACROSS} | (beam or {})
    own = {"kind": "elastic", "youngs_modulus": MODULUS, "poissons_ratio": POISSON, "density": DENSITY, "beam": shape}
    return {
        "time": {"duration": float(duration), "step": float(step)},
        "structure": own | structure,
        "output": {"history_interval": float(duration)},
    }


def slender_frequency(*, length: float, height: float, modulus: float, poisson: float, density: float) -> float:
    """First frequency of a slender free beam in plane strain [rad/s]."""
    return (FIRST_MODE / length) ** 2 * math.sqrt(modulus / max(1.0 - poisson**2, 1e-9) * height**2 / 12.0 / density)
