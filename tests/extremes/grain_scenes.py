"""Scenes of few grains, from which the axes start. All have radius 0.01 m and 1000 kg/m3 unless told otherwise."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

RADIUS, DENSITY = 0.01, 1000.0
MASS = math.pi * RADIUS**2 * DENSITY  # [kg/m]


def discs(
    at: ArrayLike,
    *,
    contact: dict[str, Any],
    step: float | str,
    duration: float,
    radii: ArrayLike = RADIUS,
    **tables: Any,
) -> dict[str, Any]:
    """Scene of discs at [x, y, vx, vy, omega]; further tables by keyword. History: first and last row."""
    places = np.atleast_2d(np.asarray(at, float))
    sizes = np.broadcast_to(np.asarray(radii, float), len(places))
    scene = {
        "time": {"duration": float(duration), "step": step if step == "auto" else float(step)},
        "grains": {
            "sizes": [{"radius": float(radius), "count": 1} for radius in sizes],
            "density": DENSITY,
            "layout": "list",
            "positions": places.tolist(),
        },
        "contact": contact,
        "output": {"history_interval": float(duration)},
    }
    return scene | tables


def head_on(
    *, speed: float, gap: float, contact: dict[str, Any], step: float | str, duration: float, **tables: Any
) -> dict[str, Any]:
    """Two equal discs on the x axis that close with `speed` [m/s] over a gap [m], negative: an overlap."""
    half = RADIUS + 0.5 * gap
    rows = [[-half, 0.0, 0.5 * speed, 0.0], [half, 0.0, -0.5 * speed, 0.0]]
    return discs(rows, contact=contact, step=step, duration=duration, **tables)
