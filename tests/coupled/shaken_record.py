"""Folders of shaken runs made by hand: an intruder that rises as told among grains that go round in two rolls."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from coupled.output.frames import Frames
from coupled.output.history import History

WIDTH, HEIGHT = 8.0, 4.0
PERIOD, START, AMPLITUDE = 4.0, 6.0, 0.5
ROWS = 20  # of the history in a period
FINE = 24  # grains up a roll
RADIUS = 0.07

SCENE = """
title = "Made by hand"
units = "dimensionless"
gravity = [0.0, -1.0]
[time]
duration = {duration}
step = 0.01
[box]
width = 8.0
height = 20.0
walls = ["floor"]
periodic = ["x"]
[grains]
sizes = [{{ radius = {radius}, count = {count} }}]
density = 1.0
seed = {seed}
[[intruders]]
radius = 0.6
density = 1.0
[shaking]
amplitude = 0.5
period = 4.0
start = 6.0
"""


def stream_steps(place: np.ndarray) -> np.ndarray:
    """Steps per period of two rolls, stream function ``0.02 sin(2 pi x/8) sin(pi y/4)``."""
    a, b = 2.0 * math.pi / WIDTH, math.pi / HEIGHT
    x, y = place.T
    return 0.02 * np.column_stack([b * np.sin(a * x) * np.cos(b * y), -a * np.cos(a * x) * np.sin(b * y)])


def floor_at(time: np.ndarray) -> np.ndarray:
    turned = 2.0 * math.pi * (np.asarray(time) - START) / PERIOD
    return np.where(np.asarray(time) > START, AMPLITUDE * (1.0 - np.cos(turned)), 0.0)


def make(
    folder: Path,
    increments: np.ndarray,
    *,
    seed: int = 1,
    frames: int = 6,
    periods_per_frame: int = 2,
    swing: Callable[[np.ndarray], np.ndarray] = np.zeros_like,
) -> Path:
    """Write a run whose intruder goes up by `increments` (n,), one per period, on top of the floor's motion.

    `swing` is added, a height at times in periods since the shaking began.
    """
    folder.mkdir(parents=True)
    places = np.column_stack(
        [
            axis.ravel()
            for axis in np.meshgrid(*(s * (np.arange(k) + 0.5) / k for s, k in ((8.0, 2 * FINE), (4.0, FINE))))
        ]
    )
    count, duration = len(places), START + PERIOD * len(increments)
    (folder / "scene.toml").write_text(SCENE.format(duration=duration, radius=RADIUS, count=count, seed=seed))
    heights = 2.0 + np.concatenate([[0.0], np.cumsum(increments)])
    history = History(folder / "history.csv")
    time = np.arange(round(duration / PERIOD * ROWS) + 1) * PERIOD / ROWS
    level = np.interp(time, START + PERIOD * np.arange(len(heights)), heights) + swing((time - START) / PERIOD)
    for t, y, floor in zip(time, level, floor_at(time), strict=True):
        row = {"time [s]": t, "intruder_x [m]": 4.0, "intruder_y [m]": y + floor, "intruder_vx [m/s]": 0.0}
        history.write(row | {"intruder_vy [m/s]": 0.0, "floor_y [m]": floor})
    series = Frames(folder, "grains")
    middle, half = places, 0.5 * periods_per_frame * stream_steps(places)
    for k in range(frames):
        # forth and back about the same middles: with two frames the step between them is the flow
        moved = middle + (half if k % 2 else -half)
        points = np.vstack([moved, [[4.0, level[-1]]]])
        radius = np.append(np.full(count, RADIUS), 0.6)
        n = len(points)
        series.write(
            START + periods_per_frame * PERIOD * k,
            points,
            {
                "radius": radius, "velocity": np.zeros((n, 2)), "spin": np.zeros(n),
                "contacts": np.full(n, 4), "body": np.full(n, -1, np.int32), "overlap": np.zeros(n),
            },
        )  # fmt: skip
    return folder
