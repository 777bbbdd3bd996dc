"""The picture of docs/performance.md: cost of a step of the structure against unknowns."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
from figure import BLUE, GREEN

PLACE = Path(__file__).parents[1] / "docs" / "pictures" / "structure_step.png"
LOOKS = {1: ("one rank", "o", BLUE), 2: ("two ranks", "s", GREEN)}


def draw(content: Mapping[str, Any], place: Path = PLACE) -> Path:
    """Draw the rows "structure" of a file of results: ours filled, bare dolfinx open and dashed."""
    chart, axes = plt.subplots(figsize=(6.8, 4.4), layout="constrained")
    for ranks, (label, marker, colour) in LOOKS.items():
        rows = sorted((row for row in content["structure"] if row["ranks"] == ranks), key=lambda row: row["unknowns"])
        unknowns = [row["unknowns"] for row in rows]
        for key, who, filled in (("step_seconds", "Leito", True), ("bare_step_seconds", "bare dolfinx", False)):
            if rows:
                axes.plot(
                    unknowns, [1e6 * row[key] for row in rows], marker=marker, ls="-" if filled else "--", lw=1.3, ms=6,
                    color=colour, mfc=colour if filled else "white", label=f"{who}, {label}",
                )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="unknowns", ylabel="time of a step [us]")
    machine = content["machine"]
    axes.set_title(f"Elastic beam, one step ({machine['processor']}, {machine['cores']} cores)", fontsize=10)
    axes.grid(which="major", alpha=0.25)
    axes.legend(fontsize=8, frameon=False)
    place.parent.mkdir(parents=True, exist_ok=True)
    chart.savefig(place, dpi=150)
    plt.close(chart)
    return place
