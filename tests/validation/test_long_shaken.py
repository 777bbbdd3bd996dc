"""`make validate`: a shaken box for ten million steps, watched from outside, and stopped late and taken up.

Makes (or takes up) the run in `runs/validation/long`, which takes half an hour of one core, and writes
`docs/validation/long_run.md`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "coupled")]

from long_numbers import LongRun
from long_page import write
from long_run import FRAMES, LAST, LATE, RESUMED, ROWS, RUN, make, resume_late, sizes
from same_run import assert_same_run

DOCS = Path(__file__).parents[2] / "docs" / "validation"


@pytest.mark.validate
def test_ten_million_steps() -> None:
    make()
    assert LATE.exists(), f"the run was made without a copy at 99 %: remove {RUN} and make it again"
    resume_late()
    try:
        assert_same_run(RUN, RESUMED)
    except AssertionError:
        write(DOCS, same=False)
        raise
    check(write(DOCS, same=True))


def check(run: LongRun) -> None:
    """Nothing drifts, nothing grows but what was asked for."""
    assert run.summary["steps"] == LAST and len(run.steps) == LAST // ROWS + 1
    assert sizes(RUN)["frame_count"] == LAST // FRAMES + 2
    # less than a megabyte in ten million steps: the lists are as long as the bed has contacts just now
    assert abs(run.memory_slope) < 0.1
    assert run.samples["highest"].max() < 1.01 * run.begun
    # three roundings of the time, as tests/particles/test_long_runs.py
    assert np.all(np.abs(run.floor_error) < 3 * run.round_off + 1e-15)
    # the sum of some thousand rounded forces: eps times the root of their number
    assert run.history["momentum_residual"].max() < 1e-14
    # the integrator's: a tenth of what the default step, 16 times as long, is allowed in test_shaken.py
    assert run.history["ledger_relative_error"][-1] < 1e-3
