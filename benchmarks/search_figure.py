"""The picture of docs/performance.md: cost of finding contacts against the number of grains."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
from figure import AMBER, BLUE, GREEN, RED
from search import LIFE, WAYS, crossovers

PLACE = Path(__file__).parents[1] / "docs" / "pictures" / "search.png"
NAMES = dict(
    zip(
        WAYS,
        ("all pairs", "list out of all pairs", "cells at every step", "list out of cells (Leito)"),
        strict=True,
    )
)
COLOURS = dict(zip(WAYS, (RED, AMBER, GREEN, BLUE), strict=True))


def draw(content: Mapping[str, Any], place: Path = PLACE) -> Path:
    """Draw the rows "search" of a file of results: one thread filled, two threads open and dashed."""
    rows = content["search"]
    chart, axes = plt.subplots(figsize=(6.8, 5.2), layout="constrained")
    for threads, style, filled in ((1, "-", True), (2, "--", False)):
        for way in WAYS:
            own = sorted(
                (row["grains"], row["step_seconds"] + row["list_seconds"] / LIFE)
                for row in rows
                if (row["way"], row["threads"]) == (way, threads)
            )
            if own:
                sizes, cost = [n for n, _ in own], [1e9 * seconds / n for n, seconds in own]
                axes.plot(
                    sizes, cost, style, marker="o" if filled else "s", ms=5, lw=1.3, color=COLOURS[way],
                    mfc=COLOURS[way] if filled else "white",
                    label=f"{NAMES[way]}, {threads} thread{'s' * (threads > 1)}",
                )  # fmt: skip
    least = min(row["grains"] for row in rows)
    for n in crossovers(rows).values():
        if n is not None and n > least:  # else one way is ahead at every size, and no curves cross
            axes.axvline(n, color="0.6", lw=0.8, ls=":")
            axes.annotate(f" {n:.0f}", (n, 1.0), xycoords=("data", "axes fraction"), fontsize=8, ha="left", va="top")
    axes.set(xscale="log", yscale="log", xlabel="discs", ylabel="finding contacts, per disc and step [ns]")
    machine = content["machine"]
    axes.set_title(
        f"Dense discs, lists that last {LIFE} steps ({machine['processor']}, {machine['cores']} cores)", fontsize=9
    )
    axes.grid(which="major", alpha=0.25)
    chart.legend(loc="outside lower center", fontsize=8, frameon=False, ncols=2)
    place.parent.mkdir(parents=True, exist_ok=True)
    chart.savefig(place, dpi=150)
    plt.close(chart)
    return place
