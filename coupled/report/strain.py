"""How far the loads of a scene can strain its structure, before anything is computed."""

from __future__ import annotations

import math
from typing import NamedTuple

from coupled.scene import Beam, Scene
from coupled.scene import loads as tables
from coupled.scene.structure import Structure

Load = tables.Load


class Estimate(NamedTuple):
    """Of the largest force [N/m], the strain it makes [-], and how far it bends the body [m]."""

    force: float
    strain: float
    deflection: float


def estimate(scene: Scene) -> Estimate | None:
    """The largest quasi-static strain of an elastic structure, by its section; None for any other, or a released one.

    The force P is the sum of the magnitudes of all loads at their strongest and the weight of all free grains;
    whatever holds the body has as much. On a beam (length L, height h) forces P one way and P the other have a
    bending moment of at most P L/4; a ring (mean radius R, wall t) that two forces P pinch has P R/pi under
    them and shortens by ``(pi/4 - 2/pi) P R^3/(E I)``, I = t^3/12 (both from the theory of thin beams). To the
    bending strain ``6 M/(E h^2)`` comes ``P/(E h)``. E without the factor of plane strain makes it larger.

    Impacts, resonance and the points where single forces act are not in it.
    """
    body = scene.structure
    if body is None or body.kind != "elastic" or body.initial is not None:
        return None
    force = sum(_magnitude(load, body) for load in body.loads) + _weight_of_grains(scene)
    shape, modulus = body.shape, body.youngs_modulus
    if isinstance(shape, Beam):
        thick, moment = shape.height, force * shape.length / 4.0
        bent = force * shape.length**3 / (4.0 * modulus * thick**3)
        pressed = force * shape.height / (modulus * shape.length)
    else:
        thick = shape.outer_radius - shape.inner_radius
        mean = shape.inner_radius + 0.5 * thick
        moment = force * mean / math.pi
        bent = (math.pi / 4.0 - 2.0 / math.pi) * force * mean**3 * 12.0 / (modulus * thick**3)
        pressed = force * mean / (modulus * thick)
    strain = 6.0 * moment / (modulus * thick**2) + force / (modulus * thick)
    return Estimate(force, strain, bent + pressed)


def _magnitude(load: Load, body: Structure) -> float:
    """Sum of the magnitudes of the forces of a load at its strongest [N/m]."""
    shape = body.shape
    strongest = _largest_factor(load.schedule)
    match load:
        case tables.BoundaryLoad():
            return strongest * math.hypot(*load.total_force)
        case tables.PressureLoad():
            return strongest * abs(load.pressure) * 2.0 * max(shape.half_extent)
        case tables.BodyLoad():
            return strongest * math.hypot(*load.acceleration) * body.density * _area(body)
    return strongest * math.hypot(*load.force)


def _largest_factor(schedule: tables.Schedule) -> float:
    match schedule:
        case tables.Sine():
            return 1.0 + abs(schedule.offset)
        case tables.Rows():
            return max(abs(factor) for factor in schedule.factors)
    return 1.0


def _area(body: Structure) -> float:
    shape = body.shape
    if isinstance(shape, Beam):
        return shape.length * shape.height
    return math.pi * (shape.outer_radius**2 - shape.inner_radius**2)


def _weight_of_grains(scene: Scene) -> float:
    """Weight of all free grains [N/m]; 0 where they do not meet the structure."""
    grains = scene.first_grains
    if grains is None or scene.interface is None:
        return 0.0
    area = sum(size.count * math.pi * size.radius**2 for size in grains.sizes)
    return grains.density * area * math.hypot(*scene.gravity)
