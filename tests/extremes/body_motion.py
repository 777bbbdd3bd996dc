"""Axes of the structure's motion: time step, loads, turns, stretches, prescribed paths."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from body_scenes import DENSITY, HEIGHT, INERTIA, LENGTH, MASS, MODULUS, POISSON, bar, slender_frequency
from scipy.integrate import solve_ivp
from trials import Axis, Finished, Measured, Trial

PERIOD = 2 * math.pi / slender_frequency(
    length=LENGTH, height=HEIGHT, modulus=MODULUS, poisson=POISSON, density=DENSITY
)  # fmt: skip
STEPS = 400
THEORIES = ("linear", "corotational", "large_strain")


def stepped(theory: str, share: float) -> Trial:
    """A bar swings in its first mode with a step of that share of the period of a slender beam."""
    step = share * PERIOD
    scene = bar(
        step=step,
        duration=STEPS * step,
        beam={"order": 2} if theory == "large_strain" else None,
        theory=theory,
        initial={"mode": 1, "amplitude": 1e-6},
    )
    scene["output"]["history_interval"] = step

    def check(run: Finished) -> list[Measured]:
        kinetic, strain = run.history["structure_kinetic"], run.history["structure_strain"]
        # Newmark's angle per step follows from the first step: strain is cos^2 of it
        angle = math.acos(math.sqrt(min(1.0, strain[1] / strain[0])))
        if share > 0.2:
            angle = math.pi - angle  # more than a quarter turn per step
        expected = math.cos((len(strain) - 1) * angle) ** 2
        sum_off = abs((kinetic + strain) / strain[0] - 1.0).max()
        # angles add up over the steps: the first strain is known to some 1e-9
        known = 1e-9 / max(math.sin(2 * angle), 1e-6) * 2 * len(strain) + 1e-3
        energy = Measured(what="energy off that of the start", value=sum_off, expected=0.0, allowed=1e-5)
        if known > 0.1:
            return [energy]
        last = strain[-1] / strain[0]
        return [energy, Measured(what="strain energy in the last step", value=last, expected=expected, allowed=known)]

    return Trial(scene=scene, check=check)


def loaded(theory: str, force: float) -> Trial:
    """A resultant [N/m] on the upper face of a bar, for 100 steps of 1e-6 s."""
    time = 1e-4
    load = {"kind": "boundary", "boundary": "top", "total_force": [0.0, -force]}
    scene = bar(step=1e-6, duration=time, loads=[load], theory=theory)
    scene["output"]["history_interval"] = 1e-6

    def check(run: Finished) -> list[Measured]:
        fall = 0.5 * force / MASS * time**2
        return [
            Measured(
                what="way of the centroid [m]",
                value=-run.history["centroid_y"][-1],
                expected=fall,
                allowed=1e-6 * fall + 1e-15,
            ),
            Measured(
                what="error of the ledger over what was turned over",
                value=run.history["ledger_relative_error"][-1],
                expected=0.0,
                allowed=1e-6,
            ),
        ]

    return Trial(scene=scene, check=check)


def stretched(theory: str, pull: float) -> Trial:
    """A pull on both ends over E, put on within 0.1 ms and held for 2 ms, with the damping of a quick rest."""
    ends = [
        {
            "kind": "pressure",
            "boundary": side,
            "pressure": -pull * MODULUS,
            "schedule": {"kind": "ramp", "over": 1e-4},
        }
        for side in ("left", "right")
    ]
    scene = bar(
        step=1e-6,
        duration=2e-3,
        beam={"order": 2} if theory == "large_strain" else None,
        loads=ends,
        theory=theory,
        rayleigh={"mass_factor": 2e4},
    )
    scene["output"]["history_interval"] = 1e-5

    def check(run: Finished) -> list[Measured]:
        first = pull * (1.0 - POISSON**2)  # of small strain; sigma_yy = 0 in plane strain
        if theory == "large_strain":
            expected = math.log(stretch_of(pull))
        else:
            expected = first
        return [
            Measured(
                what="largest strain",
                value=run.history["max_strain"][-1],
                expected=abs(expected),
                allowed=0.02 * abs(expected) + 1e-15,
            )
        ]

    return Trial(scene=scene, check=check)


def stretch_of(pull: float) -> float:
    """Stretch of a St Venant-Kirchhoff bar, free sideways, whose ends are pulled by `pull` E per first area.

    ``S = E/(1 - nu^2) (s^2 - 1)/2`` along the bar in plane strain, and the force per first area is s S.
    """
    low, high = 1.0 / math.sqrt(3.0), 100.0  # s S has its minimum there
    for _ in range(200):
        middle = 0.5 * (low + high)
        force = middle * (middle**2 - 1.0) / (2.0 * (1.0 - POISSON**2))
        low, high = (middle, high) if force < pull else (low, middle)
    return 0.5 * (low + high)


def turned(theory: str, turns: float) -> Trial:
    """A couple of four steps, then free rotation by about so many turns [-] in 2000 steps.

    The bar is 1e4 times as stiff as others here, so that it stays straight, and the couple short, as its forces keep
    their direction. One of 7e10 Pa that is given 100 turns within 40 steps bends by 0.26 rad, is stretched by 10 % and
    takes up another spin: it ends at 197.0 rad (corotational; 195.0 large-strain) for a whole, a fourth and a sixteenth
    of the step alike, a rigid one at 182.1.
    """
    step, steps, kick = 1e-5, 2000, 4
    rate = 2 * math.pi * turns / ((steps - 0.5 * kick) * step)
    force = rate * INERTIA / (kick * step * LENGTH)
    schedule = {"kind": "table", "times": [0.0, 0.5 * kick * step, kick * step], "factors": [0.0, 2.0, 0.0]}
    loads = [
        {"kind": "point", "point": [x, 0.0], "force": [0.0, math.copysign(force, x)], "schedule": schedule}
        for x in (-0.5 * LENGTH, 0.5 * LENGTH)
    ]
    beam = {"order": 2} if theory == "large_strain" else None
    scene = bar(
        step=step, duration=steps * step, loads=loads, theory=theory, beam=beam, youngs_modulus=1e4 * MODULUS
    )  # fmt: skip
    scene["output"]["history_interval"] = 10 * step

    def check(run: Finished) -> list[Measured]:
        spun = run.history["rotation"][-1]
        expected = _rigid_turn(force * LENGTH, 0.5 * kick * step, steps * step)
        if theory == "linear":
            spun = math.tan(spun)  # what grows with the time is that
        # The step lags behind by (angle per step)^2/12, 1 % where it is refused, and as much within the couple
        return [Measured(what="turn [rad]", value=spun, expected=expected, allowed=0.02 * expected)]

    return Trial(scene=scene, check=check)


def _rigid_turn(couple: float, top: float, end: float) -> float:
    """Angle [rad] at `end` [s] of a rigid bar under two fixed forces whose couple is 0, 2 `couple`, 0 at 0, `top`, "
    "2 `top`."""

    def rate(time: float, state: np.ndarray) -> list[float]:
        return [state[1], couple * max(0.0, 2.0 - 2.0 * abs(time / top - 1.0)) * math.cos(state[0]) / INERTIA]

    driven = solve_ivp(rate, (0.0, 2.0 * top), [0.0, 0.0], rtol=1e-9, atol=1e-16, max_step=top / 20)
    angle, spin = driven.y[:, -1]
    return angle + spin * (end - 2.0 * top)


PATHS = {
    "beyond the duration": [[0.0, 0.0, 0.0], [1e3, 1.0, 0.0]],
    "ends before it": [[0.0, 0.0, 0.0], [1e-3, 0.0, -0.1]],
    "a jump of 1 m in 1 ns": [[0.0, 0.0, 0.0], [5e-3, 0.0, 0.0], [5.000001e-3, 1.0, 0.0]],
    "1e300 m": [[0.0, 0.0, 0.0], [1e-3, 1e300, 0.0]],
    "times that fall": [[0.0, 0.0, 0.0], [2e-3, 0.0, 0.0], [1e-3, 1.0, 0.0]],
    "two places at one time": [[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [1e-3, 1.0, 0.0]],
}


def led(name: str) -> Trial:
    """A prescribed path, 10 ms."""
    points, time = PATHS[name], 0.01
    scene = bar(step=1e-5, duration=time, kind="rigid", path={"points": points})
    for key in ("youngs_modulus", "poissons_ratio"):
        del scene["structure"][key]

    def check(run: Finished) -> list[Measured]:
        reached = points[-1][1] * min(1.0, time / points[-1][0])
        return [
            Measured(
                what="way along x [m]",
                value=run.history["centroid_x"][-1],
                expected=reached,
                allowed=1e-12 * abs(reached) + 1e-15,
            )
        ]

    return Trial(scene=scene, check=check)


def _each(
    make: Callable[[str, float], Trial],
    name: str,
    text: str,
    values: tuple[float, ...],
    quick: dict[str, dict[float, str]],
) -> tuple[Axis, ...]:
    """An axis for each theory."""
    return tuple(
        Axis(
            part="Structure",
            name=f"{name}, {theory.replace('_', '-')}",
            text=text,
            values=values,
            trial=lambda value, theory=theory: make(theory, value),
            quick=quick.get(theory, {}),
        )
        for theory in THEORIES
    )


AXES = (
    *_each(
        stepped,
        "Time step over the first period",
        "A bar swings in its first mode, 400 steps. Right: the energy stays, and the last step shows the strain that "
        "the "
        "angle of the first step leads to.",
        (1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e6),
        {"linear": {0.1: "right", 1e4: "refused"}, "corotational": {100.0: "right"}},
    ),
    *_each(
        loaded,
        "Load [N/m]",
        "A force on the upper face of a free bar for 0.1 ms. Right: the centroid goes half F/m t^2.",
        (0.0, 1e-9, 1.0, 1e6, 1e9, 1e12, 1e100, 1e200, 1e308),
        {"linear": {0.0: "right", 1e12: "stopped", 1e308: "refused"}, "large_strain": {1e12: "stopped"}},
    ),
    *_each(
        stretched,
        "Pull on both ends over E",
        "A pull that is put on within 0.1 ms and held for 2 ms. Right: the strain of the theory at rest, to 2 %.",
        (1e-9, 1e-6, 1e-3, 0.01, 0.1, 0.5, 1.0, 10.0, 1e3, 1e6),
        {"linear": {1e-6: "right", 1e3: "stopped"}, "large_strain": {10.0: "stopped"}},
    ),
    *_each(
        stretched,
        "Push on both ends over E",
        "The same, pushed: a bar of 1:10 buckles at 0.9 % of E.",
        (-1e-6, -1e-3, -5e-3, -0.1, -1.0, -10.0, -1e3, -1e6),
        {"corotational": {-1e-3: "right"}},
    ),
    *_each(
        turned,
        "Turns",
        "A couple of four steps, then free rotation, 2000 steps of 1e-5 s in all, of a bar of 7e14 Pa, which stays "
        "straight. Right: the turn of a rigid bar, to 2 %.",
        (1e-9, 1e-3, 0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 100.0, 130.0, 300.0, 1e3, 1e4),
        {
            "linear": {1e-9: "right", 0.5: "stopped"},
            "corotational": {0.5: "right"},
            "large_strain": {130.0: "stopped"},
        },
    ),
    Axis(
        part="Structure",
        name="Prescribed path",
        text="A rigid bar along way points, 10 ms. Right: it is where the path ends, or has got to.",
        values=tuple(PATHS),
        trial=led,
        quick={"beyond the duration": "right", "times that fall": "refused"},
    ),
)
