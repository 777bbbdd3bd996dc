"""Axes of the contact law."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from grain_scenes import MASS, RADIUS, discs, head_on
from scipy.linalg import expm
from trials import Axis, Finished, Measured, Trial

from particles.contact.recipe import restitution_without_tension

STIFFNESS = 1e6
STEPS = 400  # in half a period of a pair
GRAVITY = 9.81
FLOOR = {"width": 10.0, "height": 1.0, "walls": ["floor"]}


def parting(run: Finished) -> float:
    """Speed [m/s] at which two discs on the x axis part."""
    left, right = run.grains("vx")
    return float(right - left)


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
        return [
            Measured(what="speed over that of the energy", value=parting(run) / full, expected=1.0, allowed=allowed)
        ]

    return Trial(scene=scene, check=check)


def rebound(restitution: float) -> Trial:
    """Two discs meet that are to part with a share of their speed."""
    omega = math.sqrt(2 * STIFFNESS / MASS)
    # without tension e is about 1/(4 zeta^2) where zeta is large: the contact ends after ln(4 zeta^2)/(zeta omega)
    sharper = max(1.0, 0.5 / math.sqrt(restitution)) if 0.0 < restitution < 1.0 else 1.0
    step, speed = 0.005 / omega / sharper, 0.01
    lasts = 2 * math.pi / omega * min(1.0, 2 * math.log(2 * sharper) / sharper if sharper > 2.0 else 1.0)
    contact = {"normal_stiffness": STIFFNESS, "restitution": restitution}
    scene = head_on(speed=speed, gap=10 * speed * step, contact=contact, step=step, duration=20 * step + lasts)

    def check(run: Finished) -> list[Measured]:
        value = parting(run) / speed / restitution
        # the dashpot sees a velocity late by half a step of 0.005: first order
        return [Measured(what="speed over the one asked for", value=value, expected=1.0, allowed=0.02)]

    return Trial(scene=scene, check=check)


def braked(share: float) -> Trial:
    """Two discs meet that have a dashpot c; the share is c dt over the effective mass."""
    omega = math.sqrt(2 * STIFFNESS / MASS)
    step, speed = 0.04 / omega, 0.01
    damping = share * 0.5 * MASS / step
    contact = {"normal_stiffness": STIFFNESS, "normal_damping": damping}
    scene = head_on(speed=speed, gap=4.5 * speed * step, contact=contact, step=step, duration=200 * step)

    def check(run: Finished) -> list[Measured]:
        expected = restitution_without_tension(0.5 * damping / math.sqrt(0.5 * MASS * STIFFNESS))
        # the dashpot's step is of first order
        return [Measured(what="restitution", value=parting(run) / speed, expected=expected, allowed=0.02 + 0.2 * share)]

    return Trial(scene=scene, check=check)


def on_floor(contact: dict[str, float], *, speed: float, spin: float, step: float, duration: float) -> dict:
    """A disc that moves along the floor; the impulse of its weight is the floor's, however it bounces."""
    scene = discs([5.0, RADIUS, speed, 0.0, spin], contact=contact, step=step, duration=duration, box=FLOOR)
    return scene | {"gravity": [0.0, -GRAVITY]}


def sliding(friction: float) -> Trial:
    """A disc starts to slide along the floor without spin."""
    speed, duration = 0.1, 0.05
    shear = 0.5 * STIFFNESS
    contact = {"normal_stiffness": STIFFNESS, "tangential_stiffness": shear, "friction": friction}
    contact |= {"tangential_damping": 2 * math.sqrt(shear * MASS / 3), "rolling_friction": 0.0}
    contact |= {"normal_damping": 2 * math.sqrt(STIFFNESS * MASS)}
    scene = on_floor(contact, speed=speed, spin=0.0, step=1e-5, duration=duration)

    def check(run: Finished) -> list[Measured]:
        expected = max(2 / 3 * speed, speed - friction * GRAVITY * duration)
        # rolling begins with a stretched spring: mu m g/k_t per time of its vibration at most, over v
        value = float(run.grains("vx")[0])
        return [Measured(what="speed [m/s]", value=value, expected=expected, allowed=1e-3 * speed)]

    return Trial(scene=scene, check=check)


def rubbed(share: float) -> Trial:
    """The same with friction of 0.1 and a tangential dashpot; the share is c_t dt over the mass m/3 of the contact."""
    trial = sliding(0.1)
    step = trial.scene["time"]["step"]
    contact = trial.scene["contact"] | {"tangential_damping": share * MASS / 3 / step}
    return replace(trial, scene=trial.scene | {"contact": contact})


def rolling(friction: float) -> Trial:
    """A disc rolls along the floor with rolling friction and much friction."""
    speed, duration, shear = 0.1, 0.05, 0.05 * STIFFNESS
    spring = shear * RADIUS**2
    contact = {"normal_stiffness": STIFFNESS, "tangential_stiffness": shear, "friction": 1e3}
    contact |= {"rolling_friction": friction, "normal_damping": 2 * math.sqrt(STIFFNESS * MASS)}
    scene = on_floor(contact, speed=speed, spin=-speed / RADIUS, step=1e-5, duration=duration)
    # x and r theta, a disc on two springs: theta'' = 2 r F/m + M/I
    by_shear = shear / MASS * np.array([[1.0, 1.0], [2.0, 2.0]])
    matrix = np.zeros((4, 4))
    matrix[:2, 2:] = np.eye(2)
    matrix[2:, :2] = -by_shear - np.diag([0.0, 2 * spring / MASS / RADIUS**2])
    elastic = float((expm(matrix * duration) @ [0.0, 0.0, speed, -speed])[0])
    moment = friction * RADIUS * MASS * GRAVITY
    swing = speed / math.sqrt(spring / (1.5 * MASS * RADIUS**2))  # largest way, were there no limit
    slows = 2 / 3 * friction * GRAVITY

    def check(run: Finished) -> list[Measured]:
        way = float(run.grains("x")[0]) - 5.0
        if moment > 2 * spring * swing / RADIUS:
            # lever arms are shorter by half the overlap, 3e-6 m of 0.01 m, in both springs and over many periods
            return [Measured(what="way against the springs' [m]", value=way, expected=elastic, allowed=0.02 * swing)]
        rolls = min(duration, speed / slows) if slows else duration
        plastic = speed * rolls - 0.5 * slows * rolls**2
        given = 2 * moment * RADIUS / spring + 1e-4 * speed * duration  # of the spring until its limit, and back
        return [Measured(what="way [m]", value=way, expected=plastic, allowed=given)]

    return Trial(scene=scene, check=check)


def stiff(stiffness: float) -> Trial:
    """Two discs meet at 1 m/s."""
    omega = math.sqrt(2 * stiffness / MASS)
    step = math.pi / omega / STEPS
    contact = {"normal_stiffness": stiffness}
    scene = head_on(speed=1.0, gap=10 * step, contact=contact, step=step, duration=(STEPS + 20) * step)

    def check(run: Finished) -> list[Measured]:
        # (omega dt)^2/8 = 8e-6 and the last step; overlaps of v/omega from places near 0.01
        allowed = 1e-4 + 1e-15 * omega
        return [Measured(what="speed of parting [m/s]", value=parting(run), expected=1.0, allowed=allowed)]

    return Trial(scene=scene, check=check)


def dragged(share: float) -> Trial:
    """A disc flies through the global damping; the share is alpha dt."""
    step, speed, steps = 1e-4, 1.0, 30
    scene = discs([0.0, 0.0, speed, 0.0], contact={"normal_stiffness": 1e3}, step=step, duration=steps * step)
    scene |= {"damping": {"translational": share / step}}

    def check(run: Finished) -> list[Measured]:
        rate = share / step
        expected = -speed / rate * math.expm1(-rate * steps * step)
        # of first order: a step takes 1 - a of a velocity for exp(-a)
        return [
            Measured(
                what="way [m]", value=float(run.grains("x")[0]), expected=expected, allowed=expected * (share + 1e-9)
            )
        ]

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
    Axis(
        part="Grains",
        name="Restitution",
        text="Two discs meet, with the dashpot that the restitution asks for. Right: the speed at which they part.",
        values=(-0.1, 0.0, 1e-300, 1e-13, 1e-9, 1e-6, 1e-4, 1e-2, 0.1, 0.5, 0.9, 0.999999, 1.0, 1.000001),
        trial=rebound,
        show=str,
    ),
    Axis(
        part="Grains",
        name="Dashpot times step over mass",
        text="Two discs meet, 157 steps a period of their spring. Right: the rebound of spring and dashpot in "
        "continuous time.",
        values=(1e-6, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.9, 1.1, 1.5, 1.9, 2.1, 10.0, 1e3, 1e6, 1e12),
        trial=braked,
        quick={0.1: "right", 10.0: "refused"},
        sharpen=1.05,
    ),
    Axis(
        part="Grains",
        name="Global damping times step",
        text="A disc flies through the global damping for 30 steps. Right: its way, to the first order of the step.",
        values=(1e-9, 1e-3, 0.1, 0.5, 0.99, 1.0, 1.5, 2.5, 1e6),
        trial=dragged,
        sharpen=1.05,
    ),
    Axis(
        part="Grains",
        name="Friction",
        text="A disc starts to slide along the floor. Right: it slows by mu g until it rolls, at 2/3 of its speed.",
        values=(0.0, 1e-9, 1e-3, 0.01, 0.1, 1.0, 1e3, 1e6, 1e12, 1e300),
        trial=sliding,
        quick={0.0: "right", 0.1: "right", 1e6: "right"},
    ),
    Axis(
        part="Grains",
        name="Tangential dashpot times step over mass",
        text="The same disc with friction of 0.1, which limits the dashpot. Right: two thirds of its speed.",
        values=(1e-3, 0.1, 0.5, 1.0, 2.0, 10.0, 1e3, 1e6, 1e12),
        trial=rubbed,
    ),
    Axis(
        part="Grains",
        name="Rolling friction",
        text="A disc rolls along the floor. Right: it slows by 2/3 mu_r g, or swings on the springs of the contact "
        "where they never reach the limit.",
        values=(0.0, 1e-6, 1e-3, 0.01, 0.1, 0.3, 10.0, 1e3, 1e6, 1e300),
        trial=rolling,
        quick={0.0: "right", 0.1: "right", 1e3: "right"},
    ),
    Axis(
        part="Grains",
        name="Normal stiffness [N/m]",
        text="Two discs meet at 1 m/s, 400 steps a contact. Right: they part at 1 m/s. At 6283 N/m they overlap by "
        "half a radius.",
        values=tuple(10.0**k for k in range(2, 17, 2)),
        trial=stiff,
        quick={1e2: "stopped", 1e14: "right"},
        sharpen=1.01,
    ),
)
