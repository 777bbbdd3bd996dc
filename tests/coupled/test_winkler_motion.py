"""An elastic beam that moves on a row of fixed discs against an independent motion of the same cells."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from independent_beam import IndependentBeam
from independent_body import motion
from independent_contact import Discs, OnFacets, OnGluedDiscs
from small_models import on_row
from ways import INTERFACES, WAYS, Way, assert_order, relative

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
    standoff = RADIUS if interface == "glued" else 0.0
    discs = Discs(
        centres=np.column_stack([SPRINGS, np.full(len(SPRINGS), -RADIUS - standoff)]), radius=RADIUS, stiffness=K_N
    )
    if interface == "glued":
        contact = OnGluedDiscs(BEAM, discs, *BEAM.facet_of(SPRINGS), radius=RADIUS)
    else:
        contact = OnFacets(BEAM, discs, TOP)
    seen = []
    for step in (4e-6, 2e-6):
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


@pytest.mark.parametrize("case", list(CASES))
@pytest.mark.parametrize("way", WAYS, ids=str)
def test_beam_on_springs_moves_as_the_independent_one(way: Way, case: str) -> None:
    expected = independent(way.interface, case)
    errors = [relative(coupled(way, CASES[case], window), expected) for window in (2e-5, 1e-5, 5e-6)]
    assert_order(way, errors)
    assert errors[-1] < (0.03 if way.exchange == "lagged" else 2e-4)


def beneath_moving_load(
    ahead: np.ndarray, *, speed: float, bending: float, mass: float, dashpot: float, foundation: float
) -> np.ndarray:
    """Deflection (k,) at `ahead` [m] of a unit load that runs on an infinite beam on springs and dashpots.

    ``EI w_xxxx + m V^2 w_xx - c V w_x + k w = delta``, a Fourier integral closed around its poles.
    """
    quartic = np.array([bending, 0.0, -mass * speed**2, -1j * dashpot * speed, foundation])
    poles = np.roots(quartic)
    terms = 1j * np.exp(1j * np.outer(ahead, poles)) / np.polyval(np.polyder(quartic), poles)
    front = ahead[:, None] >= 0
    return np.real(np.sum(np.where(front == (poles.imag > 0), np.where(front, terms, -terms), 0.0), axis=1))


@pytest.mark.parametrize("interface", INTERFACES)
@pytest.mark.parametrize("share", [0.3, 0.6])  # of the critical speed, (4 k EI)^(1/4)/sqrt(m)
def test_moving_load_on_a_long_beam_is_that_of_an_infinite_one(interface: str, share: float) -> None:
    """Euler and Bernoulli on a Winkler foundation; seen halfway along a beam of 20 wave lengths over 2 pi.

    What the entry of the load leaves has decayed by exp(-4) and more there. The loaded beam is compared
    less the same beam held down without the moving load.
    """
    length, height, along, springs, dashpot = 2.0, 0.02, 80, 241, 1000.0
    density, bending = (springs - 1) / length, YOUNG / (1 - POISSON**2) * height**3 / 12
    foundation, mass, spacing = K_N * density, DENSITY * height, length / along
    speed = share * (4 * foundation * bending) ** 0.25 / np.sqrt(mass)
    arrivals = spacing / speed * np.arange(1, along + 2)
    even = {"kind": "boundary", "boundary": "top", "total_force": (0.0, -2e5), "schedule": wave(90.0)[0]}
    loads = [even]
    for node, arrival in enumerate(arrivals):
        times = [arrival - spacing / speed, arrival, arrival + spacing / speed]
        rows = {"kind": "table", "times": times, "factors": [0.0, 1.0, 0.0]}
        place = (node * spacing - length / 2, height / 2)
        loads.append({"kind": "point", "point": place, "force": (0.0, -1e3), "schedule": rows})
    faces, window = [], 1e-5
    for case in ([even], loads):
        model = on_row(
            Way(interface, "predicted"),
            window=window,
            structure=STRUCTURE
            | {"element": "enhanced", "loads": case}
            | {"beam": {"length": length, "height": height, "along": along, "across": 2}},
            contact={"normal_stiffness": K_N, "normal_damping": dashpot},
            rows=[np.linspace(0.0, length, springs)],
            radius=RADIUS,
        )
        model.advance(round(arrivals[along // 2] / window))
        faces.append(face(model, 0.0))
        assert (model.glued_force[:, 1] > 0).all()
    ahead = spacing * (np.arange(along + 1) + 1) - speed * model.time
    expected = -1e3 * beneath_moving_load(
        ahead, speed=speed, bending=bending, mass=mass, dashpot=density * dashpot, foundation=foundation
    )
    near = np.abs(ahead) < 0.3
    error = np.abs(faces[1] - faces[0] - expected)[near].max() / np.abs(expected).max()
    # Left out: shear and the inertia of turning, which lower the critical speed; 0.5 % at 0.3 of it, 3.4 % at 0.6.
    assert error < 0.13 * share**2
