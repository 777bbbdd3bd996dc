"""Run the samples of an ensemble and gather what they came to."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from coupled.campaign import Outcome, run_all
from coupled.ensemble.gather import Mean, Result, means_of, result_of, write_tables
from coupled.ensemble.samples import Sample
from coupled.errors import Interrupted
from coupled.running.launch import first_rank


def run_ensemble(
    samples: Sequence[Sample],
    *,
    out: Path,
    workers: int | None = None,
    resume: bool = False,
    overwrite: bool = False,
    progress: bool = True,
) -> tuple[list[Result], list[Mean]]:
    """Run samples side by side, write their tables into `out` and return them.

    Under mpirun all ranks call this, and all have the results.

    Parameters
    ----------
    workers : int, optional
        Samples at a time; see `coupled.campaign.run_all`.
    resume, overwrite : bool
        Reuse what `out` holds, or make all anew.

    Raises
    ------
    Interrupted
        After Ctrl-C; no table is written.
    LeitoError
        If `out` holds samples and neither `resume` nor `overwrite` is given, or samples of another scene.
    """
    tasks = [sample.task for sample in samples]
    outcomes = run_all(tasks, workers=workers, progress=progress, resume=resume, overwrite=overwrite)
    _require_unstopped(outcomes)
    results = [result_of(sample, outcome) for sample, outcome in zip(samples, outcomes, strict=True)]
    means = means_of(results)
    if first_rank():
        write_tables(results, means, out)
    return results, means


def _require_unstopped(outcomes: Sequence[Outcome]) -> None:
    done = sum(outcome.status == "done" for outcome in outcomes)
    if any(outcome.status == "stopped" for outcome in outcomes):
        raise Interrupted(
            f"stopped with {done} of {len(outcomes)} runs done, the others keep their checkpoints; go on with --resume"
        )
