"""`make validate`: beams and rings on springs of discs, falls and blows, in every way to meet grains.

Writes `docs/validation/winkler.md` with a figure. What is compared with does not use our code: a
finite-element motion in numpy and scipy, and closed forms (`tests/coupled/independent_*.py`).
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes

sys.path.insert(0, str(Path(__file__).parents[1] / "coupled"))

import falling_beam
import pressed_beam
import pressed_ring
import running_load
from struck_beam import DISC_MASS, SPEED, Blow, first_mode, strike
from ways import INTERFACES, WAYS, Way, relative

DOCS = Path(__file__).parents[2] / "docs" / "validation"
WINDOWS = (2e-5, 1e-5, 5e-6)
SPEEDS = (0.15, 0.3, 0.45, 0.6, 0.7, 0.75)  # of the critical one
STIFFNESSES = np.geomspace(2e5, 1e8, 12)
MARKS = {"glued": "o", "facets": "x"}


@dataclass(frozen=True)
class Case:
    """A motion: what the coupled run shows with a step, and what the independent one does."""

    what: str
    seen: Callable[[Way, float], np.ndarray]
    reference: Callable[[str], np.ndarray]


def pressed(name: str, what: str) -> Case:
    return Case(
        what,
        lambda way, window: pressed_beam.coupled(way, pressed_beam.CASES[name], window),
        lambda interface: pressed_beam.independent(interface, name),
    )


def fall_of_the_same_cells(interface: str) -> np.ndarray:
    coarse, fine = (falling_beam.independent(interface, along=20, across=2, step=step).face for step in (4e-6, 2e-6))
    return fine + (fine - coarse) / 3


CASES = (
    pressed("pulsed", "beam under an even and a central pulse"),
    pressed("lifting", "the same under a central pulse alone: its ends lift off"),
    pressed("moving", "beam under a running load"),
    Case("ring pressed between two rows", pressed_ring.coupled, pressed_ring.independent),
    Case(
        "beam that falls on two rows and leaves",
        lambda way, window: falling_beam.coupled(way, window, along=20, element="standard").face,
        fall_of_the_same_cells,
    ),
)
Errors = dict[tuple[str, str], list[float]]


def errors() -> Errors:
    found = {}
    for case in CASES:
        for way in WAYS:
            reference = case.reference(way.interface)
            found[case.what, str(way)] = [relative(case.seen(way, window), reference) for window in WINDOWS]
    return found


def error_table(found: Errors) -> str:
    head = "| motion | way | H = 20 us | 10 us | 5 us | order |\n|---|---|---|---|---|---|"
    rows = []
    for (what, way), values in found.items():
        order = np.log2(values[-2] / values[-1])
        rows.append(f"| {what} | {way} | {' | '.join(f'{value:.1e}' for value in values)} | {order:.2f} |")
    return "\n".join([head, *rows])


def draw_errors(axes: Axes, found: Errors) -> None:
    for (what, way), values in found.items():
        if what == CASES[2].what:
            interface, _ = way.split("-", 1)
            axes.loglog(WINDOWS, values, marker=MARKS[interface], ls="-" if interface == "glued" else "--", label=way)
    axes.set(xlabel="step of the structure [s]", ylabel="error of the displacement [-]", title=CASES[2].what)
    axes.legend(fontsize=7)


def running(axes: Axes) -> str:
    """Deflection under the load over that of the same load at rest, against the speed."""
    at_rest = running_load.LOAD * (running_load.FOUNDATION / 4 / running_load.BENDING) ** 0.25 / 2
    scale, rows = -at_rest / running_load.FOUNDATION, []
    fine = np.linspace(0.02, 0.8, 100)
    closed = [running_load.expected(np.zeros(1), share * running_load.CRITICAL)[0] / scale for share in fine]
    axes.plot(fine, closed, "k-", label="infinite beam, with the dashpots")
    axes.plot(fine, 1 / np.sqrt(1 - fine**2), "k:", label="without")
    seen = {interface: [] for interface in INTERFACES}
    for share in SPEEDS:
        speed = share * running_load.CRITICAL
        for interface in INTERFACES:
            ahead, face = running_load.deflection(interface, speed, 1e-5)
            seen[interface].append(face[np.argmin(np.abs(ahead))] / scale)
        expected = running_load.expected(np.zeros(1), speed)[0] / scale
        rows.append(f"| {share:g} | {expected:.3f} | {' | '.join(f'{seen[name][-1]:.3f}' for name in INTERFACES)} |")
    for interface in INTERFACES:
        axes.plot(SPEEDS, seen[interface], MARKS[interface], label=interface)
    axes.set(xlabel="speed / critical speed", ylabel="deflection under the load / at rest", ylim=(0.9, 2.0))
    axes.legend(fontsize=7)
    head = (
        f"| speed over the critical one | infinite beam | {' | '.join(INTERFACES)} |\n|{'---|' * (2 + len(INTERFACES))}"
    )
    return "\n".join([head, *rows])


def blows(axes: Axes) -> str:
    """First mode over what the impulse predicts, against how long the blow lasts."""
    period = 2 * np.pi / first_mode()[0]
    fine = np.linspace(0.0, 1.45, 200)
    axes.plot(fine, np.abs(half_sine(fine)), "k-", label="half a sine")
    rows = []
    for interface in INTERFACES:
        found = [blow(interface, stiffness) for stiffness in STIFFNESSES]
        lasted = np.array([one.lasted / period for one in found])
        axes.plot(lasted, [one.amplitude / one.predicted for one in found], MARKS[interface], label=interface)
        rows += [
            f"| {interface} | {share:.3f} | {one.impulse / (2 * DISC_MASS * SPEED):.3f} | "
            f"{one.amplitude / one.predicted:.4f} | {abs(half_sine(share)):.4f} | {one.amplitude / one.by_pulse:.5f} |"
            for one, share in zip(found, lasted)
        ]
    axes.set(xlabel="duration of the blow / period", ylabel="first mode / by the impulse", ylim=(0.0, 1.05))
    axes.legend(fontsize=7)
    head = (
        "| interface | duration over period | impulse over 2 m v | mode, over impulse | half a sine | over Duhamel's |"
    )
    return "\n".join([head, "|---|---|---|---|---|---|", *rows])


def blow(interface: str, stiffness: float) -> Blow:
    """With steps of 1/100 of the blow and 1/400 of the period, whichever is less."""
    lasts, period = np.pi * np.sqrt(DISC_MASS / stiffness), 2 * np.pi / first_mode()[0]
    return strike(Way(interface, "predicted"), min(lasts / 100, period / 400), stiffness=stiffness)


def half_sine(share: np.ndarray) -> np.ndarray:
    """``cos(pi s)/(1 - 4 s^2)``, what half a sine that lasts s of the period excites of what its impulse would."""
    return np.pi / 4 * (np.sinc(share - 0.5) + np.sinc(share + 0.5))


def falls(axes: Axes) -> str:
    """Rebound and energy left in vibrations against the mesh, and the energies against time."""
    rows = [
        "| cells | interface | speed of the rebound over that of the fall | energy left in vibrations |",
        "|---|---|---|---|",
    ]
    for along, element in ((20, "standard"), (40, "standard"), (20, "enhanced"), (40, "enhanced")):
        for interface in INTERFACES:
            fall = falling_beam.coupled(Way(interface, "predicted"), 5e-6, along=along, element=element)
            rows.append(f"| {along} x 2 {element} | {interface} | {fall.rebound:.4f} | {fall.left:.4f} |")
    meshes = [falling_beam.independent("glued", along=along, across=along // 10, step=4e-6) for along in (80, 120)]
    ends = np.array([(fall.rebound, fall.left) for fall in meshes])
    limit = ends[1] + (ends[1] - ends[0]) / ((120 / 80) ** 2 - 1)
    rows.append(f"| independent, 120 x 12 | glued | {ends[1][0]:.4f} | {ends[1][1]:.4f} |")
    rows.append(f"| independent, limit of fine cells | glued | {limit[0]:.4f} | {limit[1]:.4f} |")
    time = 1e3 * falling_beam.EVERY * np.arange(1, len(fall.speed) + 1)
    moves = [one.speed**2 * np.sign(one.speed) for one in (fall, meshes[1])]
    for values, label in ((moves, "translation, with its sign"), ([one.strain for one in (fall, meshes[1])], "strain")):
        line = axes.plot(time, values[1], label=label)[0]
        axes.plot(time, values[0], MARKS[INTERFACES[-1]], color=line.get_color())
    axes.set(
        xlabel="time [ms]",
        ylabel="energy over that of the fall",
        title="falling beam; lines: 120 x 12 independent cells",
    )
    axes.legend(fontsize=7)
    return "\n".join(rows)


PAGE = """# Beams and rings on springs of discs

Written by `make validate`.

Fixed or moving discs below a structure are springs without tension. What is compared with is computed by other
programs: a plane-strain motion in numpy and scipy on the same cells, with the contact of each disc in the present
geometry, and closed forms. The default tests hold the same numbers to their orders
(`tests/coupled/test_winkler_*.py`, `test_falling_beam.py`, `test_struck_beam.py`), and the states at rest as well.

![winkler.png](winkler.png)

## Convergence in the step of the structure

Root mean square of the error of the displacement of a whole face over the whole motion, over that of the
displacement. "substeps" is the predicted exchange with four grain steps per step of the structure; "iterated-substeps"
is the iterated one with four.

{errors}

The fall begins with a jump of the speeds, which excites modes beyond these steps: its order is not reached yet.

## A load that runs along a beam

Deflection under the load over that of the same load at rest. Euler and Bernoulli's infinite beam on a continuous
foundation with the springs' stiffness and dashpots. It knows neither shear, which lowers the critical speed of the beam
of cells, nor what the load leaves when it begins, which has less time to decay the faster it comes.

{running}

## A beam falls on two short rows of discs

No damping anywhere: what is missing in the rebound vibrates in the beam.

{falls}

## A disc falls on a free beam

What the first mode takes, over what a blow of the same impulse without duration gives it (impulse times shape over
modal mass and frequency), over that of half a sine of the same duration, and over Duhamel's integral of the forces
as they came. The impulse predicts the mode within 1 % up to a duration of 0.1 periods, within 5 % up to 0.22.

{blows}
"""


@pytest.mark.validate
def test_family_on_springs() -> None:
    figure, axes = plt.subplots(2, 2, figsize=(11, 8), constrained_layout=True)
    found = errors()
    draw_errors(axes[0, 0], found)
    text = PAGE.format(
        errors=error_table(found), running=running(axes[0, 1]), falls=falls(axes[1, 0]), blows=blows(axes[1, 1])
    )
    figure.savefig(DOCS / "winkler.png", dpi=120)
    (DOCS / "winkler.md").write_text(text)
    assert all(values[-1] < 2e-4 for (_, way), values in found.items() if not way.endswith("lagged"))
