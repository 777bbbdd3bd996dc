"""The command `leito`.

The commands import what they call inside their functions, and only there: FEniCSx and compiled
kernels take seconds to load, and `leito list` or the refusal of a bad scene must not wait for them.
"""

from __future__ import annotations

import os
import sys
import traceback
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import typer

from coupled.errors import Interrupted, LeitoError

app = typer.Typer(
    help="Deformable structures that meet grains.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

USER_ERROR = 2
INTERRUPTED = 130

# Named rather than imported: importing their rooms would load FEniCSx for every command.
_ROOM_ERRORS = {
    ("meshes", "MeshError"),
    ("structure", "StructureError"),
    ("particles", "ParticleError"),
}

SceneArgument = Annotated[str, typer.Argument(help="Scene file, or the name of a scene that ships.", metavar="SCENE")]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Override one key, e.g. time.duration=1.0."),
]
PetscOption = Annotated[
    str | None,
    typer.Option(
        "--petsc",
        metavar="OPTIONS",
        help='PETSc options of the structure\'s solvers, e.g. "-leito_ksp_type cg -leito_pc_type gamg".',
    ),
]


def main() -> None:
    """Run the command line; an error of the user becomes one line and an exit code."""
    try:
        app()
    except Interrupted as stop:
        _say(str(stop))
        sys.exit(INTERRUPTED)
    except LeitoError as error:
        _say(str(error))
        sys.exit(USER_ERROR)
    except ValueError as error:
        if not _is_ours(error):
            _end_other_ranks()
            raise
        _say(str(error))
        sys.exit(USER_ERROR)
    except Exception:
        _end_other_ranks()
        raise


def _end_other_ranks() -> None:
    """After a defect of ours on one of several ranks: the others would wait for it for ever."""
    if int(os.environ.get("OMPI_COMM_WORLD_SIZE", os.environ.get("PMI_SIZE", "1"))) > 1 and "mpi4py.MPI" in sys.modules:
        traceback.print_exc()
        sys.modules["mpi4py.MPI"].COMM_WORLD.Abort(1)


def _is_ours(error: ValueError) -> bool:
    kinds = {(kind.__module__.partition(".")[0], kind.__name__) for kind in type(error).__mro__}
    return bool(kinds & _ROOM_ERRORS)


def _first_rank() -> bool:
    """Return whether this process is the one that speaks; asked without loading MPI."""
    names = ("OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK")
    return all(os.environ.get(name, "0") == "0" for name in names)


def _say(sentence: str) -> None:
    if _first_rank():
        print(f"leito: {sentence}", file=sys.stderr)


def _print_version(asked: bool) -> None:
    if asked:
        print(f"leito {version('leito')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """Deformable structures that meet grains."""


@app.command()
def run(
    scene: SceneArgument,
    out: Annotated[Path | None, typer.Option(help="Folder of the run.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the checkpoint.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace what the folder holds.")] = False,
    overrides: SetOption = None,
    threads: Annotated[int | None, typer.Option(min=1, help="Threads for the grains; all cores by default.")] = None,
    progress: Annotated[bool, typer.Option(help="Show a progress bar.")] = True,
    petsc: PetscOption = None,
) -> None:
    """Run a scene and write its results."""
    if resume and overwrite:
        raise LeitoError("--resume and --overwrite exclude each other: go on, or start anew.")
    from coupled.scene import load_scene

    loaded = load_scene(scene, overrides or ())
    _set_petsc(petsc)
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


@app.command()
def check(scene: SceneArgument, overrides: SetOption = None, petsc: PetscOption = None) -> None:
    """Validate a scene and say what a run would cost."""
    from coupled.scene import load_scene

    loaded = load_scene(scene, overrides or ())
    _set_petsc(petsc)
    from coupled.report.check import check_scene

    rows = check_scene(loaded)
    if _first_rank():
        _print_table(("", "quantity", "value"), rows)


def _set_petsc(options: str | None) -> None:
    if options is not None:
        from structure import set_solver_options

        set_solver_options(options)


@app.command("list")
def list_scenes() -> None:
    """List the scenes that ship."""
    from coupled.scene import load_scene, shipping_scenes

    rows = []
    for name, path in shipping_scenes().items():
        scene = load_scene(path)
        grains = str(scene.first_grains.count) if scene.first_grains is not None else "-"
        structure = scene.structure.kind if scene.structure is not None else "-"
        rows.append((name, grains, structure, f"{scene.time.duration:g} s", scene.title))
    _print_table(("scene", "grains", "structure", "duration", "title"), rows)


@app.command()
def new(
    kind: Annotated[str, typer.Argument(help="tube, beam or grains.", metavar="KIND")],
    to: Annotated[Path | None, typer.Option(help="File to write; KIND.toml by default.")] = None,
) -> None:
    """Write a small commented scene to start from."""
    from coupled.templates import write_template

    path = write_template(kind, to)
    print(f"wrote {path}; run it with: leito run {path}")


@app.command()
def plot(
    folder: Annotated[Path, typer.Argument(help="Folder of a run.", metavar="RUN_DIR")],
) -> None:
    """Draw the figures of a run anew."""
    if not folder.is_dir():
        raise LeitoError(f"{folder}: there is no such folder; give the folder of a run.")
    from coupled.report.figures import plot_run

    for path in plot_run(folder):
        print(path)


def _print_table(header: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    """Print rows in aligned columns, plainly, so that other programs can read them."""
    table = [header, *rows]
    widths = [max(len(row[column]) for row in table) for column in range(len(header))]
    for row in table:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        print("  ".join(cells).rstrip())


if __name__ == "__main__":
    main()
