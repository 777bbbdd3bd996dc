"""`make validate`: every element on the same beams and rings, error against unknowns and time.

Writes `docs/validation/elements.md` and its picture. References are closed forms, or order 2 on a mesh so
fine that what is left is far below the errors shown.
"""

import textwrap
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import meshes
import numpy as np
import pytest
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter
from structure import BoundaryLoad, ElasticStructure, PlaneStrain, PointLoad
from structure.loads.load import Load

PAGE = Path(__file__).parents[2] / "docs" / "validation" / "elements.md"
YOUNG, DENSITY = 70e9, 2700.0
COMMON, SOFT = 0.35, 0.4999  # Poisson's ratios
BAR = {"length": 1.0, "height": 0.05}
RING = {"outer_radius": 0.05, "inner_radius": 0.04}
THIN = {"outer_radius": 0.0505, "inner_radius": 0.0495}


@dataclass(frozen=True)
class Kind:
    """One element: its cells, formulation, and the line in the picture."""

    name: str
    cell: str
    order: int
    element: str
    line: str

    @property
    def options(self) -> dict[str, object]:
        return {"cell": self.cell, "order": self.order}


Q4 = Kind("Q4 standard", "quadrilateral", 1, "standard", "s-")
ENHANCED = Kind("Q4 enhanced", "quadrilateral", 1, "enhanced", "o-")
Q9 = Kind("Q9 (order 2)", "quadrilateral", 2, "standard", "D-")
T3 = Kind("T3", "triangle", 1, "standard", "^--")
T6 = Kind("T6 (order 2)", "triangle", 2, "standard", "v--")
KINDS = (Q4, ENHANCED, Q9, T3, T6)


@dataclass(frozen=True)
class Result:
    """Relative errors of one element on one mesh, with what they cost."""

    mesh: str
    unknowns: int
    errors: tuple[float, ...]
    build: float
    step: float


def body(mesh: meshes.StructureMesh, kind: Kind, poisson: float, loads: Sequence[Load] = ()) -> ElasticStructure:
    material = PlaneStrain(youngs_modulus=YOUNG, poissons_ratio=poisson, density=DENSITY)
    return ElasticStructure(mesh, material=material, time_step=1e-5, loads=loads, element=kind.element)


def cost(build: Callable[[], ElasticStructure]) -> tuple[float, float]:
    """Seconds to build and seconds per step, the best of some: others may be at work."""
    building = []
    for _ in range(4):
        begin = time.perf_counter()
        built = build()
        building.append(time.perf_counter() - begin)
    force, steps = np.zeros_like(built.polyline.points), []
    for _ in range(8):
        begin = time.perf_counter()
        for _ in range(25):
            built.advance(force)
        steps.append((time.perf_counter() - begin) / 25)
    return min(building), min(steps)


def beam_frequencies(kind: Kind, poisson: float, n: int, sub: int = 1) -> tuple[meshes.StructureMesh, np.ndarray]:
    mesh = meshes.beam(**BAR, along=20 * n // sub, across=max(1, n // sub), **kind.options)
    return mesh, body(mesh, kind, poisson).frequencies(3)


def ring_frequencies(kind: Kind, poisson: float, n: int, sub: int = 1) -> tuple[meshes.StructureMesh, np.ndarray]:
    mesh = meshes.tube(**RING, around=30 * n // sub, layers=max(1, 2 * n // sub), **kind.options)
    return mesh, body(mesh, kind, poisson).frequencies(4)[[0, 2]]


def closing(mesh: meshes.StructureMesh, kind: Kind, poisson: float, radius: float) -> float:
    """How far the nodes at `radius` [m], top and bottom, come together under a unit force at each."""
    outer = mesh.points[:, 1].max()
    pair = [PointLoad(point=(0.0, s * outer), force=(0.0, -s)) for s in (1.0, -1.0)]
    u = body(mesh, kind, poisson, pair).static_displacement()
    top, bottom = (np.argmin(np.hypot(mesh.points[:, 0], mesh.points[:, 1] - s * radius)) for s in (1, -1))
    return float(u[bottom, 1] - u[top, 1])


def ovalisation(kind: Kind, poisson: float, n: int, sub: int = 1) -> tuple[meshes.StructureMesh, np.ndarray]:
    """Thin ring, outer node, over (pi/4 - 2/pi) P R^3/(E' I)."""
    mesh = meshes.tube(**THIN, around=60 * n // sub, layers=1, **kind.options)
    thickness = THIN["outer_radius"] - THIN["inner_radius"]
    bending = YOUNG / (1 - poisson**2) * thickness**3 / 12
    exact = (np.pi / 4 - 2 / np.pi) * 0.05**3 / bending
    return mesh, np.array([closing(mesh, kind, poisson, THIN["outer_radius"]) / exact])


def thick_ovalisation(kind: Kind, poisson: float, n: int, sub: int = 1) -> tuple[meshes.StructureMesh, np.ndarray]:
    """The source's ring, in the middle of its wall: at the forces a plane continuum gives way without limit."""
    mesh = meshes.tube(**RING, around=30 * n // sub, layers=2 * n // sub, **kind.options)
    bending = YOUNG / (1 - poisson**2) * 0.01**3 / 12
    return mesh, np.array([closing(mesh, kind, poisson, 0.045) * bending / 0.045**3])


def edge_loads(mesh: meshes.StructureMesh, x: float, traction: Callable[[float], tuple[float, float]]) -> np.ndarray:
    """Consistent nodal forces (n, 2) of a traction(y) on the edge at `x`, for facets of the mesh's order."""
    nodes = np.flatnonzero(np.abs(mesh.points[:, 0] - x) < 1e-9)
    nodes = nodes[np.argsort(mesh.points[nodes, 1])]
    force, order = np.zeros_like(mesh.points), mesh.order
    places, weights = np.polynomial.legendre.leggauss(5)
    for k in range(0, len(nodes) - 1, order):
        facet = nodes[k : k + order + 1]
        y = mesh.points[facet, 1]
        for s, weight in zip((places + 1) / 2, weights / 2 * (y[-1] - y[0])):
            shapes = [1 - s, s] if order == 1 else [(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)]
            force[facet] += np.outer(shapes, traction(y[0] + s * (y[-1] - y[0]))) * weight
    return force


def cantilever(kind: Kind, poisson: float, n: int, sub: int = 1) -> tuple[meshes.StructureMesh, np.ndarray]:
    """Deflection at the tip of 1 x 0.1 over ``P L^3/(3 E' I) + 6 P L/(5 G h)``.

    Saint-Venant's tractions act at tip and root and balance; their work is P times the deflection.
    """
    height = 0.1
    inertia = height**3 / 12
    mesh = meshes.beam(
        length=1.0,
        height=height,
        along=10 * n // sub,
        across=max(1, n // sub),
        origin=(0.0, -height / 2),
        **kind.options,
    )

    def shear(y: float) -> float:
        return (height**2 / 4 - y**2) / (2 * inertia)

    force = edge_loads(mesh, 1.0, lambda y: (0.0, shear(y))) + edge_loads(mesh, 0.0, lambda y: (y / inertia, -shear(y)))
    loads = [PointLoad(point=tuple(mesh.points[k]), force=tuple(force[k])) for k in np.flatnonzero(force.any(axis=1))]
    work = np.vdot(force, body(mesh, kind, poisson, loads).static_displacement())
    exact = (1 - poisson**2) / (3 * YOUNG * inertia) + 6 / (5 * YOUNG / 2 / (1 + poisson) * height)
    return mesh, np.array([work / exact])


INTRODUCTION = """# The elements compared

Written by `make validate`.

Plane strain, E = 70 GPa, rho = 2700 kg/m3. "Q4 enhanced" is `structure.element = "enhanced"`, which quadrilaterals of
order 1 are unless a scene says otherwise. Order 2 has cells of twice the size, hence about as many unknowns. The 80
cells of the beam and the 60 of the ring are the source's meshes. Times are of one run on two cores that had other
work; "to build" is matrices and factors, with compiled forms at hand.
References:

- frequencies and the closing of the thick ring: Q9 on a mesh at least twice as fine as any here (near nu = 0.5 it is
  itself some 0.03 % off);
- closing of the thin ring: (pi/4 - 2/pi) P R^3/(E'I) = 0.1488 P R^3/(E'I), E' = E/(1 - nu^2);
- deflection of the cantilever: P L^3/(3 E'I) + 6 P L/(5 G h), with Saint-Venant's tractions at both ends.

![elements.png](elements.png)
"""

Case = Callable[[Kind, float, int, int], tuple[meshes.StructureMesh, np.ndarray]]
CASES: dict[str, tuple[Case, tuple[str, ...], tuple[int, ...], int]] = {
    "Free beam 1 x 0.05, frequencies": (beam_frequencies, ("1st", "2nd", "3rd"), (1, 2, 4, 8), 16),
    "Free ring 0.05/0.04, frequencies": (ring_frequencies, ("n = 2", "n = 3"), (1, 2, 4), 8),
    "Thin ring, h/R = 0.02, under two opposite forces, closing": (ovalisation, ("closing",), (1, 2, 4), 0),
    "Free ring 0.05/0.04 under two opposite forces, closing": (thick_ovalisation, ("closing",), (1, 2, 4), 8),
    "Cantilever 1 x 0.1, deflection of its tip": (cantilever, ("tip",), (1, 2, 4), 0),
}


def results(case: Case, reference: np.ndarray, kind: Kind, sizes: tuple[int, ...], poisson: float) -> list[Result]:
    """One element on refined meshes; order 2 has cells of twice the size, hence about as many unknowns."""
    found = []
    for n in sizes:
        mesh, values = case(kind, poisson, n, kind.order)
        errors = tuple((values / reference - 1).tolist())
        build, step = cost(lambda: body(mesh, kind, poisson))
        cells = f"{len(mesh.cells)} cells"
        found.append(Result(cells, 2 * len(mesh.points), errors, build, step))
    return found


def percent(value: float) -> str:
    return f"{100 * value:+.3f}" if abs(value) < 0.1 else f"{100 * value:+.1f}"


def table(names: tuple[str, ...], rows: dict[Kind, list[Result]]) -> list[str]:
    head = ["element", "cells", "unknowns", *(f"{name}, error in %" for name in names), "to build, ms", "a step, us"]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for kind, found in rows.items():
        for r in found:
            row = [kind.name, r.mesh.split()[0], str(r.unknowns), *map(percent, r.errors)]
            lines.append("| " + " | ".join([*row, f"{1e3 * r.build:.1f}", f"{1e6 * r.step:.0f}"]) + " |")
    return [*lines, ""]


Panels = dict[str, dict[Kind, list[Result]]]


def draw(common: Panels, soft: Panels) -> None:
    """Error against unknowns and time, and against unknowns near nu = 0.5, case by case."""
    figure, axes = plt.subplots(3, len(common), figsize=(4 * len(common), 10), sharey="col", layout="constrained")
    for column, (title, rows) in zip(axes.T, common.items(), strict=True):
        for axis, panel in zip(column, (rows, rows, soft[title]), strict=True):
            against_time = axis is column[1]
            for kind, found in panel.items():
                errors = [100 * abs(r.errors[0]) for r in found]
                costs = [1e6 * r.step if against_time else r.unknowns for r in found]
                axis.loglog(costs, errors, kind.line, label=kind.name)
            poisson = SOFT if axis is column[2] else COMMON
            label = "time of a step [us]" if against_time else "unknowns"
            axis.set(xlabel=f"{label}, nu = {poisson:g}", ylabel="error [%]")
            axis.grid(True, which="both", alpha=0.3)
            axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.xaxis.set_major_formatter(ScalarFormatter())
            axis.xaxis.set_minor_formatter(NullFormatter())
        column[0].set_title(textwrap.fill(title, 34))
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=len(KINDS))
    figure.savefig(PAGE.with_suffix(".png"), dpi=110)
    plt.close(figure)


def reference(case: Case, fine: int, poisson: float) -> np.ndarray:
    return case(Q9, poisson, fine, 1)[1] if fine else np.ones(1)


def pressed_tube(kind: Kind, around: int, layers: int) -> tuple[float, float, float]:
    """The source's tube at rest: 1000 N/m on its upper 120 degrees, borne by a cosine over the lower 120.

    Returns
    -------
    Largest von Mises stress [MPa] at Gauss points and of the nodal averages, and the widening [um].
    """
    mesh = meshes.tube(**RING, around=around, layers=layers, **kind.options)
    loop = mesh.outer_polyline.points
    angle = np.arctan2(loop[:, 0], -loop[:, 1])
    share = np.where(np.abs(angle) < np.pi / 3 - 1e-9, np.cos(1.5 * angle), 0.0)
    if kind.order == 2:
        share *= np.where(np.arange(len(loop)) % 2, 4.0, 2.0)
    share *= 1000.0 / share.sum()
    loads = [BoundaryLoad(boundary="loaded_arc", total_force=(0.0, -1000.0))]
    loads += [PointLoad(point=tuple(p), force=(0.0, f)) for p, f in zip(loop, share) if f > 0]
    tube = body(mesh, kind, COMMON, loads)
    tube.set_initial(displacement=tube.static_displacement())
    nodal = tube.fields().point_data
    return tube.peaks().von_mises / 1e6, nodal["von_mises"].max() / 1e6, 1e6 * np.ptp(nodal["displacement"][:, 0])


def stress_section() -> list[str]:
    head = [
        "element",
        "cells",
        "largest von Mises stress at Gauss points, MPa",
        "of nodal averages, MPa",
        "widening, um",
    ]
    lines = ["## Stress in the source's tube, pressed at rest", "", f"nu = {COMMON:g}.", ""]
    lines += ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    meshed = ((Q4, 30, 2), (ENHANCED, 30, 2), (Q4, 60, 4), (ENHANCED, 60, 4), (Q9, 30, 2), (Q9, 120, 6))
    widening = {}
    for kind, around, layers in meshed:
        gauss, nodal, widening[kind, around] = pressed_tube(kind, around, layers)
        lines.append(
            f"| {kind.name} | {around} x {layers} | {gauss:.3f} | {nodal:.3f} | {widening[kind, around]:.3f} |"
        )
    exact = widening[Q9, 120]
    assert abs(widening[ENHANCED, 30] / exact - 1) < 0.2 * abs(widening[Q4, 30] / exact - 1)
    return [*lines, ""]


@pytest.mark.validate
def test_elements() -> None:
    lines = [INTRODUCTION]
    panels: tuple[Panels, Panels] = ({}, {})
    for title, (case, names, sizes, fine) in CASES.items():
        exact = reference(case, fine, COMMON)
        rows = {kind: results(case, exact, kind, sizes, COMMON) for kind in KINDS}
        lines += [f"## {title}", "", f"nu = {COMMON:g}.", "", *table(names, rows)]
        exact = reference(case, fine, SOFT)
        soft = {kind: results(case, exact, kind, sizes[:3], SOFT) for kind in KINDS}
        lines += [f"nu = {SOFT:g}.", "", *table(names, soft)]
        for panel, found in zip(panels, (rows, soft), strict=True):
            panel[f"{title.rpartition(', ')[0]}: {names[0]}"] = found
        # the purpose of the enhanced cell: right where the standard one is not, at every Poisson's ratio
        for enhanced, standard in ((rows[ENHANCED], rows[Q4]), (soft[ENHANCED], soft[Q4])):
            for one, other in zip(enhanced, standard):
                assert max(map(abs, one.errors)) < 0.3 * max(map(abs, other.errors)), (title, one, other)
        if case is thick_ovalisation:
            ratio = exact[0] / (np.pi / 4 - 2 / np.pi)
            lines += [f"This ring (h/R = 0.22) closes {ratio:.3f} times as far as a thin one.", ""]
    draw(*panels)
    lines += stress_section()
    PAGE.write_text("\n".join(lines))
