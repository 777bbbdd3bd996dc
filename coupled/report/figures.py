"""Pictures of a run, drawn from its files alone."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from coupled.errors import LeitoError
from coupled.measuring.measure import draw_run
from coupled.output import history
from coupled.output.folder import SCENE
from coupled.output.frames import read_frame
from coupled.report.drawing import Axes, EllipseCollection, Figure, PolyCollection, plt
from coupled.report.units import Shown

FREE, GLUED = -1, 0
WIDTH = 7.0


def plot_run(folder: Path) -> list[Path]:
    """Draw every figure that the files of a run allow into `figures/`; returns their paths.

    Raises
    ------
    LeitoError
        If the folder holds no history.
    """
    path = folder / history.NAME
    if not path.exists():
        raise LeitoError(f"{folder} holds no {history.NAME}; give the folder of a run")
    run = _Files(folder)
    drawn = []
    (folder / "figures").mkdir(exist_ok=True)
    for name, draw in _FIGURES.items():
        figure = draw(run)
        if figure is not None:
            target = folder / "figures" / f"{name}.png"
            figure.savefig(target, dpi=150)
            plt.close(figure)
            drawn.append(target)
    if "shaking" in run.scene:
        drawn += draw_run(folder, folder / "figures")
    return drawn


class _Files:
    """What the figures read: scene, history, last frames."""

    def __init__(self, folder: Path) -> None:
        self.history = history.read_history(folder / history.NAME)
        self.time = self.history["time"]
        self.scene: dict[str, Any] = tomllib.loads((folder / SCENE).read_text())
        self.title = self.scene["title"]
        self.shown = Shown(self.scene.get("units", "SI"))
        self.grains = _last(folder, "grains")
        self.structure = _last(folder, "structure")

    def has(self, *names: str) -> bool:
        return all(name in self.history for name in names) and len(self.time) > 1


def _last(folder: Path, name: str) -> dict[str, np.ndarray] | None:
    frames = sorted((folder / "frames").glob(f"{name}.*.h5"))
    if not frames:
        return None
    time, arrays = read_frame(frames[-1])
    return {**arrays, "time": np.array(time)}


def _new(run: _Files, height: float = 4.0) -> tuple[Figure, Axes]:
    figure, axes = plt.subplots(figsize=(WIDTH, height), layout="constrained")
    axes.set_title(run.title, fontsize=10)
    return figure, axes


def configuration(run: _Files) -> Figure | None:
    """Grains coloured by summed overlap, the structure by von Mises."""
    if run.grains is None and run.structure is None:
        return None
    figure, axes = _new(run)
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    moments = []
    if run.grains is not None:
        points, radius = run.grains["points"], run.grains["radius"]
        _draw_grains(figure, axes, run)
        low, high = (points - radius[:, None]).min(axis=0), (points + radius[:, None]).max(axis=0)
        moments.append(float(run.grains["time"]))
    if run.structure is not None:
        places = run.structure["points"] + run.structure["displacement"][:, :2]
        _draw_structure(figure, axes, places, run)
        low, high = np.minimum(low, places.min(axis=0)), np.maximum(high, places.max(axis=0))
        moments.append(float(run.structure["time"]))
    margin = 0.02 * float((high - low).max())
    shape = float(np.clip((high[1] - low[1] + 2 * margin) / (high[0] - low[0] + 2 * margin), 0.1, 1.0))
    figure.set_size_inches(WIDTH, 0.85 * WIDTH * shape + 1.6)
    axes.set(
        xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal",
        xlabel=run.shown.label("x", "m"), ylabel=run.shown.label("y", "m"),
        title=f"{run.title}, t = {max(moments):g}{run.shown.after('s')}",
    )  # fmt: skip
    return figure


def near_structure(run: _Files) -> Figure | None:
    """The same close to the structure, where the force network is seen."""
    if run.grains is None or run.structure is None:
        return None
    figure = configuration(run)
    places = run.structure["points"] + run.structure["displacement"][:, :2]
    low, high = places.min(axis=0), places.max(axis=0)
    size = 0.75 * float((high - low).max())
    centre = (low + high) / 2
    all_low, all_high = figure.axes[0].get_ylim()
    bottom, top = max(centre[1] - 1.2 * size, all_low), min(centre[1] + 0.8 * size, all_high)
    figure.axes[0].set(xlim=(centre[0] - size, centre[0] + size), ylim=(bottom, top))
    figure.set_size_inches(WIDTH, 0.85 * WIDTH * (top - bottom) / (2.0 * size) + 1.6)
    return figure


def _draw_grains(figure: Figure, axes: Axes, run: _Files) -> None:
    points, radius, body = (run.grains[name] for name in ("points", "radius", "body"))
    overlap = run.shown.number(run.grains["overlap"], "um")
    order = np.argsort(overlap)
    diameter = 2.0 * radius[order]
    discs = EllipseCollection(
        diameter, diameter, np.zeros(len(order)), units="xy", offsets=points[order], offset_transform=axes.transData,
        cmap="YlOrBr", linewidths=0.0,
    )  # fmt: skip
    free = overlap[body == FREE]
    top = float(np.quantile(free, 0.995)) if len(free) else float(overlap.max(initial=0.0))
    discs.set_array(overlap[order])
    discs.set_clim(0.0, max(top, 1e-12))
    axes.add_collection(discs)
    figure.colorbar(
        discs,
        ax=axes,
        label=run.shown.label("summed overlap", "um"),
        orientation="horizontal",
        shrink=0.6,
        aspect=40,
        extend="max",
    )


def _draw_structure(figure: Figure, axes: Axes, places: np.ndarray, run: _Files) -> None:
    frame = run.structure
    corners = frame["cells"][:, : 4 if frame["cells"].shape[1] in (4, 9) else 3]
    cells = PolyCollection(places[corners], cmap="viridis", edgecolors="face", linewidths=0.3)
    stress = frame["von_mises"][corners].mean(axis=1)
    axes.add_collection(cells)
    if stress.any():
        cells.set_array(run.shown.number(stress, "MPa"))
        figure.colorbar(cells, ax=axes, label=run.shown.label("von Mises", "MPa"), aspect=18, shrink=0.75)
    else:
        cells.set_facecolor("0.55")


def centroid(run: _Files) -> Figure | None:
    """Height of the structure's centroid against time."""
    if not run.has("centroid_y") or run.scene["structure"].get("initial"):
        return None
    figure, axes = _new(run)
    axes.plot(run.time, run.shown.number(run.history["centroid_y"], "mm"))
    axes.set(xlabel=run.shown.label("time", "s"), ylabel=run.shown.label("height of the centroid", "mm"))
    return figure


def reaction(run: _Files) -> Figure | None:
    """Force of the grains on the structure against time, with the applied load."""
    if not run.has("reaction_y"):
        return None
    figure, axes = _new(run)
    axes.plot(run.time, run.history["reaction_y"], label="reaction of the grains, vertical", linewidth=0.9)
    if np.ptp(run.history["reaction_x"]) > 0.01 * np.ptp(run.history["reaction_y"]):
        axes.plot(run.time, run.history["reaction_x"], label="horizontal", linewidth=0.9)
    if run.scene["structure"]["kind"] != "rigid":
        axes.plot(run.time, -run.history["applied_y"], "k--", label="applied load, opposite", linewidth=0.9)
    axes.set(xlabel=run.shown.label("time", "s"), ylabel=run.shown.label("force", "N/m"))
    axes.legend()
    return figure


def penetration(run: _Files) -> Figure | None:
    """Reaction against the way down of a structure on a prescribed path."""
    if not run.has("reaction_y") or run.scene["structure"]["kind"] != "rigid":
        return None
    figure, axes = _new(run)
    down = run.history["centroid_y"][0] - run.history["centroid_y"]
    axes.plot(run.shown.number(down, "mm"), run.history["reaction_y"], linewidth=0.8)
    axes.set(xlabel=run.shown.label("penetration", "mm"), ylabel=run.shown.label("vertical reaction", "N/m"))
    return figure


def interface_forces(run: _Files) -> Figure | None:
    """Vertical force per glued grain, or of each grain on the facets, and per node of the structure's lower half."""
    if run.grains is None or run.structure is None or "grain_force" not in run.structure:
        return None
    places = run.structure["points"] + run.structure["displacement"][:, :2]
    middle = 0.5 * (places[:, 1].min() + places[:, 1].max())
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(WIDTH, 5.4), sharex=True, layout="constrained")
    pairs = (
        (upper, *_contact_forces(run.grains)),
        (lower, places, run.structure["grain_force"][:, 1], "per node"),
    )
    for axes, points, force, label in pairs:
        own = (points[:, 1] < middle) & ((force != 0.0) | _outermost(points))
        x = run.shown.number(points[own, 0], "mm")
        axes.vlines(x, 0.0, force[own], colors="tab:blue", linewidth=1.0)
        axes.plot(x, force[own], ".", markersize=3)
        axes.set(ylabel=run.shown.label(f"vertical force {label}", "N/m"))
        axes.yaxis.label.set_fontsize(8)
    lower.set(xlabel=run.shown.label("x, lower half of the structure", "mm"))
    upper.set_title(f"{run.title}, t = {float(run.structure['time']):g}{run.shown.after('s')}", fontsize=10)
    return figure


def _contact_forces(grains: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray, str]:
    """Points, vertical forces there, and what they belong to."""
    if "facet_force" in grains:
        touching = grains["facet_force"].any(axis=1)
        return grains["points"][touching], grains["facet_force"][touching, 1], "of a touching grain"
    glued = grains["body"] == GLUED
    return grains["points"][glued], grains["force"][glued, 1], "per glued grain"


def _outermost(points: np.ndarray) -> np.ndarray:
    """Extreme points, which keep the axis as wide as the structure."""
    if not len(points):
        return np.zeros(0, bool)
    return (points[:, 0] == points[:, 0].min()) | (points[:, 0] == points[:, 0].max())


def neutral_axis(run: _Files) -> Figure | None:
    """Deflection of a beam's axis relative to the mean of its ends."""
    if run.structure is None or "beam" not in run.scene["structure"] or run.scene["structure"]["kind"] != "elastic":
        return None
    points, moved = run.structure["points"], run.structure["displacement"][:, 1]
    height = np.unique(np.round(points[:, 1], 9))
    axis = np.abs(points[:, 1] - height[len(height) // 2]) < 1e-9
    order = np.argsort(points[axis, 0])
    x, w = points[axis, 0][order], moved[axis][order]
    figure, axes = _new(run)
    bent = w - (w[0] + (w[-1] - w[0]) * (x - x[0]) / (x[-1] - x[0]))
    axes.plot(x - x[0], run.shown.number(bent, "um"), ".-", markersize=4)
    axes.set(
        xlabel=run.shown.label("along the beam", "m"), ylabel=run.shown.label("deflection relative to the ends", "um")
    )
    return figure


def ledger(run: _Files) -> Figure | None:
    """Stored energies, losses and works against time, and the error of their sum."""
    if not run.has("ledger_error"):
        return None
    figure, (upper, lower) = plt.subplots(
        2, 1, figsize=(WIDTH, 6.0), sharex=True, layout="constrained", height_ratios=[2, 1]
    )
    names = [name for name in run.history if name.startswith(("grains_", "structure_k", "structure_s", "structure_l"))]
    names += ["walls_work", "rows_work", "loads_work"]
    changes = {name: run.history[name] - run.history[name][0] for name in names if name in run.history}
    largest = max((np.abs(change).max() for change in changes.values()), default=0.0)
    for name, change in changes.items():
        if np.abs(change).max() > 0.01 * largest:
            upper.plot(run.time, change, label=name.replace("_", " "), linewidth=1.0)
    upper.set(ylabel=run.shown.label("change since the start", "J/m"))
    upper.legend(fontsize=7, ncols=2)
    upper.set_title(f"{run.title}: energy ledger", fontsize=10)
    lower.plot(run.time, run.history["ledger_error"], "k", linewidth=1.0, label="error of the sum")
    if "interface_residual" in run.history:
        lower.plot(run.time, run.history["interface_residual"], linewidth=1.0, label="interface residual")
    lower.set(xlabel=run.shown.label("time", "s"), ylabel=run.shown.label("error", "J/m"))
    lower.legend(fontsize=7)
    return figure


def vibration(run: _Files) -> Figure | None:
    """Energies of a structure alone, which show its vibration."""
    if not run.has("structure_strain") or run.grains is not None:
        return None
    figure, axes = _new(run)
    axes.plot(run.time, run.history["structure_strain"], label="strain energy", linewidth=0.9)
    axes.plot(run.time, run.history["structure_kinetic"], label="kinetic energy", linewidth=0.9)
    axes.set(xlabel=run.shown.label("time", "s"), ylabel=run.shown.label("energy", "J/m"))
    axes.legend()
    return figure


_FIGURES: dict[str, Callable[[_Files], Figure | None]] = {
    "configuration": configuration,
    "near_structure": near_structure,
    "centroid": centroid,
    "reaction": reaction,
    "penetration": penetration,
    "interface_forces": interface_forces,
    "neutral_axis": neutral_axis,
    "vibration": vibration,
    "ledger": ledger,
}
