"""`leito measure`: what shaken grains do."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from coupled.cli.speech import print_table
from coupled.errors import LeitoError

QUIET = "quiet"


def measure(
    folders: Annotated[list[Path], typer.Argument(help="Runs, or the folder of an ensemble.", metavar="FOLDER...")],
    out: Annotated[Path | None, typer.Option(help="Where to write; absent: measures in the first folder.")] = None,
    first: Annotated[int, typer.Option(min=0, help="First period of the shaking that counts.")] = 0,
    last: Annotated[int | None, typer.Option(min=1, help="Last period; absent: to the end.")] = None,
    phase: Annotated[
        str,
        typer.Option(help="Of the period, 0 to below 1, at which heights are read; quiet: where they spread least."),
    ] = "0",
) -> None:
    """Measure what the grains of runs do, and write it as tables and pictures.

    Rises per period of the shaking, their large deviations, convection, profiles.

    Runs that differ in their seeds alone are samples of one case.
    """
    if last is not None and last <= first:
        raise LeitoError(f"--last {last} must be greater than --first {first}")
    from coupled.measuring.measure import measure as measured
    from coupled.measuring.measure import rows_told
    from coupled.measuring.rises import Periods

    found, written = measured(folders, out=out, periods=Periods(first=first, last=last, phase=_phase(phase)))
    print_table(("case", "quantity", "value"), rows_told(found))
    for note in (note for one in found for note in one.notes):
        print(f"leito: note: {note}", file=sys.stderr)
    for path in written:
        print(path)


def _phase(text: str) -> float | None:
    """A number from 0 to below 1, or None for the quietest."""
    if text == QUIET:
        return None
    try:
        phase = float(text)
    except ValueError:
        phase = -1.0
    if not 0.0 <= phase < 1.0:
        raise LeitoError(f'--phase {text} must be a number from 0 to below 1, or "{QUIET}"')
    return phase
