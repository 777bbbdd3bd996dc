"""Arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coupled.errors import LeitoError

SceneArgument = Annotated[str, typer.Argument(help="Scene file, or the name of a scene that ships.", metavar="SCENE")]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Override one key, e.g. time.duration=1.0."),
]
AccuracyOption = Annotated[
    str | None,
    typer.Option(metavar="PRESET", help="draft, standard or reference, instead of what the scene asks for."),
]
PetscOption = Annotated[
    str | None,
    typer.Option(
        "--petsc",
        metavar="OPTIONS",
        help='PETSc options of the structure\'s solvers, e.g. "-leito_ksp_type cg -leito_pc_type gamg".',
    ),
]
OutOption = Annotated[Path | None, typer.Option(help="Folder of the results.")]
ResumeOption = Annotated[bool, typer.Option("--resume", help="Go on from the checkpoint.")]
OverwriteOption = Annotated[bool, typer.Option("--overwrite", help="Replace what the folder holds.")]


def refuse_both(resume: bool, overwrite: bool) -> None:
    """Refuse `--resume` together with `--overwrite`."""
    if resume and overwrite:
        raise LeitoError("--resume and --overwrite exclude each other: go on, or start anew.")


def set_petsc(options: str | None) -> None:
    """Give PETSc the options of `--petsc`."""
    if options is not None:
        from structure import set_solver_options

        set_solver_options(options)
