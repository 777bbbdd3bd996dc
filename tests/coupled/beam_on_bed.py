"""A beam, 0.2 x 0.02 m, that lies or falls on three rows of discs in a box: the scene that is spoiled in many ways."""

from __future__ import annotations

import math
from typing import Any

RADIUS = 5e-3
BEAM = {"length": 0.2, "height": 0.02, "along": 10, "across": 2}
GLUED: dict[str, Any] = {"kind": "glued", "per_facet": 2}
FACETS: dict[str, Any] = {"kind": "facets"}


def rows_of_discs(*, width: float, rows: int) -> list[list[float]]:
    """Densest packing on the floor, every second row shifted."""
    count, rise = int(width / (2 * RADIUS) * (1 + 1e-9)), math.sqrt(3.0) * RADIUS
    return [
        [RADIUS * (2 * i + 1 + k % 2), RADIUS + k * rise] for k in range(rows) for i in range(count - k % 2)
    ]  # fmt: skip


def beam_on_bed(
    *,
    step: float = 5e-5,
    duration: float = 0.1,
    structure: dict[str, Any] | None = None,
    interface: dict[str, Any] | None = None,
    discs: list[list[float]] | None = None,
    **tables: Any,
) -> dict[str, Any]:
    """The tables of the scene: the beam elastic, just touching, under its weight, unless `structure` says otherwise."""
    places = rows_of_discs(width=0.3, rows=3) if discs is None else discs
    own = {"density": 2700.0, "beam": BEAM, "placement": {"x": 0.15, "y": "on_bed"}}
    own |= {"loads": [{"kind": "body", "acceleration": [0.0, -9.81]}]}
    elastic = {"kind": "elastic", "youngs_modulus": 70e9, "poissons_ratio": 0.3} | own
    return {
        "title": "A beam on rows of discs",
        "gravity": [0.0, -9.81],
        "time": {"duration": duration, "step": step},
        "box": {"width": 0.3, "height": 1.0},
        "grains": {
            "sizes": [{"radius": RADIUS, "count": len(places)}],
            "density": 2000.0,
            "layout": "list",
            "positions": places,
        },
        "contact": {
            "normal_stiffness": 1e6,
            "tangential_stiffness": 5e4,
            "friction": 0.5,
            "restitution": 0.5,
        },
        "structure": elastic if structure is None else structure if "kind" in structure else elastic | structure,
        "interface": interface or FACETS,
        "output": {"history_interval": max(0.05 * duration, step), "frames_per_second": 0.0, "figures": False},
    } | tables
