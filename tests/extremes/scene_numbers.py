"""Axes of units, and of every number of a scene."""

from __future__ import annotations

import copy
import functools
import math
from typing import Any

import numpy as np
from grain_scenes import DENSITY, RADIUS, discs
from trials import Axis, Finished, Measured, Trial

from coupled.build import build
from coupled.scene import Scene

STIFFNESS = 1e6
UNITS = {  # length, mass, time over those of SI
    "m, kg, s": (1.0, 1.0, 1.0),
    "mm, kg, s": (1e3, 1.0, 1.0),
    "km, kg, s": (1e-3, 1.0, 1.0),
    "m, g, s": (1.0, 1e3, 1.0),
    "m, kg, ms": (1.0, 1.0, 1e3),
    "um, mg, us": (1e6, 1e6, 1e6),
    "ly, Mt, h": (1e-16, 1e-9, 1 / 3600),
    "fm, u, as": (1e15, 6e26, 1e18),
}


def cluster(units: str) -> dict[str, Any]:
    """Six discs of three sizes that fall into a corner, with every law."""
    length, mass, time = UNITS[units]
    sizes = RADIUS * np.array([1.0, 1.5, 2.0, 1.0, 1.5, 2.0])
    rows = np.array([
        [0.021, 0.013, 0.1, 0.0, 1.0], [0.048, 0.016, -0.2, 0.1, 0.0], [0.028, 0.046, 0.0, -0.5, 0.0],
        [0.075, 0.030, -0.5, 0.0, -2.0], [0.065, 0.060, -0.2, -0.5, 0.0], [0.035, 0.090, 0.0, -1.0, 3.0],
    ])  # fmt: skip
    rows = rows * [length, length, length / time, length / time, 1 / time]
    force = mass / time**2  # per length, as springs are
    contact = {
        "normal_stiffness": 1e5 * force, "normal_damping": 5.0 * mass / time, "tangential_stiffness": 5e3 * force,
        "tangential_damping": 1.0 * mass / time, "friction": 0.4, "rolling_friction": 0.1,
    }  # fmt: skip
    scene = discs(rows, radii=sizes * length, contact=contact, step=2e-5 * time, duration=0.05 * time)
    scene["grains"]["density"] = DENSITY * mass / length**2
    scene["gravity"] = [0.0, -9.81 * length / time**2]
    scene["box"] = {"width": 0.2 * length, "height": 0.2 * length}
    return scene


@functools.cache
def in_si() -> np.ndarray:
    """Places (6, 2) [m] at the end, in SI."""
    scene = Scene.model_validate({"title": "in SI"} | cluster("m, kg, s"))
    model = build(scene).model
    model.advance(round(scene.time.duration / scene.time.step))
    grains = model.particles.grains
    order = np.argsort(grains.number)
    return grains.position[order]


def in_units(units: str) -> Trial:
    """The same motion in other units."""
    scene = cluster(units)

    def check(run: Finished) -> list[Measured]:
        places = np.column_stack([run.grains("x"), run.grains("y")]) / UNITS[units][0]
        off = float(np.abs(places - in_si()).max()) / RADIUS
        # round-off of 1e-16, times what 2500 steps and some ten contacts of discs make of it
        return [Measured(what="largest difference of places, of a radius", value=off, expected=0.0, allowed=1e-9)]

    return Trial(scene=scene, check=check)


KEYS = (
    "time.duration", "time.step", "gravity.1", "box.width", "box.height", "grains.density", "grains.sizes.0.radius",
    "grains.positions.0.0", "grains.positions.0.1", "grains.positions.0.2", "grains.positions.0.4",
    "contact.normal_stiffness", "contact.normal_damping", "contact.tangential_stiffness", "contact.tangential_damping",
    "contact.friction", "contact.rolling_friction", "damping.translational", "damping.rotational",
    "output.history_interval", "output.frames_per_second", "output.checkpoint_interval",
)  # fmt: skip
NUMBERS = (math.nan, math.inf, -math.inf, -1.0, 0.0, 5e-324, 1e-300, 1e-30, 1e30, 1e300, 1.7e308)


def with_number(case: str) -> Trial:
    """The cluster with one number of another size."""
    key, _, text = case.partition(" = ")
    scene = copy.deepcopy(cluster("m, kg, s")) | {"damping": {"translational": 0.1, "rotational": 0.1}}
    *tables, last = key.split(".")
    here: Any = scene
    for name in tables:
        here = here[int(name) if isinstance(here, list) else name]
    here[int(last) if isinstance(here, list) else last] = float(text)

    def check(run: Finished) -> list[Measured]:
        error, residual = run.summary["ledger_relative_error"], run.summary["momentum_residual_max"]
        return [
            # 2e-5 s is a tenth of a contact's period: some 1 % of the energy turned over
            Measured(what="error of the ledger", value=error, expected=0.0, allowed=0.05),
            Measured(what="residual of momentum", value=residual, expected=0.0, allowed=1e-9),
        ]

    return Trial(scene=scene, check=check)


AXES = (
    Axis(
        part="Grains",
        name="Units",
        text="Six discs of three sizes fall into a corner, with friction, rolling friction and dashpots, in units of "
        "length, mass and time as named. Right: the motion of SI.",
        values=tuple(UNITS),
        trial=in_units,
        quick={"mm, kg, s": "right", "fm, u, as": "right"},
    ),
    Axis(
        part="Grains",
        name="A number of the scene",
        text="The same discs in SI, one number changed. Right: energy ledger and momentum.",
        values=tuple(f"{key} = {number:g}" for key in KEYS for number in NUMBERS),
        trial=with_number,
        quick={
            "contact.friction = nan": "refused",
            "gravity.1 = inf": "refused",
            "grains.density = 1e+300": "refused",
        },
    ),
)
