"""`leito animate`: a run as a film."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def animate(
    folder: Annotated[Path, typer.Argument(help="Folder of a run.", metavar="RUN_DIR")],
    out: Annotated[
        Path | None,
        typer.Option(help="A .gif, or an .mp4, which needs ffmpeg; absent: figures/animation.gif of the run."),
    ] = None,
    every: Annotated[int | None, typer.Option(min=1, help="Show every n-th frame; absent: 200 in all.")] = None,
    seconds: Annotated[float | None, typer.Option(min=0.1, help="Length of the film [s]; absent: 10 at most.")] = None,
) -> None:
    """Draw the frames of a run as a film.

    Grains have the colour of their layer at the start, intruders are red.
    """
    from coupled.report.animation import animate as film

    print(film(folder, out=out, every=every, seconds=seconds))
