"""A load that runs along a long beam on springs and dashpots: the coupled run, and an infinite beam in closed form."""

from __future__ import annotations

import numpy as np
from pressed_beam import DENSITY, K_N, POISSON, RADIUS, STRUCTURE, YOUNG, face, wave
from small_models import on_row
from ways import Way

LENGTH, HEIGHT, ALONG, SPRINGS, DASHPOT = 2.0, 0.02, 80, 241, 1000.0
SPACING, LOAD, HELD = LENGTH / ALONG, 1e3, 2e5
PER_LENGTH = (SPRINGS - 1) / LENGTH
FOUNDATION, MASS, BENDING = K_N * PER_LENGTH, DENSITY * HEIGHT, YOUNG / (1 - POISSON**2) * HEIGHT**3 / 12
CRITICAL = (4 * FOUNDATION * BENDING) ** 0.25 / np.sqrt(MASS)  # speed [m/s]


def beneath_moving_load(
    ahead: np.ndarray, *, speed: float, bending: float, mass: float, dashpot: float, foundation: float
) -> np.ndarray:
    """Deflection (k,) at `ahead` [m] of a unit load that runs on an infinite beam on springs and dashpots.

    ``EI w_xxxx + m V^2 w_xx - c V w_x + k w = delta``, a Fourier integral closed around its poles.
    """
    quartic = np.array([bending, 0.0, -mass * speed**2, -1j * dashpot * speed, foundation])
    poles = np.roots(quartic)
    terms = 1j * np.exp(1j * np.outer(ahead, poles)) / np.polyval(np.polyder(quartic), poles)
    front = ahead[:, None] >= 0
    return np.real(np.sum(np.where(front == (poles.imag > 0), np.where(front, terms, -terms), 0.0), axis=1))


def deflection(interface: str, speed: float, longest: float) -> tuple[np.ndarray, np.ndarray]:
    """Place ahead of the load (81,) [m] and deflection (81,) [m] when the load is on the middle node.

    `longest` [s] is the longest step. The load grows along the first quarter of the beam, which excites less. The beam is held down evenly, the most at that time; what it shows without the running load is taken off.
    """
    arrivals = SPACING / speed * np.arange(1, ALONG + 2)
    steps = int(np.ceil(arrivals[ALONG // 2] / longest))
    window = arrivals[ALONG // 2] / steps
    even = {
        "kind": "boundary",
        "boundary": "top",
        "total_force": (0.0, -HELD),
        "schedule": wave(0.5 / arrivals[ALONG // 2])[0],
    }
    running = []
    for node, arrival in enumerate(arrivals):
        times = [arrival - SPACING / speed, arrival, arrival + SPACING / speed]
        strength = 0.5 - 0.5 * np.cos(np.pi * min(node / (ALONG / 4), 1.0))
        rows = {"kind": "table", "times": times, "factors": [0.0, strength, 0.0]}
        place = (node * SPACING - LENGTH / 2, HEIGHT / 2)
        running.append({"kind": "point", "point": place, "force": (0.0, -LOAD), "schedule": rows})
    shape = {"length": LENGTH, "height": HEIGHT, "along": ALONG, "across": 2}
    faces = []
    for loads in ([even], [even, *running]):
        model = on_row(
            Way(interface, "predicted"),
            window=window,
            structure=STRUCTURE | {"element": "enhanced", "loads": loads, "beam": shape},
            contact={"normal_stiffness": K_N, "normal_damping": DASHPOT},
            rows=[np.linspace(0.0, LENGTH, SPRINGS)],
            radius=RADIUS,
        )
        model.advance(steps)
        faces.append(face(model, 0.0))
        assert (model.contact_force[:, 1] > 0).all()
    return SPACING * np.arange(1, ALONG + 2) - speed * model.time, faces[1] - faces[0]


def expected(ahead: np.ndarray, speed: float) -> np.ndarray:
    """The same (k,) [m] of an infinite beam."""
    return -LOAD * beneath_moving_load(
        ahead, speed=speed, bending=BENDING, mass=MASS, dashpot=PER_LENGTH * DASHPOT, foundation=FOUNDATION
    )
