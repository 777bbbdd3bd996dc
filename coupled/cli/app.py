"""The commands under one name, and what becomes of their errors."""

from __future__ import annotations

import os
import sys
import traceback
from importlib.metadata import version
from typing import Annotated

import typer

from coupled.cli import results, runs, scenes
from coupled.cli.speech import say
from coupled.errors import Interrupted, LeitoError

USER_ERROR = 2
INTERRUPTED = 130

# Named rather than imported: importing their rooms would load FEniCSx for every command.
_ROOM_ERRORS = {
    ("meshes", "MeshError"),
    ("structure", "StructureError"),
    ("particles", "ParticleError"),
}

app = typer.Typer(
    help="Deformable structures that meet grains.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


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


# The order is that of the help.
app.command("run")(runs.run)
app.command("check")(runs.check)
app.command("list")(scenes.list_scenes)
app.command("new")(scenes.new)
app.command("plot")(results.plot)


def main() -> None:
    """Run the command line; an error of the user becomes one line and an exit code."""
    try:
        app()
    except Interrupted as stop:
        say(str(stop))
        sys.exit(INTERRUPTED)
    except LeitoError as error:
        say(str(error))
        sys.exit(USER_ERROR)
    except ValueError as error:
        if not _is_ours(error):
            _end_other_ranks()
            raise
        say(str(error))
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
