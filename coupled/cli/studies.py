"""`leito study`: what each knob of a scene buys."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

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


def study(
    scene: SceneArgument,
    knobs: Annotated[str | None, typer.Option(metavar="A,B", help="Knobs to turn, or none; all by default.")] = None,
    values: Annotated[
        list[str] | None, typer.Option(metavar="KNOB=A,B,C", help="Values of a knob to try, e.g. step=2,1,0.5.")
    ] = None,
    reference: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=VALUE", help="Key of the reference; by default step and mesh are refined."),
    ] = None,
    seeds: Annotated[int | None, typer.Option(metavar="N", help="Samples of every setting; 5 by default.")] = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs side by side; as cores allow by default.")] = None,
    budget: Annotated[float | None, typer.Option(metavar="SECONDS", help="Wall time of all runs together.")] = None,
    overrides: SetOption = None,
    accuracy: AccuracyOption = None,
    out: OutOption = None,
    resume: ResumeOption = False,
    overwrite: OverwriteOption = False,
    progress: Annotated[bool, typer.Option(help="Show a progress bar.")] = True,
) -> None:
    """Run a scene over its knobs and show what each buys."""
    refuse_both(resume, overwrite)
    if budget is not None and not budget > 0.0:
        raise LeitoError(f"--budget {budget:g}: must be greater than 0; give the seconds that all runs may take")
    from coupled.study.pages.table import HEADER
    from coupled.study.settings.ask import knob_names, knob_values, reference_keys
    from coupled.study.study import Wishes, run_study

    wishes = Wishes(
        overrides=tuple(overrides or ()),
        accuracy=accuracy,
        knobs=None if knobs is None else knob_names(knobs),
        values=knob_values(values or ()),
        reference=reference_keys(reference or ()),
        seeds=seeds,
        jobs=jobs,
        budget=budget,
    )
    done = run_study(
        scene,
        wishes,
        out=out or Path("runs") / "studies" / Path(scene).stem,
        resume=resume,
        overwrite=overwrite,
        progress=progress,
    )
    print_table(HEADER, done.rows())
    for line in done.without_result():
        print(line)
    print(f"written: {done.folder}/study.csv, study.md and a picture per quantity")
