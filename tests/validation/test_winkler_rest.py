"""`make validate`: what the source plots of its beam on a row of fixed grains (G 3.4, figures 3.21 to 3.25).

Writes `docs/validation/winkler_rest.md` with a figure: the scene `winkler_beam` with both interfaces, beside a
plane-strain solution in numpy and scipy on the same springs (`tests/coupled/independent_beam.py`), on the same cells
and on fine ones.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).parents[1] / "coupled"))

from independent_beam import IndependentBeam, Rest
from ways import INTERFACES

from coupled.build import build
from coupled.scene import load_scene
from structure import StructureFields

DOCS = Path(__file__).parents[2] / "docs" / "validation"
SCENE = load_scene("winkler_beam")
LENGTH, HEIGHT = SCENE.structure.shape.length, SCENE.structure.shape.height
ALONG, ACROSS = SCENE.structure.shape.along, SCENE.structure.shape.across
TOTAL = -SCENE.structure.loads[0].total_force[1]
SPRINGS = np.linspace(0.0, LENGTH, 3 * ALONG + 1)
RADIUS, EVERY = 4.1e-3, 0.01
FINER = 6
MARKS = {"glued": "o", "facets": "x"}


@dataclass(frozen=True)
class Seen:
    """A run of the scene: heights [m] against time [s], and the end: forces (k, 2) of each fixed grain on the beam and
    (n, 2) on the nodes of its lower face [N/m], its fields."""

    time: np.ndarray
    height: np.ndarray
    force: np.ndarray
    nodal: np.ndarray
    fields: StructureFields


def run(interface: str) -> Seen:
    model = build(load_scene("winkler_beam", [f"interface.kind={interface}"])).model
    heights = [model.structure.centroid()[1]]
    for _ in range(round(SCENE.time.duration / EVERY)):
        model.advance(round(EVERY / model.window))
        heights.append(model.structure.centroid()[1])
    points = model.structure.polyline.points
    lower = np.nonzero(np.isclose(points[:, 1], 0.0))[0]
    lower = lower[np.argsort(points[lower, 0])]
    return Seen(
        EVERY * np.arange(len(heights)),
        np.array(heights),
        model.contact_force,
        model.nodal_force[lower],
        model.structure.fields(),
    )


@dataclass(frozen=True)
class Independent:
    """The same beam at rest by other means."""

    own: IndependentBeam
    rest: Rest
    nodal: np.ndarray  # vertical forces (n,) of the springs on the lower nodes [N/m]
    drop: float  # of the centroid [m]


def independent(refined: int = 1) -> Independent:
    table, contact = SCENE.structure, SCENE.contact
    own = IndependentBeam(
        length=LENGTH,
        height=HEIGHT,
        along=ALONG * refined,
        across=ACROSS * refined,
        young=table.youngs_modulus,
        poisson=table.poissons_ratio,
    )
    load = own.uniform(-TOTAL)
    rest = own.rest(
        load,
        SPRINGS,
        normal=contact.normal_stiffness,
        tangential=contact.tangential_stiffness,
        between=2 * RADIUS,
        friction=contact.friction,
    )
    held = own.stiffness @ rest.displacement - load
    mass = own.mass(1.0)
    drop = -float(np.ones(own.size // 2) @ (mass @ rest.displacement)[1::2]) / (LENGTH * HEIGHT)
    return Independent(own, rest, held[1::2][: ALONG * refined + 1], drop)


def axis_of(fields: StructureFields) -> np.ndarray:
    """Deflection (n,) [m] of the middle row of nodes against the lower left corner, as in the source."""
    x, y = fields.points.T
    w = fields.point_data["displacement"][:, 1]
    row = np.nonzero(np.isclose(y, y.mean()))[0]
    corner = np.lexsort((x, y))[0]
    return (w[row] - w[corner])[np.argsort(x[row])]


def axis_alone(found: Independent) -> np.ndarray:
    u = found.rest.displacement
    return found.own.middle(u) - u[1]


def draw_heights(axes: Axes, runs: dict[str, Seen], same: Independent) -> None:
    for interface, seen in runs.items():
        axes.plot(
            seen.time, 1e6 * (seen.height - seen.height[0]), "-" if interface == "glued" else "--", label=interface
        )
    axes.axhline(-1e6 * same.drop, color="k", ls=":", label="independent, at rest")
    axes.set(xlabel="time [s]", ylabel="way of the centroid [um]", title="G 3.21")


def draw_stress(figure: Figure, axes: Axes, fields: StructureFields) -> None:
    places = fields.points
    cells = PolyCollection(places[fields.cells[:, :4]], cmap="coolwarm", edgecolors="0.6", linewidths=0.2)
    stress = fields.point_data["sigma_xx"][fields.cells[:, :4]].mean(axis=1) / 1e6
    cells.set_array(stress)
    cells.set_clim(-np.abs(stress).max(), np.abs(stress).max())
    axes.add_collection(cells)
    axes.set(
        xlim=(-0.02, 1.02 * LENGTH), ylim=(-0.02, 0.02 + HEIGHT), xlabel="x [m]", ylabel="y [m]", aspect="equal",
        title="G 3.22: sigma_xx, mean of a cell's nodes [MPa]",
    )  # fmt: skip
    figure.colorbar(cells, ax=axes, orientation="horizontal", shrink=0.8)


def draw_deflection(axes: Axes, runs: dict[str, Seen], same: Independent, fine: Independent) -> None:
    x = np.linspace(0.0, LENGTH, ALONG + 1)
    axes.plot(np.linspace(0.0, LENGTH, FINER * ALONG + 1), 1e6 * axis_alone(fine), "k:", label="independent, fine")
    axes.plot(x, 1e6 * axis_alone(same), "k-", label="independent")
    for interface, seen in runs.items():
        axes.plot(x, 1e6 * axis_of(seen.fields), MARKS[interface], markersize=4, label=interface, fillstyle="none")
    axes.set(xlabel="x [m]", ylabel="deflection of the axis\nagainst the lower left corner [um]", title="G 3.23")


def draw_forces(axes: Axes, runs: dict[str, Seen], values: np.ndarray, component: int, title: str) -> None:
    axes.plot(SPRINGS, values, "k-", label="independent")
    for interface, seen in runs.items():
        axes.plot(SPRINGS, seen.force[:, component], MARKS[interface], markersize=3, label=interface, fillstyle="none")
    name = ("horizontal", "vertical")[component]
    axes.set(xlabel="x [m]", ylabel=f"{name} force of a grain [N/m]", title=title)


def draw_nodal(axes: Axes, runs: dict[str, Seen], same: Independent) -> None:
    x = np.linspace(0.0, LENGTH, ALONG + 1)
    axes.plot(x, same.nodal, "k-", label="independent")
    for interface, seen in runs.items():
        axes.plot(x, seen.nodal[:, 1], MARKS[interface], markersize=4, label=interface, fillstyle="none")
    axes.set(xlabel="x [m]", ylabel="vertical force on a lower node [N/m]", title="G 3.25", ylim=(0.0, None))


PAGE = """# The source's beam on a row of fixed grains

Written by `make validate`.

The scene `winkler_beam` with each interface after 1 s, in the quantities that the source plots in figures 3.21 to
3.25 (it does not say how large its load is, and compares with no solution). Independent: plane strain with numpy and
scipy on the same 121 springs without tension, their shear included; the same cells, and {finer} times finer ones.

![winkler_rest.png](winkler_rest.png)

| quantity | glued | facets | independent | fine cells |
|---|---|---|---|---|
{rows}

Largest differences to the independent solution of the same cells, of glued grains: {force:.1e} of the largest
vertical force of a grain, {nodal:.1e} of the largest nodal force, {axis:.1e} of the bow, half of it by the rolling
moments, which the independent springs do not know. With facets the shear acts on the lower face itself, with glued
grains the radius of one lower, which turns its facet: the bows differ by {between:.1e}.

As in the source the beam is in tension below and in compression above, its axis is symmetric with the middle lowest,
the force of a grain is largest in the middle, and the end nodes carry less, as two springs and not three push there. A
uniform load on uniform springs alone would not bend it: the full springs on half tributary lengths at the ends do.
"""


def rows(runs: dict[str, Seen], same: Independent, fine: Independent) -> str:
    seen, others = [runs[name] for name in INTERFACES], (same, fine)
    lines = {
        "drop of the centroid [um]": [
            *(1e6 * (one.height[0] - one.height[-1]) for one in seen),
            *(1e6 * found.drop for found in others),
        ],
        "bow of the axis [um]": [
            *(1e6 * np.ptp(axis_of(one.fields)) for one in seen),
            *(1e6 * np.ptp(axis_alone(found)) for found in others),
        ],
        "force of the middle grain [N/m]": [
            *(one.force[60, 1] for one in seen),
            *(found.rest.push[60] for found in others),
        ],
        "force of an end grain [N/m]": [
            *(one.force[0, 1] for one in seen),
            *(found.rest.push[0] for found in others),
        ],
        "largest horizontal force of a grain [N/m]": [
            *(np.abs(one.force[:, 0]).max() for one in seen),
            *(np.abs(found.rest.shear).max() for found in others),
        ],
    }
    return "\n".join(f"| {what} | {' | '.join(f'{value:.5g}' for value in values)} |" for what, values in lines.items())


@pytest.mark.validate
def test_rest_on_the_row() -> None:
    runs = {interface: run(interface) for interface in INTERFACES}
    same, fine = independent(), independent(FINER)
    figure, axes = plt.subplots(3, 2, figsize=(11, 10), constrained_layout=True)
    draw_heights(axes[0, 0], runs, same)
    draw_stress(figure, axes[0, 1], runs["glued"].fields)
    draw_deflection(axes[1, 0], runs, same, fine)
    draw_forces(axes[1, 1], runs, same.rest.push, 1, "G 3.24")
    draw_nodal(axes[2, 0], runs, same)
    draw_forces(axes[2, 1], runs, same.rest.shear, 0, "not in the source")
    for one in axes.ravel():
        if one.get_legend_handles_labels()[0]:
            one.legend(fontsize=7)
    figure.savefig(DOCS / "winkler_rest.png", dpi=120)
    glued, facets = (runs[name] for name in INTERFACES)
    bow = np.ptp(axis_alone(same))
    worst = {
        "force": np.abs(glued.force[:, 1] - same.rest.push).max() / same.rest.push.max(),
        "nodal": np.abs(glued.nodal[:, 1] - same.nodal).max() / same.nodal.max(),
        "axis": np.abs(axis_of(glued.fields) - axis_alone(same)).max() / bow,
    }
    between = np.abs(axis_of(glued.fields) - axis_of(facets.fields)).max() / bow
    text = PAGE.format(finer=FINER, rows=rows(runs, same, fine), between=between, **worst)
    (DOCS / "winkler_rest.md").write_text(text)
    # 0.5 s after the ramp bouncing has died as exp(-70 t) to 1e-15. Left are terms of second order, and in the bow the
    # rolling moments, which the independent springs do not know: without them 8.5e-6.
    assert max(worst["force"], worst["nodal"]) < 1e-5 and worst["axis"] < 3e-5
    force = glued.force[:, 1]
    assert force.argmax() == 60 and np.abs(force - force[::-1]).max() < 1e-9 * force.max()
