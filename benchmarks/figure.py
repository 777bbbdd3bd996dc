"""The picture of the README: particle-steps per second against the number of discs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullFormatter

PLACE = Path(__file__).parents[1] / "docs" / "pictures" / "speed.png"
BLUE, GREEN, RED, AMBER, PURPLE = "#1f5a94", "#2a9d8f", "#c1440e", "#e09f3e", "#7b4b94"


class Look(NamedTuple):
    """How a curve is drawn: full law filled, without rolling open and dashed."""

    label: str
    marker: str
    colour: str
    rolling: bool = True


OURS = {
    1: Look("Leito, one thread", "o", BLUE),
    2: Look("Leito, two threads", "s", GREEN),
}
COMPARED = {
    ("leito_without_rolling", 1): Look("Leito, one thread, no rolling", "o", BLUE, False),
    ("leito_without_rolling", 2): Look("Leito, two threads, no rolling", "s", GREEN, False),
    ("liggghts", 1): Look("LIGGGHTS, one core", "^", PURPLE),
    ("lammps_granular", 1): Look("LAMMPS granular, one core", "D", RED),
    ("lammps_granular", 2): Look("LAMMPS granular, two cores", "P", AMBER),
    ("lammps_hooke_history", 1): Look("LAMMPS hooke/history, one core, no rolling", "D", RED, False),
    ("lammps_hooke_history", 2): Look("LAMMPS hooke/history, two cores, no rolling", "P", AMBER, False),
}
Points = list[tuple[int, float]]


def draw(content: Mapping[str, Any], place: Path = PLACE) -> Path:
    """Draw the settled beds of a file of results, and the other codes if it has them."""
    chart, axes = plt.subplots(figsize=(6.8, 5.6), layout="constrained")
    settled = [rate for rate in content["rates"] if rate["what"] == "settled"]
    for threads, look in OURS.items():
        _curve(axes, look, _points(rate for rate in settled if rate["threads"] == threads))
    runs = content.get("peers", {}).get("runs", [])
    for who, look in COMPARED.items():
        _curve(axes, look, _points(run for run in runs if (run["code"], run["cores"]) == who))
    _label(axes, content["machine"])
    chart.legend(loc="outside lower center", fontsize=8, frameon=False, ncols=2)
    place.parent.mkdir(parents=True, exist_ok=True)
    chart.savefig(place, dpi=150)
    plt.close(chart)
    return place


def _points(runs: Any) -> Points:
    return sorted((run["discs"], run["particle_steps_per_second"]) for run in runs)


def _curve(axes: Axes, look: Look, points: Points) -> None:
    if points:
        axes.plot(
            *zip(*points, strict=True), marker=look.marker, ls="-" if look.rolling else "--", lw=1.3, ms=6,
            color=look.colour, mfc=look.colour if look.rolling else "white", label=look.label,
        )  # fmt: skip


def _label(axes: Axes, machine: Mapping[str, Any]) -> None:
    axes.set(xscale="log", yscale="log", xlabel="discs", ylabel="particle-steps per second")
    axes.set_title(f"Settled discs, double precision ({machine['processor']}, {machine['cores']} cores)", fontsize=10)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / 1e6:g} million"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylim(1e6, 2e8)
    axes.grid(which="both", axis="y", alpha=0.25)
    axes.grid(which="major", axis="x", alpha=0.25)
