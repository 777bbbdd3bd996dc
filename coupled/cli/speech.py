"""What the commands say: sentences on the error stream, tables on the output, both from the first rank alone."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from coupled.running.launch import first_rank


def say(sentence: str) -> None:
    """Print one sentence on the error stream."""
    if first_rank():
        print(f"leito: {sentence}", file=sys.stderr)


def print_table(header: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> None:
    """Print rows in aligned columns, plainly, so that other programs can read them."""
    if not first_rank():
        return
    table = [header, *rows]
    widths = [max(len(row[column]) for row in table) for column in range(len(header))]
    for row in table:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        print("  ".join(cells).rstrip())
