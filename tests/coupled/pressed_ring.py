"""An elastic ring pressed between two rows of moving discs: the coupled run, and an independent one of the same cells.

Two discs below and two above, each square to the middle of a facet beside the lowest and the highest
node: the ring lies in a valley, so that without friction nothing makes it roll.
"""

from __future__ import annotations

import functools

import numpy as np
from independent_body import IndependentBody, motion
from independent_contact import Discs, OnFacets, OnGluedDiscs
from ways import Way

from coupled.build import build
from coupled.model import Model
from coupled.scene import Scene

OUTER, INNER, AROUND, LAYERS = 0.05, 0.04, 30, 2
YOUNG, POISSON, DENSITY, K_N = 7e8, 0.35, 2700.0, 1.97e7
GLUED_RADIUS, RADIUS, SPEED, DURATION, EVERY = 2.5e-3, 5e-3, 0.05, 6.4e-3, 3.2e-4
MATERIAL_DAMPING = 5e-5  # [s], for what the sudden start excites beyond the steps' reach


def ring() -> IndependentBody:
    """Nodes of each circle from the lowest one, counter-clockwise; circles from the inner one."""
    angle = 2 * np.pi * np.arange(AROUND) / AROUND - np.pi / 2
    radii = np.linspace(INNER, OUTER, LAYERS + 1)
    points = np.concatenate([radius * np.column_stack([np.cos(angle), np.sin(angle)]) for radius in radii])
    here, layer = (a.ravel() for a in np.meshgrid(np.arange(AROUND), np.arange(LAYERS)))
    there, step = (here + 1) % AROUND, layer * AROUND
    cells = np.stack([step + here, step + AROUND + here, step + AROUND + there, step + there], axis=1)
    return IndependentBody(points, cells, young=YOUNG, poisson=POISSON)


BODY = ring()
CIRCLE = LAYERS * AROUND + np.arange(AROUND + 1) % AROUND  # outer nodes, closed
TOUCHED = np.array([AROUND - 1, 0, AROUND // 2 - 1, AROUND // 2])  # facets that the discs meet


def discs(way_standoff: float) -> Discs:
    """Two discs that just touch from below and two from above, and close in at `SPEED` each."""
    places = BODY.points[CIRCLE]
    middle = (places[TOUCHED] + places[TOUCHED + 1]) / 2
    centres = middle * (1 + (way_standoff + RADIUS) / np.hypot(*middle.T))[:, None]
    speed = np.column_stack([np.zeros(4), [SPEED, SPEED, -SPEED, -SPEED]])
    return Discs(centres=centres, radius=RADIUS, stiffness=K_N, velocity=speed)


def pressed(way: Way, window: float, **structure: object) -> Model:
    press, interface = discs(way.standoff(GLUED_RADIUS)), way.table(boundary="outer", per_facet=2, radius=GLUED_RADIUS)
    pairs = [press.centres[:2], press.centres[2:]]
    tables = {
        "title": "A ring pressed between two rows",
        "time": {"duration": 1.0, "step": window / interface.get("substeps", 1)},
        "structure": {
            "kind": "elastic",
            "youngs_modulus": YOUNG,
            "poissons_ratio": POISSON,
            "density": DENSITY,
            "element": "standard",
            "rayleigh": {"stiffness_factor": MATERIAL_DAMPING},
            "tube": {"outer_radius": OUTER, "inner_radius": INNER, "around": AROUND, "layers": LAYERS},
        }
        | structure,
        "interface": interface,
        "contact": {"normal_stiffness": K_N},
        "rows": [
            {"start": pair[0], "end": pair[1], "count": 2, "radius": RADIUS, "velocity": (0.0, sign * SPEED)}
            for pair, sign in zip(pairs, (1, -1))
        ],
    }
    return build(Scene.model_validate(tables)).model


@functools.cache
def independent(interface: str) -> np.ndarray:
    """Displacement (k, 30, 2) [m] of the outer nodes, its error of order 2 removed."""
    seen = []
    for step in (8e-6, 4e-6):
        press = discs(GLUED_RADIUS if interface == "glued" else 0.0)
        if interface == "glued":
            contact = OnGluedDiscs(BODY, press, CIRCLE[TOUCHED], CIRCLE[TOUCHED + 1], np.full(4, 0.5), GLUED_RADIUS)
        else:
            contact = OnFacets(BODY, press, CIRCLE)
        moved = motion(
            BODY,
            density=DENSITY,
            step=step,
            duration=DURATION,
            every=round(EVERY / step),
            contact=contact,
            rayleigh=(0.0, MATERIAL_DAMPING),
        )
        seen.append(moved.displacement.reshape(len(moved.time), -1, 2)[:, CIRCLE[:-1]])
    return seen[1] + (seen[1] - seen[0]) / 3


def coupled(way: Way, window: float) -> np.ndarray:
    model = pressed(way, window)
    apart = np.linalg.norm(model.structure.polyline.points - BODY.points[CIRCLE[:-1], None], axis=2)
    order = np.argmin(apart, axis=1)
    assert apart.min(axis=1).max() < 1e-9
    seen = []
    for _ in range(round(DURATION / EVERY)):
        model.advance(round(EVERY / window))
        seen.append(model.structure.boundary_displacement[order])
    return np.array(seen)
