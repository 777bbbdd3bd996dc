"""`leito ensemble`: a scene over seeds and a grid of keys."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coupled.cli.options import (
    AccuracyOption,
    OutOption,
    OverwriteOption,
    ResumeOption,
    SceneArgument,
    SetOption,
    refuse_both,
)
from coupled.cli.speech import print_table
from coupled.errors import LeitoError
from coupled.running.launch import ranks

if TYPE_CHECKING:
    from coupled.ensemble.gather import Mean, Result


def ensemble(
    scene: SceneArgument,
    samples: Annotated[int, typer.Option(help="Seeds of each combination, from the scene's own on.")] = 1,
    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=A,B,C", help="Values of a key; several keys: each with every other."),
    ] = None,
    overrides: SetOption = None,
    accuracy: AccuracyOption = None,
    out: OutOption = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Samples at a time; cores over threads by default.")] = None,
    threads: Annotated[int, typer.Option(min=1, help="Threads for the grains of each sample.")] = 1,
    resume: ResumeOption = False,
    overwrite: OverwriteOption = False,
    progress: Annotated[bool, typer.Option(help="Show a progress bar.")] = True,
) -> None:
    """Run a scene over seeds and a grid of keys, and tell the means with their confidence."""
    refuse_both(resume, overwrite)
    if jobs is not None and ranks() > 1:
        raise LeitoError("--jobs is for processes; under mpirun each rank but the first takes a sample at a time.")
    from coupled.campaign.worker import limit_threads

    limit_threads(threads)
    from coupled.ensemble.samples import samples_of

    place = out if out is not None else Path("runs") / "ensembles" / Path(scene).stem
    asked = samples_of(
        scene,
        samples,
        vary=vary or (),
        overrides=overrides or (),
        accuracy=accuracy,
        out=place,
        threads=threads,
        shared=Path("runs") if out is None else place,
    )
    from coupled.ensemble.ensemble import run_ensemble

    results, means = run_ensemble(asked, out=place, workers=jobs, resume=resume, overwrite=overwrite, progress=progress)
    _tell(results, means, place)


def _tell(results: list[Result], means: list[Mean], out: Path) -> None:
    """Print the means, what is left out of them, and the files."""
    from coupled.ensemble.gather import MEANS, TABLE, table

    print_table(*table(results, means))
    lacking = [(result.sample.task.name, sentence) for result in results for sentence in result.unknown]
    failed = [(r.sample.task.name, r.outcome.message) for r in results if r.outcome.status == "failed"]
    if failed or lacking:
        print_table(("sample", "is left out, because"), [*failed, *lacking])
    print_table(("file", ""), [(str(out / TABLE), "a row per sample"), (str(out / MEANS), "the means")])
    if failed:
        raise LeitoError(f"{len(failed)} of {len(results)} samples failed and are left out of the means.")
