"""Axes of the contact law."""

from __future__ import annotations

import math

from grain_scenes import MASS, RADIUS, head_on
from trials import Axis, Finished, Measured, Trial

STIFFNESS = 1e6
STEPS = 400  # in half a period of a pair


def apart(run: Finished) -> float:
    """Speed [m/s] at which two discs on the x axis part."""
    left, right = run.grains("vx")
    return right - left


def released(overlap: float) -> Trial:
    """Two discs at rest that overlap by a share of the radius."""
    omega = math.sqrt(2 * STIFFNESS / MASS)
    step = math.pi / omega / STEPS
    scene = head_on(
        speed=0.0, gap=-overlap * RADIUS, contact={"normal_stiffness": STIFFNESS}, step=step, duration=STEPS * step
    )

    def check(run: Finished) -> list[Measured]:
        full = overlap * RADIUS * omega
        # (omega dt)^2/8 = 8e-6, and where in its last step the contact ends; round-off of places near 0.01
        allowed = 1e-4 + 1e-15 / (overlap * RADIUS)
        return [Measured(what="speed over that of the energy", value=apart(run) / full, expected=1.0, allowed=allowed)]

    return Trial(scene=scene, check=check)


AXES = (
    Axis(
        part="Grains",
        name="Overlap over the radius",
        text="Two discs at rest are released from an overlap. Right: they part with the speed sqrt(k/m_eff) delta.",
        values=(1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.3, 0.49, 0.51, 0.9, 1.5, 1.999),
        trial=released,
        quick={1e-9: "right", 0.49: "right", 0.51: "refused"},
        sharpen=1.01,
    ),
)
