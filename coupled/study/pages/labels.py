"""Words beside the markers of a picture, where they hide least."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from coupled.report.drawing import Axes

SIZE = 6.5  # points
GAP = 5.0  # points between a marker's middle and its words


class Label(NamedTuple):
    """Words at a point in the data's coordinates."""

    text: str
    x: float
    y: float
    bold: bool = False


class _Box(NamedTuple):
    left: float
    bottom: float
    right: float
    top: float

    def overlap(self, other: _Box) -> float:
        width = min(self.right, other.right) - max(self.left, other.left)
        height = min(self.top, other.top) - max(self.bottom, other.bottom)
        return max(width, 0.0) * max(height, 0.0)


def write_labels(axes: Axes, labels: Sequence[Label]) -> None:
    """Write each label on that side of its point where it covers least of the markers and of other labels.

    The limits of the axes must be set.
    """
    points = 72.0 / axes.figure.dpi  # per pixel
    places = [axes.transData.transform((label.x, label.y)) * points for label in labels]
    taken = [_Box(x - GAP, y - GAP, x + GAP, y + GAP) for x, y in places]
    for label, (x, y) in zip(labels, places, strict=True):
        if not label.text:
            continue
        width, height = 0.58 * SIZE * len(label.text), 1.2 * SIZE
        sides = []
        for across, up in ((1, 1), (1, -1), (-1, 1), (-1, -1), (1, 2.4), (-1, 2.4), (1, -2.4), (-1, -2.4)):
            left = x + GAP if across > 0 else x - GAP - width
            bottom = y + up * GAP - (0.0 if up > 0 else height)
            sides.append((_Box(left, bottom, left + width, bottom + height), across, up))
        box, across, up = min(sides, key=lambda side: sum(side[0].overlap(other) for other in taken))
        taken.append(box)
        axes.annotate(
            label.text, (label.x, label.y), xytext=(across * GAP, up * GAP), textcoords="offset points", fontsize=SIZE,
            ha="left" if across > 0 else "right", va="bottom" if up > 0 else "top",
            fontweight="bold" if label.bold else "normal",
        )  # fmt: skip
