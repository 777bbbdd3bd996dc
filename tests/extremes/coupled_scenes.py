"""A bar on three rows of discs in a box, and single discs on its face: from these the axes of the coupling start.

Discs have radius 5 mm and 2000 kg/m3, contacts 1e6 N/m, friction 0.5 and restitution 0.5. The bar is that of
`body_scenes`.
"""

from __future__ import annotations

import math
from typing import Any

from body_scenes import ACROSS, ALONG, DENSITY, HEIGHT, LENGTH, MASS, MODULUS, POISSON
from trials import Finished, Measured

RADIUS, GRAIN_DENSITY, STIFFNESS = 5e-3, 2000.0, 1e6
WIDTH, GRAVITY = 0.3000001, 9.81  # three rows of 30 discs, whatever is rounded
WEIGHT = MASS * GRAVITY
BEAM = {"length": LENGTH, "height": HEIGHT, "along": ALONG, "across": ACROSS}
WAYS: dict[str, dict[str, Any]] = {
    "facets, predicted": {"kind": "facets"},
    "facets, iterated": {"kind": "facets", "exchange": "iterated"},
    "glued, predicted": {"kind": "glued", "per_facet": 2},
    "glued, lagged": {"kind": "glued", "per_facet": 2, "exchange": "lagged"},
    "glued, iterated": {"kind": "glued", "per_facet": 2, "exchange": "iterated"},
}


def rows_of_discs(scale: float = 1.0) -> list[list[float]]:
    """Densest packing of three rows on the floor."""
    radius = scale * RADIUS
    count = round(WIDTH / (2 * RADIUS))
    rise = math.sqrt(3.0)
    return [
        [radius * (2 * i + 1 + k % 2), radius * (1 + k * rise)] for k in range(3) for i in range(count - k % 2)
    ]  # fmt: skip


def elastic(**structure: Any) -> dict[str, Any]:
    """The bar just on the bed, under its weight; keys of its table by name."""
    own = {"kind": "elastic", "youngs_modulus": MODULUS, "poissons_ratio": POISSON, "density": DENSITY, "beam": BEAM}
    own |= {"placement": {"x": 0.5 * WIDTH, "y": "on_bed"}}
    own |= {"loads": [{"kind": "body", "acceleration": [0.0, -GRAVITY]}]}
    return own | structure


def rigid(**structure: Any) -> dict[str, Any]:
    """The same, free and rigid."""
    made = elastic(**structure) | {"kind": "free_rigid"}
    return {key: value for key, value in made.items() if key not in ("youngs_modulus", "poissons_ratio")}


def on_bed(
    way: str,
    *,
    structure: dict[str, Any] | None = None,
    step: float = 5e-5,
    duration: float = 0.15,
    interface: dict[str, Any] | None = None,
    **tables: Any,
) -> dict[str, Any]:
    """Scene of a structure on the bed, joined by a way of `WAYS`. History: 20 rows."""
    places = tables.pop("places", None) or rows_of_discs()
    return {
        "gravity": [0.0, -GRAVITY],
        "time": {"duration": float(duration), "step": float(step)},
        "box": {"width": WIDTH, "height": 1.0},
        "grains": {
            "sizes": [{"radius": RADIUS, "count": len(places)}],
            "density": GRAIN_DENSITY,
            "layout": "list",
            "positions": places,
        },
        "contact": {"normal_stiffness": STIFFNESS, "tangential_ratio": 0.05, "friction": 0.5, "restitution": 0.5},
        "structure": structure or elastic(),
        "interface": WAYS[way] | (interface or {}),
        "output": {"history_interval": max(duration / 20, step * (interface or {}).get("substeps", 1))},
    } | tables


def bed_stiffness() -> float:
    """Vertical stiffness [N/m per length] of the discs under the bar, fixed sideways.

    Four layers of contacts in series: bar and floor with one contact a disc, between the rows two at 30 degrees, which
    have ``2 k cos^2 30 = 1.5 k`` together.
    """
    return LENGTH / (2 * RADIUS) * STIFFNESS / (1.0 + 2.0 / 1.5 + 1.0)


def carried(run: Finished, weight: float = WEIGHT) -> list[Measured]:
    """The bed carries the weight, in the mean of the last half: what still swings is a few per cent of it."""
    reaction = run.history["reaction_y"]
    seen = float(reaction[len(reaction) // 2 :].mean())
    return [
        Measured(what="weight carried over the weight", value=seen / weight, expected=1.0, allowed=0.1),
        Measured(
            what="error of the ledger over what was turned over",
            value=run.history["ledger_relative_error"][-1],
            expected=0.0,
            allowed=0.05,
        ),
    ]


def thrown(
    *, radius: float, interface: dict[str, Any], along: int, place: float = 0.0123, far: float = 0.0
) -> dict[str, Any]:
    """A disc without friction is thrown at 1 m/s at the face of a bar at rest, held by its path, without losses.

    The stiffness is such that it overlaps by about 1 % of the smaller radius. `far` [m] is its way beyond that.
    """
    mass, speed = math.pi * radius**2 * GRAIN_DENSITY, 1.0
    glued = 0.5 * interface.get("diameter", math.inf)
    stiffness = mass * (speed / (0.01 * min(radius, glued))) ** 2
    step = 0.02 * math.sqrt(mass / stiffness)
    gap = 5 * speed * step
    stand = radius + (glued if math.isfinite(glued) else 0.0)
    steps = 10 + math.ceil(2 * math.pi / 0.02 + far / (speed * step))
    path = {"points": [[0.0, 0.0, 0.0], [1e6, 0.0, 0.0]]}
    return {
        "time": {"duration": steps * step, "step": step},
        "grains": {
            "sizes": [{"radius": radius, "count": 1}],
            "density": GRAIN_DENSITY,
            "layout": "list",
            "positions": [[place, 0.5 * HEIGHT + stand + gap, 0.0, -speed]],
        },
        "contact": {"normal_stiffness": stiffness},
        "structure": {"kind": "rigid", "beam": BEAM | {"along": along}, "path": path},
        "interface": interface,
        "output": {"history_interval": steps * step},
    }
