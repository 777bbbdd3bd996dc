"""What a plate without friction shows a single fixed disc that it slides over: bumps if grains are glued to it."""

import numpy as np
import pytest
from ways import Way

from coupled.build import build
from coupled.scene import Scene

K_N, RADIUS, GLUED, FACET, SPEED, STEP = 1e6, 5e-3, 1.25e-3, 0.01, 0.1, 2e-4
SPACING, REACH = 2 * GLUED, RADIUS + GLUED
PRESSED = 1e-6  # [m], where the disc lies between two glued grains


def slide(interface: str) -> np.ndarray:
    """Forces (n, 2) [N/m] on a plate that runs over one disc at constant height, for eight spacings."""
    way = Way(interface, "predicted")
    valley = np.sqrt(REACH**2 - (SPACING / 2) ** 2) if interface == "glued" else RADIUS
    tables = {
        "title": "A plate over one disc",
        "time": {"duration": 1.0, "step": STEP},
        "contact": {"normal_stiffness": K_N},
        "structure": {
            "kind": "rigid",
            "beam": {"length": 0.2, "height": 0.02, "along": round(0.2 / FACET), "across": 1},
            "placement": {"x": 0.0, "y": 0.01},
            "path": {"points": [[0.0, 0.0, 0.0], [1.0, SPEED, 0.0]]},
        },
        "interface": way.table(boundary="bottom", per_facet=round(FACET / SPACING), radius=GLUED),
        "rows": [{"start": (0.0, PRESSED - valley), "end": (0.0, PRESSED - valley), "count": 1, "radius": RADIUS}],
    }
    model = build(Scene.model_validate(tables)).model
    forces = []
    for _ in range(round(8 * SPACING / SPEED / STEP)):
        model.advance(1)
        forces.append(model.reaction)
    return np.array(forces)


def test_glued_grains_show_their_slope_and_no_drag_on_the_whole() -> None:
    forces = slide("glued")
    slope = forces[:, 0] / forces[:, 1]
    steepest = SPACING / 2 / np.sqrt(REACH**2 - (SPACING / 2) ** 2)
    # Seen every 20 um of a way on which the slope changes by the distance over the reach.
    assert np.abs(slope).max() == pytest.approx(steepest, abs=SPEED * STEP / REACH)
    assert abs(forces[:, 0].mean()) < 1e-6 * forces[:, 1].mean()  # a spring gives back what it takes


def test_facets_show_neither() -> None:
    forces = slide("facets")
    np.testing.assert_allclose(forces[:, 1], K_N * PRESSED, rtol=1e-9)
    assert np.abs(forces[:, 0]).max() <= 1e-12 * K_N * PRESSED
