"""`make validate`: the eight benchmark impacts of Chung and Ooi (2011) for discs, in full.

Writes `docs/validation/impacts.md` with two figures. Curves are closed forms or the reference solution
in continuous time of `tests/particles/impacts.py`, points are the code's.
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parents[1] / "particles"))

from impact_benchmarks import (
    ANVIL,
    AT_ANGLES,
    BOUNCES,
    ELASTIC_PAIRS,
    ELASTIC_PLANES,
    KINDS,
    SIDEWAYS,
    SPINNING,
    TWINS,
    UNEQUAL,
    Benchmark,
    Kind,
)
from impact_runs import compare, fall_time, force_curve
from impacts import Impact

Floats = NDArray[np.float64]
DOCS = Path(__file__).parents[2] / "docs" / "validation"
STEPS = 4000  # per undamped contact
STYLE = {"linear": ("--", "s", "linear"), "hertz": ("-", "o", "Hertz")}
GREY = {"color": "0.45", "lw": 1.0, "ls": ":"}


@dataclass(frozen=True, kw_only=True)
class Row:
    """One line of the table: the largest deviation over `points` impacts, and what is allowed."""

    number: int
    case: str
    law: str
    what: str
    points: int
    largest: float
    allowed: float


def label(benchmark: Benchmark) -> str:
    names = [benchmark.stuff.name] + ([benchmark.other.name] if benchmark.other else [])
    return " on ".join(names)


def elastic(axes: Axes, number: int, benchmarks: Sequence[Benchmark], over_time: bool) -> list[Row]:
    """Force against overlap or time, with the deepest overlap in closed form."""
    rows = []
    for k, benchmark in enumerate(benchmarks):
        for kind in KINDS:
            line, marker, law_name = STYLE[kind]
            impact = benchmark.impacts(kind)[0]
            law, speed = impact.springs, benchmark.speed
            deep, lasting = law.deepest(impact.mass, speed), law.duration(impact.mass, speed)
            time, overlap, force = force_curve(benchmark, kind, STEPS)
            end = time[-1] + overlap[-1] / speed
            found = np.array([overlap.max() / deep, end / lasting, force.max() / (law.k * deep**law.power)])
            rows.append(
                Row(
                    number=number, case=label(benchmark), law=law_name,
                    what="deepest overlap, contact time, largest force",
                    points=1, largest=float(np.abs(found - 1.0).max()), allowed=(np.pi / STEPS) ** 2,
                )
            )  # fmt: skip
            depth = deep * np.linspace(0.0, 1.0, 200)
            curve, x = law.k * depth**law.power, 1e6 * depth
            at, shown = overlap > 0.0, 1e6 * overlap
            if over_time:
                half = fall_time(law, impact.mass, speed, depth)
                x, curve = 1e6 * np.append(half, lasting - half[::-1]), np.append(curve, curve[::-1])
                shown = 1e6 * time
            axes.plot(x, 1e-3 * curve, line, color=f"C{k}", lw=1.2, label=f"{label(benchmark)}, {law_name}")
            places = np.nonzero(at)[0][:: STEPS // 16]
            axes.plot(shown[places], 1e-3 * force[places], marker, color=f"C{k}", mfc="none", ms=4.5)
    axes.set(xlabel="time since touching [$\\mu$s]" if over_time else "overlap [$\\mu$m]", ylabel="normal force [kN]")
    axes.legend(fontsize=7)
    return rows


def bounces(axes: Axes) -> list[Row]:
    """Restitution found, against what was asked for: planes, and pairs of one material with half the radius."""
    asked = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0])
    axes.axhline(0.0, **GREY)
    rows = []
    for k, (partner, may_pull) in enumerate((p, m) for p in (None, 0.00125) for m in (False, True)):
        for kind in KINDS:
            off: list[float] = []
            for benchmark in BOUNCES:
                found = []
                for e in asked:
                    case = replace(benchmark, other_radius=partner, restitution=float(e), may_pull=may_pull)
                    impacts = case.impacts(kind) * 4
                    found.append(compare(case, kind, impacts, STEPS)[1][:, 0] / case.speed)
                off.append(float(np.abs(np.array(found) - asked[:, None]).max()))
            where = ("plane" if partner is None else "pair") + (", may pull" if may_pull else "")
            rows.append(
                Row(
                    number=3, case=f"{' and '.join(b.stuff.name for b in BOUNCES)}, {where}", law=STYLE[kind][2],
                    what="restitution", points=len(asked) * len(BOUNCES), largest=max(off), allowed=np.pi / STEPS,
                )
            )  # fmt: skip
            shown = 1e4 * (np.array(found).mean(axis=1) - asked)
            marker = STYLE[kind][1] if partner is None else {"linear": "x", "hertz": "+"}[kind]  # pairs fall on planes
            style = {"color": f"C{k}", "mfc": "none", "ms": 6.0, "lw": 0.8}
            axes.plot(asked, shown, STYLE[kind][0], marker=marker, **style, label=f"{where}, {STYLE[kind][2]}")
    axes.set(xlabel="restitution asked for [-]", ylabel="(found - asked) x $10^4$ [-]")
    axes.legend(fontsize=7)
    return rows


Impacts = Callable[[Benchmark, Kind, Floats], list[Impact]]
Quantity = Callable[[Benchmark, Floats, Floats], Floats]


def sweep(
    axes: Axes, number: int, benchmarks: Sequence[Benchmark], places: Floats, impacts: Impacts, y: Quantity, what: str
) -> list[Row]:
    """Reference as a curve, the code as points at every fourth place."""
    rows = []
    for k, benchmark in enumerate(benchmarks):
        for kind in KINDS:
            line, marker, law_name = STYLE[kind]
            fine = np.array([impact.solve().numbers() for impact in impacts(benchmark, kind, places)])
            points = places[2::4]
            chosen = impacts(benchmark, kind, points)
            _, ours, off = compare(benchmark, kind, chosen, STEPS)
            axes.plot(
                places, y(benchmark, places, fine), line, color=f"C{k}", lw=1.2, label=f"{label(benchmark)}, {law_name}"
            )
            axes.plot(points, y(benchmark, points, ours), marker, color=f"C{k}", mfc="none", ms=4.5)
            rows.append(
                Row(
                    number=number, case=label(benchmark), law=law_name, what=what, points=len(points),
                    largest=float(off.max()), allowed=1.0 / STEPS,
                )
            )  # fmt: skip
    axes.legend(fontsize=7)
    return rows


ALL = "velocities and surface speeds after, over the surfaces' speed before"


def oblique(left: Axes, right: Axes) -> list[Row]:
    angles = np.linspace(2.0, 86.0, 57)
    rows = sweep(
        left, 4, AT_ANGLES, angles, lambda b, kind, a: b.at_angles(kind, np.radians(a)),
        lambda b, a, rows: -rows[:, 2] * b.radius / b.speed, ALL,
    )  # fmt: skip
    first, radian = AT_ANGLES[0], np.radians(angles)
    push = 2.0 * first.mu * (1.0 + first.restitution) * np.cos(radian)
    left.plot(angles, np.minimum(push, 2.0 / 3.0 * np.sin(radian)), **GREY, label="rigid discs")
    left.set(xlabel="angle of incidence [deg]", ylabel="spin after: $-r\\omega'/v$ [-]")
    left.legend(fontsize=7)
    steep = np.linspace(0.1, 12.0, 61)  # over mu v_n
    rows += sweep(
        right, 5, SIDEWAYS, steep, lambda b, kind, s: b.impacts(kind, u_t=s * b.mu * b.speed),
        lambda b, s, rows: (-rows[:, 1] + b.radius * rows[:, 2]) / (b.mu * b.speed), ALL,
    )  # fmt: skip
    right.plot(steep, np.maximum(steep - 6.0, 0.0), **GREY, label="rigid discs")
    right.set(
        xlabel="tangential over normal velocity before: $v_t/(\\mu v_n)$ [-]",
        ylabel="surface velocity after over $\\mu v_n$ [-]",
    )
    right.legend(fontsize=7)
    return rows


def spinning(six: Axes, seven: Axes, eight: Axes) -> list[Row]:
    spins = np.geomspace(0.2, 24.0, 61)
    first, twin = SPINNING[0], TWINS[0]
    push = first.mu * (1.0 + first.restitution) * first.speed / first.radius
    rows = sweep(
        six, 6, SPINNING, spins, lambda b, kind, w: b.impacts(kind, spin=w), lambda b, w, rows: rows[:, 1], ALL
    )
    six.plot(spins, np.minimum(push, spins / 3.0) * first.radius, **GREY, label="rigid discs")
    six.set(xlabel="spin before [rad/s]", ylabel="tangential velocity after [m/s]", xscale="log")
    rows += sweep(
        seven, 7, TWINS, spins, lambda b, kind, w: b.impacts(kind, spin=w, partner=w),
        lambda b, w, rows: rows[:, 2] / w, ALL,
    )  # fmt: skip
    slid = twin.mu * (1.0 + twin.restitution) * twin.speed / twin.radius
    seven.plot(spins, np.maximum(1.0 - slid / spins, 1.0 / 3.0), **GREY, label="rigid discs")
    seven.set(xlabel="spin of both before [rad/s]", ylabel="spin after over spin before [-]", xscale="log")
    rows += sweep(
        eight, 8, [ANVIL, UNEQUAL], spins, lambda b, kind, w: b.impacts(kind, spin=w),
        lambda b, w, rows: rows[:, 2] / w, ALL,
    )  # fmt: skip
    eight.plot(spins, np.maximum(1.0 - 2.0 * push / spins, 1.0 / 3.0), **GREY, label="rigid disc on a rigid plane")
    eight.set(
        xlabel="spin of the first before [rad/s]",
        ylabel="its spin after over before [-]",
        xscale="log",
        ylim=(-0.3, 1.5),
    )
    for axes in (six, seven, eight):
        axes.legend(fontsize=7, loc="upper left")
    return rows


def write_page(rows: Sequence[Row], pictures: Sequence[str]) -> None:
    """The page as computed."""
    cases = {
        1: ELASTIC_PAIRS, 2: ELASTIC_PLANES, 3: BOUNCES, 4: AT_ANGLES, 5: SIDEWAYS, 6: SPINNING, 7: TWINS,
        8: [ANVIL, UNEQUAL],
    }  # fmt: skip
    lines = [
        "# Impacts of two bodies: the benchmarks of Chung and Ooi (2011)",
        "",
        "Written by `make validate`. Y. C. Chung and J. Y. Ooi, Benchmark tests for verifying discrete element",
        "modelling codes at particle impact level, Granular Matter 13 (2011) 643, for discs: mass of the sphere,",
        "moment of inertia m r^2/2. Curves are closed forms (1 to 3) or the law solved in continuous time, from",
        f"event to event, by an integrator of order 8 (4 to 8); points are the code's with {STEPS} steps per",
        "contact. Hertz's springs follow from the materials; the linear ones are ours, as deep at the same speed",
        "and with the same ratio of tangential to normal stiffness. Ours as well: the pair in 3 (a partner of",
        "half the radius), equal spins in 7 (opposite ones roll on each other), the unequal pair in 8. Friction",
        "has no dashpot. Grey: rigid discs (the first body), which slide where tan(angle) is above 3 mu (1 + e)",
        "and else leave rolling.",
        "",
        "| test | bodies | E [Pa] | nu [-] | density [kg/m3] | r [m] | speed [m/s] | mu [-] | e [-] |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for number, benchmarks in cases.items():
        for b in benchmarks:
            stuffs = [b.stuff] if b.other_radius is None else [b.stuff, b.other or b.stuff]
            radii = [b.radius] if b.other_radius is None else [b.radius, b.other_radius]
            parts = [
                "; ".join(s.name for s in stuffs) + ("; rigid plane" if b.other_radius is None else ""),
                "; ".join(f"{s.modulus:.3g}" for s in stuffs), "; ".join(f"{s.poisson:g}" for s in stuffs),
                "; ".join(f"{s.density:g}" for s in stuffs), "; ".join(f"{r:g}" for r in radii),
                f"{b.speed:g}", f"{b.mu:g}", "0.1 to 1" if number == 3 else f"{b.restitution:g}",
            ]  # fmt: skip
            lines.append(f"| {number} | " + " | ".join(parts) + " |")
    lines += [
        "",
        "| test | bodies | law | what | impacts | largest deviation | allowed |",
        "|---|---|---|---|---|---|---|",
    ]
    lines += [
        f"| {r.number} | {r.case} | {r.law} | {r.what} | {r.points} | {r.largest:.1e} | {r.allowed:.1e} |" for r in rows
    ]
    lines += ["", *(f"![{name}]({name})" for name in pictures), ""]
    (DOCS / "impacts.md").write_text("\n".join(lines))


TITLES = (
    "1 elastic normal impact, identical pair", "2 elastic normal impact on a plane", "3 restitution, normal impact",
    "4 oblique impact, constant speed", "5 oblique impact, constant normal velocity", "6 spinning impact on a plane",
    "7 identical pair, spinning", "8 different pair, the first spinning",
)  # fmt: skip


@pytest.mark.validate
def test_benchmark_impacts() -> None:
    figures = [plt.subplots(2, 2, figsize=(10.0, 8.0), layout="constrained") for _ in range(2)]
    panels = [axes for _, four in figures for axes in four.ravel()]
    rows = elastic(panels[0], 1, ELASTIC_PAIRS, over_time=False) + elastic(panels[1], 2, ELASTIC_PLANES, over_time=True)
    rows += bounces(panels[2]) + oblique(panels[3], panels[4]) + spinning(*panels[5:])
    pictures = ["impacts_1_to_4.png", "impacts_5_to_8.png"]
    for axes, title in zip(panels, TITLES, strict=True):
        axes.set_title(title, fontsize=10)
        axes.grid(alpha=0.25)
    for (figure, _), name in zip(figures, pictures, strict=True):
        figure.savefig(DOCS / name, dpi=150)
        plt.close(figure)
    write_page(rows, pictures)
    # 1 and 2: order 2 in omega dt = pi/steps. 3: the dashpot half a step late, at most its force over one step.
    # 4 to 8: order 1, less than the change within one step.
    assert all(row.largest < row.allowed for row in rows), [row for row in rows if row.largest >= row.allowed]
