"""`leito plot`: what a run has left."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coupled.errors import LeitoError


def plot(
    folder: Annotated[Path, typer.Argument(help="Folder of a run.", metavar="RUN_DIR")],
) -> None:
    """Draw the figures of a run anew."""
    if not folder.is_dir():
        raise LeitoError(f"{folder}: there is no such folder; give the folder of a run.")
    from coupled.report.figures import plot_run

    for path in plot_run(folder):
        print(path)
