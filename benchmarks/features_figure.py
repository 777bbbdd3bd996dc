"""The picture of what each feature costs: bars with quartiles, in ns per grain and step."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt

PLACE = Path(__file__).parents[1] / "docs" / "pictures" / "features.png"
BASE, MORE, LESS = "#1f5a94", "#c1440e", "#2a9d8f"


def draw(content: Mapping[str, Any], place: Path = PLACE) -> Path:
    """Draw the costs of a file of results."""
    rows = content["features"]
    chart, axes = plt.subplots(figsize=(8.2, 0.29 * len(rows) + 1.2), layout="constrained")
    for place_of_bar, row in enumerate(rows):
        colour = BASE if row["beside"] is None else (MORE if row["low"] > 0.0 else LESS)
        reach = [[row["added"] - row["low"]], [row["high"] - row["added"]]]
        axes.barh(place_of_bar, row["added"], xerr=reach, color=colour, height=0.7, error_kw={"lw": 1.0, "capsize": 2})
        right = max(row["added"], row["high"], 0.0)
        share = "" if row["beside"] is None else f" ({row['percent']:+.0f} %)"
        axes.annotate(
            f"{row['added']:.2f}{share}", (right, place_of_bar), xytext=(4, 0), textcoords="offset points", va="center",
            fontsize=8,
        )  # fmt: skip
    names = [row["feature"] if row["beside"] is None else f"{row['feature']}  [{row['beside']}]" for row in rows]
    axes.set_yticks(range(len(rows)), names, fontsize=8)
    axes.set_xlabel("added to the step of a grain [ns]; green: lower quartile not above zero")
    axes.set_xlim(right=1.3 * max(row["high"] for row in rows))
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(axis="x", alpha=0.25)
    machine = content["machine"]
    chart.suptitle(
        f"A feature [and what it is added to], 15 000 settled discs, one thread ({machine['processor']})", fontsize=10
    )
    place.parent.mkdir(parents=True, exist_ok=True)
    chart.savefig(place, dpi=150)
    plt.close(chart)
    return place
