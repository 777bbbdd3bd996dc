"""`leito measure`: what shaken grains do."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from coupled.cli.speech import print_table
from coupled.errors import LeitoError


def measure(
    folders: Annotated[list[Path], typer.Argument(help="Runs, or the folder of an ensemble.", metavar="FOLDER...")],
    out: Annotated[Path | None, typer.Option(help="Where to write; absent: measures in the first folder.")] = None,
    first: Annotated[int, typer.Option(min=0, help="First period of the shaking that counts.")] = 0,
    last: Annotated[int | None, typer.Option(min=1, help="Last period; absent: to the end.")] = None,
) -> None:
    """Measure rises, convection, profiles and large deviations of shaken runs."""
    if last is not None and last <= first:
        raise LeitoError(f"--last {last} must be greater than --first {first}")
    from coupled.measuring.measure import measure as measured
    from coupled.measuring.measure import rows_told
    from coupled.measuring.rises import Periods

    found, written = measured(folders, out=out, periods=Periods(first=first, last=last))
    print_table(("case", "quantity", "value"), rows_told(found))
    for note in (note for one in found for note in one.notes):
        print(f"leito: note: {note}", file=sys.stderr)
    for path in written:
        print(path)
