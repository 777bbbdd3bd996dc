"""Axes of sizes, numbers and places of grains."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from grain_scenes import DENSITY, MASS, RADIUS, discs
from trials import Axis, Finished, Measured, Trial

STIFFNESS = 1e6
STEPS = 400  # in half a period of a pair


def unequal(ratio: float) -> Trial:
    """A disc of radius 0.01 m meets one `ratio` times as large that is at rest."""
    heavy = MASS * ratio**2
    omega = math.sqrt(STIFFNESS * (1 / MASS + 1 / heavy))
    step, speed = math.pi / omega / STEPS, 0.05 * RADIUS * omega
    gap = 10 * speed * step
    rows = [[-RADIUS - gap, 0.0, speed, 0.0], [ratio * RADIUS, 0.0, 0.0, 0.0]]
    contact = {"normal_stiffness": STIFFNESS}
    scene = discs(rows, radii=[RADIUS, ratio * RADIUS], contact=contact, step=step, duration=(STEPS + 20) * step)

    def check(run: Finished) -> list[Measured]:
        light_speed, heavy_speed = run.grains("vx")
        # (omega dt)^2/8 = 8e-6 and the last step; overlaps of 5e-4 from places near ratio times 0.01
        allowed = 1e-4 + 1e-15 * ratio
        expected = (MASS - heavy) / (MASS + heavy)
        given = heavy_speed * heavy / MASS / speed
        return [
            Measured(what="speed of the small one", value=light_speed / speed, expected=expected, allowed=allowed),
            Measured(what="momentum of the large one", value=given, expected=1.0 - expected, allowed=allowed),
        ]

    return Trial(scene=scene, check=check)


def stacked(ratio: float) -> Trial:
    """A disc `ratio` times as large stands on one of 0.01 m, on a fixed one, in equilibrium but for a push."""
    gravity, heavy = 9.81, MASS * ratio**2
    stiffness = (heavy + MASS) * gravity / (0.01 * RADIUS)
    low = 2 * RADIUS - 0.01 * RADIUS
    high = low + RADIUS + ratio * RADIUS - heavy * gravity / stiffness
    omega2, modes = np.linalg.eig(stiffness * np.array([[2 / MASS, -1 / MASS], [-1 / heavy, 1 / heavy]]))
    step, steps = 0.1 / math.sqrt(omega2.max()), 2000
    push = np.array([1e-6 * RADIUS * math.sqrt(omega2.max()), 0.0])
    scene = discs(
        [[0.0, low, 0.0, push[0]], [0.0, high, 0.0, 0.0]],
        radii=[RADIUS, ratio * RADIUS],
        contact={"normal_stiffness": stiffness},
        step=step,
        duration=steps * step,
        rows=[{"start": [0.0, 0.0], "end": [0.0, 0.0], "count": 1, "radius": RADIUS}],
        gravity=[0.0, -gravity],
    )

    def check(run: Finished) -> list[Measured]:
        turn = np.arccos(1.0 - 0.5 * omega2 * step**2)  # of each mode in a step of the leapfrog
        moved = modes @ (np.linalg.solve(modes, push) * step * np.sin(steps * turn) / np.sin(turn))
        off = np.abs(run.grains("y") - [low, high] - moved) / (0.01 * RADIUS)
        # round-off of places near `high`, over the overlap, times the steps it may add up in
        allowed = 1e-9 + 1e-16 * high / (0.01 * RADIUS) * steps
        return [Measured(what="places off, of the overlap", value=float(off.max()), expected=0.0, allowed=allowed)]

    return Trial(scene=scene, check=check)


def many(count: int) -> Trial:
    """Grains on a lattice fall freely."""
    columns = math.ceil(math.sqrt(count))
    pitch = 2 * RADIUS * 1.2
    step, steps, gravity = 1e-5, 20, 9.81
    scene: dict[str, Any] = {
        "gravity": [0.0, -gravity],
        "time": {"duration": steps * step, "step": step},
        "box": {"width": columns * pitch, "height": columns * pitch},
        "grains": {"sizes": [{"radius": RADIUS, "count": count}], "density": DENSITY, "spacing": 1.2},
        "contact": {"normal_stiffness": STIFFNESS},
        "output": {"history_interval": steps * step},
    }

    def check(run: Finished) -> list[Measured]:
        fallen = run.history["grains_gravity"]
        expected = -0.5 * count * MASS * (gravity * steps * step) ** 2
        value = float(fallen[-1] - fallen[0])
        # a difference of sums over all grains
        allowed = 1e-12 * count * MASS * gravity * columns * pitch
        return [Measured(what="change of potential energy [J/m]", value=value, expected=expected, allowed=allowed)]

    return Trial(scene=scene, check=check, limit=300.0)


def far_apart(distance: float) -> Trial:
    """Two discs of 1 mm fly apart from places at a distance; one rebounds from a wall on its way."""
    radius, speed = 1e-3, 1.0
    mass = math.pi * radius**2 * DENSITY
    omega = math.sqrt(STIFFNESS / mass)
    step = math.pi / omega / STEPS
    gap = 10 * speed * step
    rows = [[radius + gap, radius, -speed, 0.0], [distance - 2 * radius, radius, 0.0, 0.0]]
    box = {"width": distance, "height": 1.0, "walls": ["left", "right"]}
    contact = {"normal_stiffness": STIFFNESS}
    scene = discs(rows, radii=radius, contact=contact, step=step, duration=(STEPS + 20) * step, box=box)

    def check(run: Finished) -> list[Measured]:
        value = float(run.grains("vx")[0])
        return [Measured(what="speed of rebound [m/s]", value=value, expected=speed, allowed=1e-4)]

    return Trial(scene=scene, check=check)


def thin_box(slenderness: float) -> Trial:
    """Discs of 0.01 m in a box as narrow as they are and very high."""
    height = 2 * RADIUS * slenderness
    step, duration, gravity = 1e-5, 0.01, 9.81
    count = 10
    scene: dict[str, Any] = {
        "gravity": [0.0, -gravity],
        "time": {"duration": duration, "step": step},
        "box": {"width": 2 * RADIUS * 1.5, "height": height, "walls": ["left", "right", "floor", "lid"]},
        "grains": {"sizes": [{"radius": RADIUS, "count": count}], "density": DENSITY, "spacing": 1.5},
        "contact": {"normal_stiffness": STIFFNESS},
        "output": {"history_interval": duration},
    }

    def check(run: Finished) -> list[Measured]:
        speed = run.grains("vy")
        expected = -gravity * (duration + 0.5 * step)
        return [Measured(what="speed [m/s]", value=float(speed.mean()), expected=expected, allowed=1e-12)]

    return Trial(scene=scene, check=check)


AXES = (
    Axis(
        part="Grains",
        name="Ratio of sizes",
        text="A disc meets a larger one at rest, of the same density: masses in the square of the ratio. Right: speeds "
        "of an elastic impact.",
        values=(1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6),
        trial=unequal,
        quick={1e3: "right"},
    ),
    Axis(
        part="Grains",
        name="Large on small",
        text="A disc stands on a smaller one, which is pushed; their weight overlaps 1 % of its radius. Right: places "
        "against the leapfrog's own solution of both modes.",
        values=(1.0, 10.0, 100.0, 1e3, 1e4),
        trial=stacked,
        quick={1e3: "right"},
    ),
    Axis(
        part="Grains",
        name="Number of grains",
        text="A lattice falls freely for 20 steps. Right: change of its potential energy. The last needs terabytes.",
        values=(1, 2, 1000, 1_000_000, 10**12),
        trial=many,
        quick={1: "right", 2: "right"},
        show=str,
    ),
    Axis(
        part="Grains",
        name="Width of a box of two grains of 1 mm [m]",
        text="One of them rebounds from a wall, the other rests far away. Right: speed of rebound, with little memory.",
        values=(1.0, 1e3, 1e6, 1e12, 1e30, 1e100, 1e200, 1e300),
        trial=far_apart,
        quick={1e3: "right"},
    ),
    Axis(
        part="Grains",
        name="Height over width of a box",
        text="Ten discs fall in a shaft with a lid. Right: their speed.",
        values=(20.0, 1e3, 1e6, 1e9, 1e12),
        trial=thin_box,
    ),
)
