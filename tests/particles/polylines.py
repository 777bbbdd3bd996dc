"""Polylines and discs that meet them, for several tests."""

from typing import Any

import numpy as np
from discs import normal_only

from particles import Facets, Grains, ParticleSystem


def closed(points: np.ndarray, material: int = 0) -> Facets:
    """A closed polyline through points given counter-clockwise."""
    index = np.arange(len(points))
    return Facets(points=points, facets=np.column_stack([index, np.roll(index, -1)]), material=material)


def ground(x: np.ndarray, y: np.ndarray | float = 0.0) -> Facets:
    """An open polyline that carries discs above it; x ascending."""
    points = np.column_stack([x, np.broadcast_to(y, np.shape(x))])[::-1]
    index = np.arange(len(points))
    return Facets(points=points, facets=np.column_stack([index[:-1], index[1:]]))


def star(n: int, roughness: float, seed: int) -> np.ndarray:
    """Corners (n, 2) of a polygon around the origin at distances between 1 - roughness and 1, unevenly spaced."""
    random = np.random.default_rng(seed)
    angle = 2.0 * np.pi * (np.arange(n) + random.uniform(-0.3, 0.3, n)) / n
    return random.uniform(1.0 - roughness, 1.0, (n, 1)) * np.column_stack([np.cos(angle), np.sin(angle)])


def held(place: np.ndarray, radius: float) -> Grains:
    """Discs that stand where they are put, whatever they touch."""
    return Grains.discs(np.zeros((0, 2)), np.zeros(0), 1.0).with_prescribed(place, radius, 0)


def standing(place: np.ndarray, radius: float, facets: Facets, **law: Any) -> ParticleSystem:
    """Held discs on springs against a polyline, forces known."""
    system = normal_only(held(place, radius), **({"k_n": 1.0} | law), facets=facets, time_step=1e-3)
    system.start()
    return system


def normal_force(place: np.ndarray, radius: float, facets: Facets) -> np.ndarray:
    """Force (n, 2) of a polyline with springs of stiffness 1 on each disc at `place` (n, 2)."""
    system = standing(place, radius, facets)
    return np.column_stack([system.grains.fx, system.grains.fy])
