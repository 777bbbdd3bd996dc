"""The picture of the README: particle-steps per second against the number of discs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullFormatter

PLACE = Path(__file__).parents[1] / "docs" / "pictures" / "speed.png"
PEER_DISCS = 15_000
CURVES = {1: ("o-", "#1f5a94"), 2: ("s-", "#2a9d8f")}
PEERS = {
    "lammps_granular": ("D", "#c1440e", "#c1440e", "LAMMPS pair granular, same law, one thread"),
    "ours without rolling": ("o", "white", "#1f5a94", "Leito without rolling resistance, one thread"),
    "lammps_hooke_history": ("D", "white", "#c1440e", "LAMMPS gran/hooke/history, no rolling, one thread"),
}


def draw(content: Mapping[str, Any], place: Path = PLACE) -> Path:
    """Draw the settled beds of a file of results, and the other codes if it has them."""
    chart, axes = plt.subplots(figsize=(6.4, 4.8), layout="constrained")
    for threads, (style, colour) in CURVES.items():
        points = sorted(
            (rate["discs"], rate["particle_steps_per_second"])
            for rate in content["rates"]
            if rate["what"] == "settled" and rate["threads"] == threads
        )
        if points:
            label = f"Leito, full law, {('one thread', 'two threads')[threads - 1]}"
            axes.plot(*zip(*points, strict=True), style, color=colour, label=label)
    rates = content.get("peers", {}).get("particle_steps_per_second", {})
    for name, (marker, face, edge, label) in PEERS.items():
        if name in rates:
            axes.plot(PEER_DISCS, rates[name], marker, mfc=face, mec=edge, ls="none", label=label, zorder=3)
    _label(axes, content["machine"])
    chart.legend(loc="outside lower center", fontsize=8, frameon=False)
    place.parent.mkdir(parents=True, exist_ok=True)
    chart.savefig(place, dpi=150)
    plt.close(chart)
    return place


def _label(axes: Axes, machine: Mapping[str, Any]) -> None:
    axes.set(xscale="log", yscale="log", xlabel="discs", ylabel="particle-steps per second")
    axes.set_ylim(1e6, 2e8)
    axes.set_title(f"Settled discs, double precision ({machine['processor']}, {machine['cores']} cores)", fontsize=10)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / 1e6:g} million"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(which="major", alpha=0.3)
