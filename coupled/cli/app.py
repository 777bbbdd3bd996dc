"""The commands under one name, and what becomes of their errors."""

from __future__ import annotations

import sys
import traceback
from importlib.metadata import version
from typing import Annotated

import typer

from coupled.cli import ensembles, films, measures, results, runs, scenes, studies
from coupled.cli.speech import say
from coupled.errors import Interrupted, is_sentence
from coupled.running.launch import ranks

USER_ERROR = 2
INTERRUPTED = 130

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
app.command("ensemble")(ensembles.ensemble)
app.command("list")(scenes.list_scenes)
app.command("new")(scenes.new)
app.command("study")(studies.study)
app.command("plot")(results.plot)
app.command("measure")(measures.measure)
app.command("animate")(films.animate)


def main() -> None:
    """Run the command line; an error of the user becomes one line and an exit code."""
    try:
        app()
    except Interrupted as stop:
        say(str(stop))
        sys.exit(INTERRUPTED)
    except MemoryError as error:
        _end_other_ranks()
        say(f"there is too little memory ({error or 'none is left'}): take fewer grains or elements")
        sys.exit(USER_ERROR)
    except Exception as error:
        if not is_sentence(error):
            _end_other_ranks()
            raise
        say(str(error))
        sys.exit(USER_ERROR)


def _end_other_ranks() -> None:
    """After a defect of ours on one of several ranks: the others would wait for it for ever."""
    if ranks() > 1 and "mpi4py.MPI" in sys.modules:
        traceback.print_exc()
        sys.modules["mpi4py.MPI"].COMM_WORLD.Abort(1)
