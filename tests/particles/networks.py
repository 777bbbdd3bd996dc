"""Contact networks at rest: chain, crystal, settled bed, clusters."""

import functools
import math
from typing import Any

import numpy as np
from discs import full_law

from particles import ContactModel, Grains, HertzSpringDashpot, MindlinFriction, ParticleSystem, box, lattice

RADIUS, DENSITY, K_N = 1e-3, 1000.0, 1e5
MASS = math.pi * RADIUS**2 * DENSITY
NO_FRICTION = {"k_n": K_N, "k_t": 1e4, "mu": 0.0}
STICKING = {"k_n": K_N, "k_t": 0.3 * K_N, "mu": 1e9, "mu_r": 1e9}
DASHPOTS = {"c_n": 3.0, "c_t": 0.5, "eta_r": 0.3, "alpha_t": 500.0, "alpha_r": 300.0}
OVERLAP = 1e-3 * RADIUS


HERTZ = ContactModel(
    normal=HertzSpringDashpot(modulus=4e8, restitution=0.6),
    tangential=MindlinFriction(stiffness_ratio=0.5, friction=1e9, damping_ratio=0.4),
)


def chain(n: int, **law: float) -> ParticleSystem:
    """Discs in a row along x between two walls, all contacts pressed alike."""
    pitch = 2.0 * RADIUS - OVERLAP
    place = np.column_stack([RADIUS - OVERLAP + pitch * np.arange(n), np.full(n, RADIUS)])
    width = 2.0 * (RADIUS - OVERLAP) + pitch * (n - 1)
    walls = box(width, 1.0, ["left", "right"])
    return full_law(Grains.discs(place, RADIUS, DENSITY), **(NO_FRICTION | law), walls=walls, time_step=1e-6)


def crystal(columns: int = 12, rows: int = 12, **law: float) -> ParticleSystem:
    """Hexagonal packing without end, all contacts pressed alike."""
    pitch = 2.0 * RADIUS - OVERLAP
    row, column = np.divmod(np.arange(columns * rows), columns)
    place = pitch * np.column_stack([column + 0.5 * (row % 2), math.sqrt(0.75) * row])
    period = (pitch * columns, pitch * math.sqrt(0.75) * rows)
    return full_law(Grains.discs(place, RADIUS, DENSITY), **law, period=period, time_step=1e-6)


@functools.cache
def settled() -> tuple[Grains, float]:
    """120 discs of three sizes that came to rest in a box without friction; the largest force left over m g."""
    gravity, width = 9.81, 16.0 * RADIUS
    sizes = [(RADIUS, 60), (1.3 * RADIUS, 40), (1.6 * RADIUS, 20)]
    grains = lattice(sizes, DENSITY, width=width, jitter=0.5)
    system = full_law(
        grains, **NO_FRICTION, c_n=8.0, alpha_t=20.0, walls=box(width, 1.0), gravity=(0.0, -gravity), time_step=2e-5
    )
    system.advance(100_000)
    weight = system.grains.mass * gravity
    left = np.hypot(system.grains.fx, system.grains.fy - weight)
    return system.grains, float((left / weight).max())


def bed(**options: Any) -> ParticleSystem:
    """The settled bed, now with other dashpots."""
    grains = Grains.discs(settled()[0].position, settled()[0].radius, DENSITY)
    walls = box(16.0 * RADIUS, 1.0)
    return full_law(grains, **(NO_FRICTION | options), walls=walls, gravity=(0.0, -9.81), time_step=1e-6)


def cluster(n: int, *, smallest: float = 1.0, seed: int = 1, material: int = 1) -> Grains:
    """Discs of radius `smallest` to 1 (in RADIUS), each new one pressed on two that touch, far from touching others."""
    rng = np.random.default_rng(seed)
    radius = RADIUS * rng.uniform(smallest, 1.0, n)
    reach = radius[:, None] + radius - 1e-4 * RADIUS
    place = np.array([[0.0, 0.0], [reach[0, 1], 0.0]])
    touching = [(0, 1), (1, 0)]
    while len(place) < n:
        k = len(place)
        i, j = touching[rng.integers(len(touching))]
        apart = place[j] - place[i]
        d = float(np.hypot(*apart))
        along = (d**2 + reach[i, k] ** 2 - reach[j, k] ** 2) / (2.0 * d)
        aside = math.sqrt(reach[i, k] ** 2 - along**2)
        new = place[i] + (along * apart + aside * np.array([-apart[1], apart[0]])) / d
        clear = np.hypot(*(place - new).T) - reach[:k, k]
        if np.sort(clear)[2:].min(initial=1.0) > 1e-3 * RADIUS:
            place = np.vstack([place, new])
            touching += [(i, k), (k, j), (k, i), (j, k)]
    return Grains.discs(place, radius, DENSITY, material=rng.integers(0, material, n))
