"""Small coupled models of the tests, built from scenes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ways import Way

from coupled.build import Built, build
from coupled.model import Model
from coupled.scene import Scene, load_scene

ELASTIC = {"kind": "elastic", "youngs_modulus": 1e9, "poissons_ratio": 0.3}
BODIES: dict[str, dict[str, Any]] = {
    "elastic": ELASTIC,
    "corotational": ELASTIC | {"theory": "corotational"},
    "rigid": {"kind": "free_rigid"},
}


def rigid_beam_on_springs(
    *,
    step: float,
    load: float,
    ramp_over: float | None = None,
    normal_damping: float = 0.0,
    tangential_damping: float = 0.0,
    more_loads: Sequence[dict[str, Any]] = (),
    interface: dict[str, Any] | None = None,
) -> Built:
    """The scene `winkler_beam` with a rigid beam, 121 springs, and a uniform load [N/m] on top."""
    tables = load_scene("winkler_beam", [f"time.step={float(step)!r}"]).model_dump(exclude_none=True)
    uniform: dict[str, Any] = {"kind": "boundary", "boundary": "top", "total_force": [0.0, -load]}
    if ramp_over is not None:
        uniform["schedule"] = {"kind": "ramp", "over": ramp_over}
    tables["structure"] = {
        "kind": "free_rigid",
        "density": tables["structure"]["density"],
        "beam": tables["structure"]["beam"],
        "placement": tables["structure"]["placement"],
        "loads": [uniform, *more_loads],
    }
    tables["contact"] |= {"normal_damping": normal_damping, "tangential_damping": tangential_damping}
    tables["interface"] |= {"largest_stiffness_ratio": 100.0} | (interface or {})
    return build(Scene.model_validate(tables))


def discs_on_free_beam(
    discs: list[list[float]],
    *,
    step: float,
    friction: float = 0.0,
    gravity: tuple[float, float] = (0.0, 0.0),
    interface: dict[str, Any] | None = None,
    body: dict[str, Any] | None = None,
    damping: float = 0.0,
) -> Built:
    """A free beam, 0.2 x 0.02 m, without damping, and free discs (x, y, vx, vy, spin) above it.

    It is elastic unless `body` says otherwise; `damping` [N s/m] is that of the contacts.
    """
    tables = {
        "title": "Discs fall on a free beam",
        "gravity": gravity,
        "time": {"duration": 1.0, "step": step},
        "grains": {
            "sizes": [{"radius": 0.01, "count": len(discs)}],
            "density": 1000.0,
            "layout": "list",
            "positions": discs,
        },
        "contact": {
            "normal_stiffness": 1e6,
            "tangential_stiffness": 5e4,
            "friction": friction,
            "rolling_friction": 0.1,
            "normal_damping": damping,
        },
        "structure": (body or ELASTIC)
        | {
            "density": 1000.0,
            "beam": {"length": 0.2, "height": 0.02, "along": 20, "across": 2},
            "placement": {"x": 0.0, "y": -0.01},
        },
        "interface": {"per_facet": 3, "boundaries": ["outer"], "largest_stiffness_ratio": 2.0} | (interface or {}),
    }
    return build(Scene.model_validate(tables))


def on_row(
    way: Way,
    *,
    window: float,
    structure: dict[str, Any],
    contact: dict[str, Any],
    rows: Sequence[NDArray[np.float64]],
    radius: float = 4.1e-3,
    per_facet: int = 3,
) -> Model:
    """A beam whose lower face, from (0, 0) to the right, just touches fixed discs.

    `rows` are the evenly spaced abscissae [m] of the discs in each row; `window` [s] is the step of the
    structure; glued grains and discs have the same radius [m].
    """
    interface = way.table(boundary="bottom", per_facet=per_facet, radius=radius)
    depth = -way.standoff(radius) - radius
    beam = structure["beam"]
    place = {"placement": {"x": beam["length"] / 2, "y": beam["height"] / 2}}
    tables = {
        "title": "A beam on a row of fixed discs",
        "time": {"duration": 1.0, "step": window / interface.get("substeps", 1)},
        "structure": structure | place,
        "interface": interface,
        "contact": contact,
        "rows": [{"start": (x[0], depth), "end": (x[-1], depth), "count": len(x), "radius": radius} for x in rows],
    }
    return build(Scene.model_validate(tables)).model
