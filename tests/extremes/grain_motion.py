"""Axes of speed, gravity and places."""

from __future__ import annotations

import math

import numpy as np
from grain_scenes import MASS, RADIUS, discs
from trials import Axis, Finished, Measured, Trial

STIFFNESS = 1e6
OMEGA = math.sqrt(STIFFNESS / MASS)


def dropped(weights: float) -> Trial:
    """A disc falls from 0.05 m under a multiple of 9.81 m/s2 onto a floor of 1e9 N/m, below 1 in proportion."""
    gravity, height, stiffness = 9.81 * weights, 0.05, 1e9 * (min(weights, 1.0) or 1.0)
    omega = math.sqrt(stiffness / MASS)
    step = math.pi / omega / 200
    # up and down, and a contact that begins with v and bears the weight: omega t = 2 (pi - atan(omega v/g))
    speed = math.sqrt(2 * gravity * height)
    duration = 0.1
    if gravity > 0.0:
        duration = 2 * speed / gravity + 2 * (math.pi - math.atan(omega * speed / gravity)) / omega
    contact = {"normal_stiffness": stiffness}
    box = {"width": 1.0, "height": 1.0, "walls": ["floor"]}
    scene = discs([0.5, RADIUS + height], contact=contact, step=step, duration=duration, box=box)
    scene |= {"gravity": [0.0, -gravity]}

    def check(run: Finished) -> list[Measured]:
        value = float(run.grains("y")[0]) - RADIUS
        # energy: (omega dt)^2/8 = 3e-5 and the steps in which the contact begins and ends
        return [Measured(what="height after the rebound [m]", value=value, expected=height, allowed=1e-3 * height)]

    return Trial(scene=scene, check=check)


def flying(place: list[list[float]], radii: list[float], *, box: list[str] | None = None, post: bool = False):
    """Trials of discs [x, y, vx, vy] whose speeds are in radii per step; right is free flight."""

    def trial(share: float) -> Trial:
        step, steps = 0.1 / OMEGA, 50
        unit = share * RADIUS / step
        rows = np.array(place, float)
        rows[:, 2:] *= unit
        start = rows.copy()
        start[:, :2] -= 0.5 * steps * step * rows[:, 2:]  # they would be in place half way
        tables = {}
        if box is not None:
            tables["box"] = {"width": 1e6, "height": 1e6, "walls": box}
            start[:, :2] += 1e3
        if post:
            tables["rows"] = [{"start": [0.0, 0.0], "end": [0.0, 0.0], "count": 1, "radius": RADIUS}]
        scene = discs(
            start, radii=radii, contact={"normal_stiffness": STIFFNESS}, step=step, duration=steps * step, **tables
        )

        def check(run: Finished) -> list[Measured]:
            ends = start[:, :2] + steps * step * rows[:, 2:]
            moved = np.column_stack([run.grains("x"), run.grains("y")])
            off = float(np.abs(moved - ends).max()) / (steps * step * unit)
            return [Measured(what="way off that of free flight", value=off, expected=0.0, allowed=1e-9)]

        return Trial(scene=scene, check=check)

    return trial


def meeting(share: float) -> Trial:
    """Two discs meet head on, at a speed in radii per step."""
    step = 0.05 / OMEGA
    speed = share * RADIUS / step
    gap = 4.3 * speed * step
    half = RADIUS + 0.5 * gap
    rows = [[-half, 0.0, 0.5 * speed, 0.0], [half, 0.0, -0.5 * speed, 0.0]]
    steps = 100
    scene = discs(rows, contact={"normal_stiffness": STIFFNESS}, step=step, duration=steps * step)

    def check(run: Finished) -> list[Measured]:
        left, right = run.grains("vx")
        # (omega_pair dt)^2/8 = 6e-4, and where in a step the contact begins and ends: half a step of 45
        return [
            Measured(
                what="speed of parting over that of approach", value=(right - left) / speed, expected=1.0, allowed=0.01
            )
        ]

    return Trial(scene=scene, check=check)


def against(what: str):
    """Trials of a disc that flies at a thin post, a wall or a large disc, at a speed in radii per step."""

    def trial(share: float) -> Trial:
        step, steps = 0.05 / OMEGA, 150
        speed = share * RADIUS / step
        start = 4.3 * speed * step
        contact, tables, radii = {"normal_stiffness": STIFFNESS}, {}, [RADIUS]
        rows = [[-2 * RADIUS - start, 0.0, speed, 0.0]]
        if what == "post":
            tables["rows"] = [{"start": [0.0, 0.0], "end": [0.0, 0.0], "count": 1, "radius": RADIUS}]
        elif what == "wall":
            tables["box"] = {"width": 10 + 10 * start, "height": 1.0, "walls": ["left"]}
            rows = [[RADIUS + start, 0.5, -speed, 0.0]]
        else:
            rows, radii = [[-RADIUS - start, 0.0, speed, 0.0], [100 * RADIUS, 0.0, 0.0, 0.0]], [RADIUS, 100 * RADIUS]
        scene = discs(rows, radii=radii, contact=contact, step=step, duration=steps * step, **tables)

        def check(run: Finished) -> list[Measured]:
            value = -float(run.grains("vx")[0]) * (-1.0 if what == "wall" else 1.0) / speed
            expected = 1.0 if what != "large" else (1e4 - 1) / (1e4 + 1)
            # (omega dt)^2/8 = 3e-4, and where in a step the contact begins and ends: half a step of 63
            return [
                Measured(what="speed of rebound over that of approach", value=value, expected=expected, allowed=0.01)
            ]

        return Trial(scene=scene, check=check)

    return trial


def beside(distance: float) -> Trial:
    """Two discs whose centres are a distance apart, in radii."""
    rows = [[0.0, 0.0], [distance * RADIUS, 0.0]]
    rows = [[*row, 0.0, 0.0] for row in rows]
    omega = math.sqrt(2 * STIFFNESS / MASS)
    step = math.pi / omega / 400
    scene = discs(rows, contact={"normal_stiffness": STIFFNESS}, step=step, duration=400 * step)

    def check(run: Finished) -> list[Measured]:
        left, right = run.grains("vx")
        full = max(2.0 - distance, 0.0) * RADIUS * omega
        return [Measured(what="speed of parting [m/s]", value=right - left, expected=full, allowed=1e-4 * full)]

    return Trial(scene=scene, check=check)


def at_wall(height: float) -> Trial:
    """A disc whose centre is a height above the floor, in radii."""
    box = {"width": 1.0, "height": 1.0, "walls": ["floor"]}
    step = math.pi / OMEGA / 400
    scene = discs(
        [0.5, height * RADIUS, 0.0, 0.0],
        contact={"normal_stiffness": STIFFNESS},
        step=step,
        duration=400 * step,
        box=box,
    )

    def check(run: Finished) -> list[Measured]:
        full = max(1.0 - height, 0.0) * RADIUS * OMEGA
        return [Measured(what="speed [m/s]", value=float(run.grains("vy")[0]), expected=full, allowed=1e-4 * full)]

    return Trial(scene=scene, check=check)


SPEEDS = (1e-6, 1e-3, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1e4, 1e8)
AXES = (
    Axis(
        part="Grains",
        name="Gravity over 9.81 m/s2",
        text="A disc falls from 0.05 m onto a floor of 1e9 N/m (below one in proportion) and rises again. Right: its "
        "height one period later.",
        values=(0.0, 1e-12, 1e-6, 1e-3, 1.0, 10.0, 1e3, 1e4, 1e5, 1e6, 1e9),
        trial=dropped,
        quick={0.0: "right", 1e3: "right", 1e4: "right"},
    ),
    Axis(
        part="Grains",
        name="Speed of two discs that meet, in radii a step",
        text="Right: they part as fast as they met.",
        values=SPEEDS,
        trial=meeting,
        quick={0.01: "right", 100.0: "stopped"},
        sharpen=1.1,
    ),
    Axis(
        part="Grains",
        name="Speed of a disc against a fixed one, in radii a step",
        text="Right: it rebounds as fast as it came.",
        values=SPEEDS,
        trial=against("post"),
        quick={100.0: "stopped"},
        sharpen=1.1,
    ),
    Axis(
        part="Grains",
        name="Speed of a disc against a wall, in radii a step",
        text="Right: it rebounds as fast as it came.",
        values=SPEEDS,
        trial=against("wall"),
        quick={100.0: "stopped"},
        sharpen=1.1,
    ),
    Axis(
        part="Grains",
        name="Speed of a disc against one 100 times as large, in radii a step",
        text="Right: it rebounds as in an elastic impact.",
        values=SPEEDS,
        trial=against("large"),
        sharpen=1.1,
    ),
    Axis(
        part="Grains",
        name="Speed of discs that miss each other, in radii a step",
        text="Two discs pass at 2.01 radii. Right: free flight.",
        values=SPEEDS,
        trial=flying([[0.0, 0.0, 1.0, 0.0], [0.0, 2.01 * RADIUS, -1.0, 0.0]], [RADIUS, RADIUS]),
        quick={0.1: "right"},
    ),
    Axis(
        part="Grains",
        name="Distance of two centres, in radii",
        text="Two discs at rest. Right: they part with the speed of the energy of their overlap.",
        values=(0.0, 5e-324, 1e-300, 1e-170, 1e-100, 1e-20, 1e-3, 1.0, 1.99, 2.0, 2.01),
        trial=beside,
        quick={0.0: "refused", 1e-170: "refused"},
    ),
    Axis(
        part="Grains",
        name="Height of a centre above the floor, in radii",
        text="Right: free flight, or a refusal.",
        values=(-1e6, -1.0, 0.0, 0.5, 0.99, 1.0, 1.5),
        trial=at_wall,
        quick={0.0: "refused", 1.0: "right"},
    ),
)
