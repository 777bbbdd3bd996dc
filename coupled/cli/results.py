"""`leito plot`: what a run has left."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def plot(
    folder: Annotated[Path, typer.Argument(help="Folder of a run.", metavar="RUN_DIR")],
) -> None:
    """Draw the figures of a run anew."""
    from coupled.output.folder import require_folder
    from coupled.report.figures import plot_run

    require_folder(folder)
    for path in plot_run(folder):
        print(path)
