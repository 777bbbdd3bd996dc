"""What the pictures of the measures have in common."""

from __future__ import annotations

from collections.abc import Sequence

from coupled.measuring.findings import Findings

WIDTH = 7.0  # inches
COLOURS = ("#1f5a94", "#c1440e", "#2a9d8f", "#7b4b94", "#e09f3e", "#5d6d7e")


def title(found: Sequence[Findings]) -> str:
    """The title of the one scene, or the number of cases."""
    return found[0].group.records[0].title if len(found) == 1 else f"{len(found)} cases"


def length(found: Sequence[Findings], text: str) -> str:
    """A label of lengths, with the unit that the scenes have."""
    unit = found[0].group.records[0].unit
    return text if unit == "-" else f"{text} [{unit}]"
