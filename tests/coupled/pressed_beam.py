"""An elastic beam pressed on a row of fixed discs: the coupled run, and an independent one of the same cells."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from independent_beam import IndependentBeam
from independent_body import motion
from independent_contact import row_below
from small_models import on_row
from ways import Way

from coupled.model import Model

LENGTH, HEIGHT, ALONG, ACROSS = 1.0, 0.05, 20, 2
YOUNG, POISSON, DENSITY, RADIUS, K_N = 70e9, 0.35, 2700.0, 4.1e-3, 1.97e7
SPRINGS = np.linspace(0.0, LENGTH, 121)
PER_FACET = 120 // ALONG
STRUCTURE = {
    "kind": "elastic",
    "youngs_modulus": YOUNG,
    "poissons_ratio": POISSON,
    "density": DENSITY,
    "element": "standard",
    "beam": {"length": LENGTH, "height": HEIGHT, "along": ALONG, "across": ACROSS},
}
BEAM = IndependentBeam(length=LENGTH, height=HEIGHT, along=ALONG, across=ACROSS, young=YOUNG, poisson=POISSON)
TOP = np.arange(ALONG + 1)


@dataclass(frozen=True)
class Case:
    """Loads of a scene, the same as nodal forces against time, how long to look and how often [s]."""

    loads: list[dict[str, object]]
    nodal: Callable[[float], np.ndarray]
    duration: float
    every: float


def wave(frequency: float) -> tuple[dict[str, object], Callable[[float], float]]:
    """``1 - cos``, as the schedule of a scene and as a function: it excites no mode far above its own."""
    schedule = {"kind": "sine", "frequency": frequency, "phase": -np.pi / 2, "offset": 1.0}
    return schedule, lambda time: 1.0 - np.cos(2 * np.pi * frequency * time)


def pulsed(total: float, force: float) -> Case:
    """Pressed evenly and in the middle [N/m]; without the first the ends lift off."""
    schedule, factor = wave(150.0)
    even = {"kind": "boundary", "boundary": "top", "total_force": (0.0, -total), "schedule": schedule}
    middle = {"kind": "point", "point": (0.0, HEIGHT / 2), "force": (0.0, -force), "schedule": schedule}
    full = BEAM.uniform(-total) + BEAM.on_top(ALONG // 2, -force)
    return Case([even, middle], lambda time: factor(time) * full, 4e-3, 1.6e-4)


def moving() -> Case:
    """A force spread over four cells as ``1 + cos``, which runs along a beam that is held down at 312.5 m/s."""
    total, force, spacing, speed, start = 6e4, 2e4, LENGTH / ALONG, 312.5, 1.6e-3
    schedule, factor = wave(150.0)
    loads = [{"kind": "boundary", "boundary": "top", "total_force": (0.0, -total), "schedule": schedule}]
    ahead = np.linspace(-2.0, 2.0, 65)  # in cells; rows 10 us apart
    shares = (1.0 + np.cos(np.pi * ahead / 2)) / 4
    for node in TOP:
        times = start + (node + ahead) * spacing / speed
        rows = {"kind": "table", "times": times.tolist(), "factors": shares.tolist()}
        place = (node * spacing - LENGTH / 2, HEIGHT / 2)
        loads.append({"kind": "point", "point": place, "force": (0.0, -force), "schedule": rows})

    def nodal(time: float) -> np.ndarray:
        share = np.interp((time - start) * speed / spacing - TOP, ahead, shares, left=0.0, right=0.0)
        return factor(time) * BEAM.uniform(-total) + BEAM.on_top(TOP, -force * share)

    return Case(loads, nodal, 4.8e-3, 1.6e-4)


CASES = {"pulsed": pulsed(6e4, 3e4), "lifting": pulsed(0.0, 3e4), "moving": moving()}


def face(model: Model, height: float) -> np.ndarray:
    """Vertical displacement [m] of the nodes of the face at `height` [m], from left to right."""
    x, y = model.structure.polyline.points.T
    nodes = np.nonzero(np.isclose(y, height))[0]
    return model.structure.boundary_displacement[nodes[np.argsort(x[nodes])], 1]


def coupled(way: Way, case: Case, window: float) -> np.ndarray:
    """Displacement (k, 21) [m] of the upper face every so often."""
    model = on_row(
        way,
        window=window,
        structure=STRUCTURE | {"loads": case.loads},
        contact={"normal_stiffness": K_N},
        rows=[SPRINGS],
        radius=RADIUS,
        per_facet=PER_FACET,
    )
    seen = []
    for _ in range(round(case.duration / case.every)):
        model.advance(round(case.every / window))
        seen.append(face(model, HEIGHT))
    return np.array(seen)


@functools.cache
def independent(interface: str, case: str) -> np.ndarray:
    """Displacement (k, 21) [m] of the upper face, its error of order 2 removed."""
    contact = row_below(BEAM, interface, SPRINGS, radius=RADIUS, stiffness=K_N)
    seen = []
    for step in (8e-6, 4e-6):
        moved = motion(
            BEAM,
            density=DENSITY,
            step=step,
            duration=CASES[case].duration,
            every=round(CASES[case].every / step),
            contact=contact,
            load=CASES[case].nodal,
        )
        seen.append(moved.displacement[:, 1::2][:, -len(TOP) :])
    return seen[1] + (seen[1] - seen[0]) / 3
