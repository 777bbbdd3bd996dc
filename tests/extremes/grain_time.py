"""Axes of the grains' time step."""

from __future__ import annotations

import numpy as np
from grain_scenes import MASS, RADIUS, discs
from trials import Axis, Finished, Measured, Trial

STIFFNESS = 1e6
OVERLAP = 0.01 * RADIUS  # of all contacts of the row
STEPS = 5000
ROUND_OFF = 1e-6  # of the largest displacement: places are some 1e9 round-offs of it


def pressed_row(share: float) -> Trial:
    """Three discs pressed between two fixed ones; the middle one is pushed."""
    matrix = STIFFNESS / MASS * (2 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1))
    omega2, modes = np.linalg.eigh(matrix)
    step = share * 2.0 / np.sqrt(omega2[-1])
    speed = 1e-4 * OVERLAP / step
    pitch = 2 * RADIUS - OVERLAP
    x = pitch * np.array([1.0, 2.0, 3.0])
    places = [[place, 0.0, speed if k == 1 else 0.0, 0.0] for k, place in enumerate(x)]
    ends = [{"start": [end, 0.0], "end": [end, 0.0], "count": 1, "radius": RADIUS} for end in (0.0, 4 * pitch)]
    contact = {"normal_stiffness": STIFFNESS}
    scene = discs(places, contact=contact, step=step, duration=STEPS * step, rows=ends)

    def check(run: Finished) -> list[Measured]:
        turn = np.arccos(1.0 - 0.5 * omega2 * step**2)  # of each mode in a step of the leapfrog
        moved = modes @ (modes[1] * speed * step * np.sin(STEPS * turn) / np.sin(turn))
        largest = speed * step / np.abs(np.sin(turn)).min()
        off = np.abs(run.grains("x") - x - moved).max()
        return [
            Measured(
                what="displacement off its closed form, of the largest",
                value=off / largest,
                expected=0.0,
                allowed=ROUND_OFF,
            )
        ]

    return Trial(scene=scene, check=check)


AXES = (
    Axis(
        part="Grains",
        name="Time step over the sharp limit",
        text="Three discs pressed between two fixed ones, the middle one pushed by 1e-4 of the overlap in a step, 5000 "
        "steps. Right: places against the leapfrog's own solution of the three modes.",
        values=(0.01, 0.1, 0.3, 0.7, 0.9, 0.99, 0.999, 1.001, 1.01, 1.1, 1.3, 1.8, 2.0, 3.0),
        trial=pressed_row,
        quick={0.01: "right", 0.99: "right", 1.01: "stopped", 3.0: "refused"},
        sharpen=1.02,
    ),
)
