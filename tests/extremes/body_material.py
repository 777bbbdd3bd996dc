"""Axes of the structure's material: stiffness, density, Poisson's ratio, Rayleigh's factors, elements."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from body_scenes import DENSITY, INERTIA, LENGTH, MASS, POISSON, bar, slender_frequency
from trials import Axis, Finished, Measured, Trial

from coupled.report.locking import bending_stiffness_ratio
from coupled.scene.shape import Beam

GRAVITY, PUSH = 9.81, 10.0  # [m/s2], [N/m] at the end of the bar
STEP, STEPS = 5e-5, 500
FALL = 0.5 * GRAVITY * (STEP * STEPS) ** 2
ROUND_OFF = 1e-3  # of a fall or a turn, up to where a step is accepted


def falling(**structure: Any) -> Trial:
    """The bar falls, pushed at its end: both as Newton has it, whatever it is made of."""
    density = structure.get("density", DENSITY)
    push = PUSH * density / DENSITY
    loads = [
        {"kind": "body", "acceleration": [0.0, -GRAVITY]},
        {"kind": "point", "point": [0.5 * LENGTH, 0.0], "force": [0.0, push]},
    ]
    scene = bar(step=STEP, duration=STEP * STEPS, loads=loads, **structure)
    turn = 0.5 * PUSH * 0.5 * LENGTH / INERTIA * (STEP * STEPS) ** 2
    rise = 0.5 * PUSH / MASS * (STEP * STEPS) ** 2

    def check(run: Finished) -> list[Measured]:
        fallen, turned = -run.history["centroid_y"][-1], run.history["rotation"][-1]
        return [
            Measured(
                what="fall over that of a free body", value=fallen / (FALL - rise), expected=1.0, allowed=ROUND_OFF
            ),
            # The linear theory shows the arc tangent of an angle.
            Measured(
                what="turn over that of a free body",
                value=math.tan(turned) / turn,
                expected=1.0,
                allowed=10 * ROUND_OFF,
            ),
        ]

    return Trial(scene=scene, check=check)


def braked(factor: float) -> Trial:
    """Fall under Rayleigh's mass factor: ``m v' = m g - c m v``."""
    time = STEP * STEPS
    scene = bar(
        step=STEP,
        duration=time,
        loads=[{"kind": "body", "acceleration": [0.0, -GRAVITY]}],
        rayleigh={"mass_factor": factor},
    )
    wanted = GRAVITY / factor * (time + math.expm1(-factor * time) / factor) if factor * time > 1e-4 else FALL

    def check(run: Finished) -> list[Measured]:
        return [
            Measured(
                what="fall over that of a braked body",
                value=-run.history["centroid_y"][-1] / wanted,
                expected=1.0,
                allowed=2.0 / STEPS,  # of a fall at a constant rate: two steps, as long as the brake takes to act
            )
        ]

    return Trial(scene=scene, check=check)


def swinging(*, slenderness: float, poisson: float, cell: str, order: int, element: str) -> Trial:
    """A slender bar let go from its first mode: after an eighth of its period half of the strain energy is left."""
    shape = {"length": 1.0, "height": 1.0 / slenderness, "along": 100, "across": 1, "cell": cell, "order": order}
    omega = slender_frequency(length=1.0, height=1.0 / slenderness, modulus=1e9, poisson=poisson, density=1000.0)
    told = 1.0
    if element == "standard" and order == 1 and poisson <= 0.45:
        told = bending_stiffness_ratio(Beam(**shape), poisson)
    time = 0.25 * math.pi / (omega * math.sqrt(told))
    scene = bar(
        step=time / 200,
        duration=time,
        beam=shape,
        element=element,
        youngs_modulus=1e9,
        poissons_ratio=poisson,
        density=1000.0,
        initial={"mode": 1, "amplitude": 1e-3},
    )

    def check(run: Finished) -> list[Measured]:
        strain = run.history["structure_strain"]
        seen = math.acos(min(1.0, math.sqrt(strain[-1] / strain[0]))) / (0.25 * math.pi)
        # of elements that do not lock: shear of the beam and the mesh; of those that do: what is told of them
        allowed = 0.01 if told == 1.0 else 0.15
        return [Measured(what="frequency over the one told", value=seen, expected=1.0, allowed=allowed)]

    return Trial(scene=scene, check=check)


ELEMENTS: dict[str, tuple[str, int, str]] = {
    "enhanced quadrilaterals": ("quadrilateral", 1, "enhanced"),
    "standard quadrilaterals": ("quadrilateral", 1, "standard"),
    "quadrilaterals of order 2": ("quadrilateral", 2, "standard"),
    "triangles": ("triangle", 1, "standard"),
    "triangles of order 2": ("triangle", 2, "standard"),
}


def of_element(slenderness: float) -> Callable[[str], Trial]:
    def trial(name: str) -> Trial:
        cell, order, element = ELEMENTS[name]
        return swinging(slenderness=slenderness, poisson=POISSON, cell=cell, order=order, element=element)

    return trial


AXES = (
    Axis(
        part="Structure",
        name="Young's modulus [Pa] of a free bar",
        text="A bar falls, pushed at one end, steps of 5e-5 s. Right: fall and turn are those of a rigid body, to "
        "1e-3 and "
        "1e-2. What round-off would move is refused.",
        values=(1e6, 1e9, 1e12, 1e15, 1e18, 1e21, 1e30, 1e100, 1e300),
        trial=lambda modulus: falling(youngs_modulus=modulus),
        quick={1e12: "right", 1e21: "refused"},
        sharpen=1.5,
    ),
    Axis(
        part="Structure",
        name="Density [kg/m3] of a free bar",
        text="The same bar of 7e10 Pa. A light one has fast modes.",
        values=(1e-300, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e9, 1e15),
        trial=lambda density: falling(density=density),
        quick={1e-12: "refused", 1e9: "right"},
        sharpen=1.5,
    ),
    Axis(
        part="Structure",
        name="Poisson's ratio",
        text="A bar of 1:100, enhanced quadrilaterals, let go from its first mode. Right: its frequency is that of a "
        "slender "
        "beam with E/(1 - nu^2), to 1 %.",
        values=(-1.0, -0.99, -0.5, 0.0, 0.3, 0.45, 0.49, 0.499, 0.4999, 0.499999, 0.5, 0.6),
        trial=lambda nu: swinging(slenderness=100, poisson=nu, cell="quadrilateral", order=1, element="enhanced"),
        quick={0.4999: "right", 0.5: "refused"},
        show=lambda nu: f"{nu:g}" if abs(nu) < 0.49 else f"{nu:.6f}".rstrip("0"),
    ),
    *(
        Axis(
            part="Structure",
            name=f"Element of a bar of 1:{slenderness}",
            text="100 cells along, one across, let go from the first mode. Right: the frequency is that of a slender "
            "beam, to "
            "1 %; that of elements that lock is as much too high as is told before the run, to 15 %.",
            values=tuple(ELEMENTS),
            trial=of_element(slenderness),
            quick={"standard quadrilaterals": "right"} if slenderness == 1000 else {},
        )
        for slenderness in (100, 1000)
    ),
    Axis(
        part="Structure",
        name="Rayleigh's mass factor [1/s]",
        text="A falling bar, steps of 5e-5 s. Right: the fall of a braked body.",
        values=(0.0, 1e-6, 1.0, 1e3, 1e6, 1e9, 1e12, 1e15, 1e300),
        trial=braked,
        quick={1e6: "right"},
    ),
    Axis(
        part="Structure",
        name="Rayleigh's stiffness factor [s]",
        text="The bar falls, pushed at one end. Right: fall and turn are those of a rigid body, to 1e-3 and 1e-2.",
        values=(0.0, 1e-9, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e300),
        trial=lambda factor: falling(rayleigh={"stiffness_factor": factor}),
        quick={1e9: "refused"},
    ),
)
