"""Turning discs that strike a free beam and fly away: what all of it comes to, by hand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from small_models import BODIES, discs_on_free_beam

from coupled.balance import take_balance
from coupled.model import Model

DISCS = [[-0.07, 0.0145, 0.3, -1.0, 90.0], [0.03, 0.015, -0.2, -1.0, -60.0], [0.075, 0.016, -0.4, -1.0, 40.0]]
LASTS = 8e-3  # all discs are off again
CELL = np.array([[4, 2, 1, 2], [2, 4, 2, 1], [1, 2, 4, 2], [2, 1, 2, 4]]) / 36.0  # int N_a N_b of a unit square


def body_momenta(model: Model) -> np.ndarray:
    """Momentum and angular momentum about the origin of a mesh of equal rectangles, density 1000: ``int rho x x v``."""
    fields = model.structure.fields()
    corners = fields.cells[:, [0, 1, 2, 3]]
    place = (fields.points + fields.point_data["displacement"][:, :2])[corners]
    speed = fields.point_data["velocity"][:, :2][corners]
    first = fields.points[corners]
    area = np.ptp(first[..., 0], axis=1) * np.ptp(first[..., 1], axis=1)
    mass = 1000.0 * area[:, None, None] * CELL
    linear = np.einsum("cab,cbi->i", mass, speed)
    turning = np.einsum("cab,ca,cb->", mass, place[..., 0], speed[..., 1]) - np.einsum(
        "cab,ca,cb->", mass, place[..., 1], speed[..., 0]
    )
    return np.array([*linear, turning])


def disc_momenta(model: Model) -> np.ndarray:
    g = model.particles.grains
    own = slice(g.n_free)
    m, x, y, vx, vy = g.mass[own], g.x[own], g.y[own], g.vx[own], g.vy[own]
    return np.array([m @ vx, m @ vy, m @ (x * vy - y * vx) + g.inertia[own] @ g.omega[own]])


@dataclass(frozen=True)
class Collision:
    """What a collision came to: momenta over those of the discs at first, works over their energy."""

    drift: np.ndarray  # (3,)
    dropped: float  # angular impulse, by the model's own count
    residual: float  # interface residual
    worst_window: float
    work: float
    turned: float  # of the body [rad]


@cache
def collision(interface: tuple[tuple[str, Any], ...], body: str, step: float, friction: float = 0.5) -> Collision:
    """Send the discs onto a free beam; `step` [s] is that of the structure."""
    table = dict(interface)
    step = step / table.get("substeps", 1)
    model = discs_on_free_beam(
        DISCS, step=step, friction=friction, interface=table | {"largest_stiffness_ratio": 100.0}, body=BODIES[body]
    ).model
    before = disc_momenta(model) + body_momenta(model)
    model.advance(round(LASTS / model.window))
    assert model.particles.look().count == 0
    after = disc_momenta(model) + body_momenta(model)
    mass = model.particles.grains.mass[0]
    scale = 3 * mass * np.array([1.0, 1.0, 0.1])  # 1 m/s, 0.1 m of lever arm
    energy = 1.5 * mass
    sums, balance = model.exchanged, take_balance(model, model.particles.look(), None)
    return Collision(
        drift=(after - before) / scale,
        dropped=sums.moment_dropped / scale[2],
        residual=balance.interface_residual / energy,
        worst_window=sums.worst_window / energy,
        work=sums.work / energy,
        turned=model.structure.mean_rotation(),
    )
