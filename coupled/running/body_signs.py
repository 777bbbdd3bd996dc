"""The signs by which a structure is seen to go where its model does not reach."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coupled.model import Model
from coupled.running import culprit
from coupled.running.sign import FARTHEST_STEP, Sign

Floats = NDArray[np.float64]
THROUGH_WALL = 0.5  # of the smallest grain's radius that a node may lie behind a wall: walls hold grains alone


def body_sign(model: Model, overturned: int | None, beyond: str | None) -> Sign | None:
    """What is wrong with the structure, if anything. On rank 0.

    `overturned` is a cell inside out, `beyond` a sentence on a state far outside the theory.
    """
    if model.structure is None:
        return None
    found = _inside_out(model, overturned)
    if found is None and beyond is not None:
        found = Sign(beyond, "deformation")
    if found is not None or model.interface is None or not model.particles.grains.n_free:
        return found
    return _too_fast(model) or _through_wall(model) or _swallows(model)


def _inside_out(model: Model, cell: int | None) -> Sign | None:
    if cell is None:
        return None
    mesh = model.structure.mesh
    x, y = mesh.points[mesh.cells[cell]].mean(axis=0)
    return Sign(
        f"cell {cell} of the structure, at ({x:.4g}, {y:.4g}) m at first, is turned inside out: it is deformed "
        "beyond any theory",
        "deformation",
    )


def _too_fast(model: Model) -> Sign | None:
    """A boundary that passes half a grain in a step may pass whole grains without a contact."""
    step, radius = model.particles.time_step, _smallest_radius(model)
    speed = np.hypot(*model.structure.boundary_velocity.T)
    node = int(np.argmax(speed))
    share = float(speed[node]) * step / radius
    if share <= FARTHEST_STEP:
        return None
    return Sign(
        f"{culprit.name_of_node(model, node)} moves at {speed[node]:.4g} m/s, {share:.3g} of the smallest grain's "
        f"radius in a step, more than {FARTHEST_STEP:g}: grains would be passed over",
        "step",
        FARTHEST_STEP / share,
    )


def _through_wall(model: Model) -> Sign | None:
    """Walls do not meet structures: one that has gone through is told."""
    places, walls = _places(model), model.particles.list.walls
    for number, wall in enumerate(model.particles.walls):
        normal = np.array([walls.nx[number], walls.ny[number]])
        behind = (np.array([walls.px[number], walls.py[number]]) - places) @ normal
        node = int(np.argmax(behind))
        if behind[node] > THROUGH_WALL * _smallest_radius(model):
            return Sign(
                f"{culprit.name_of_node(model, node)} is {behind[node]:.3g} m behind the wall {wall.name!r}: walls "
                "hold grains, not structures",
                "wall",
            )
    return None


def _swallows(model: Model) -> Sign | None:
    """A grain whose centre is inside the outer boundary has been passed over, whatever meets it there."""
    grains, places = model.particles.grains, _places(model)
    low, high = places.min(axis=0), places.max(axis=0)
    x, y = grains.x[: grains.n_free], grains.y[: grains.n_free]
    near = np.nonzero((x > low[0]) & (x < high[0]) & (y > low[1]) & (y < high[1]))[0]
    if not len(near):
        return None
    inside = near[_within(np.column_stack([x[near], y[near]]), places, model.structure.polyline.facets)]
    if not len(inside):
        return None
    return Sign(f"the centre of {culprit.name_of_grain(model, int(inside[0]))} is inside the structure", "inside")


def _within(points: Floats, places: Floats, facets: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether points (n, 2) are inside a closed polyline: a ray to the right crosses it an odd number of times."""
    (x1, y1), (x2, y2) = places[facets[:, 0]].T, places[facets[:, 1]].T
    x, y = points[:, :1], points[:, 1:]
    spans = (y1 > y) != (y2 > y)
    rise = np.where(y2 == y1, 1.0, y2 - y1)
    return (spans & (x < x1 + (y - y1) / rise * (x2 - x1))).sum(axis=1) % 2 == 1


def _places(model: Model) -> Floats:
    """Present boundary nodes (n_b, 2) [m]."""
    return model.structure.polyline.points + model.structure.boundary_displacement


def _smallest_radius(model: Model) -> float:
    grains = model.particles.grains
    return float(grains.radius[: grains.n_free].min())
