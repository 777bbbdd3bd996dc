"""`leito run` and `leito check`: one scene."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coupled.cli.options import (
    AccuracyOption,
    OutOption,
    OverwriteOption,
    PetscOption,
    ResumeOption,
    SceneArgument,
    SetOption,
    refuse_both,
    set_petsc,
)
from coupled.cli.speech import print_table


def run(
    scene: SceneArgument,
    out: OutOption = None,
    resume: ResumeOption = False,
    overwrite: OverwriteOption = False,
    overrides: SetOption = None,
    accuracy: AccuracyOption = None,
    threads: Annotated[int | None, typer.Option(min=1, help="Threads for the grains; all cores by default.")] = None,
    progress: Annotated[bool, typer.Option(help="Show a progress bar.")] = True,
    petsc: PetscOption = None,
) -> None:
    """Run a scene and write its results."""
    refuse_both(resume, overwrite)
    from coupled.scene import load_scene

    loaded = load_scene(scene, overrides or (), accuracy=accuracy)
    set_petsc(petsc)
    from coupled.running.run import run_scene

    run_scene(
        loaded,
        out=out if out is not None else _default_folder(scene, loaded.output.folder),
        resume=resume,
        threads=threads,
        overwrite=overwrite,
        progress=progress,
    )


def _default_folder(scene: str, folder: str | None) -> Path:
    """Return the folder of the scene file's own choice, or ``runs/<scene>``."""
    return Path(folder) if folder is not None else Path("runs") / Path(scene).stem


def check(
    scene: SceneArgument,
    overrides: SetOption = None,
    accuracy: AccuracyOption = None,
    petsc: PetscOption = None,
    measure: Annotated[bool, typer.Option("--measure", help="Take features out one by one and compare times.")] = False,
) -> None:
    """Validate a scene, say what it models, also without need, and what a run would cost."""
    from coupled.scene import load_scene

    loaded = load_scene(scene, overrides or (), accuracy=accuracy)
    set_petsc(petsc)
    from coupled.report.check import check_scene

    print_table(("", "quantity", "value"), check_scene(loaded, measure=measure))
