"""The suite of the extremes sees what it is to see: numbers that are none, what is wrong, what hangs or dies."""

import json
import math
from dataclasses import replace
from pathlib import Path

import h5py
import pytest
from grain_time import height_is, lasting
from leito_process import LeitoProcess
from limit_search import ranges, walk
from trials import Axis, Trial
from verdict import judge, not_finite


def axis_of(trial: Trial) -> Axis:
    return Axis(part="Grains", name="one", text="", values=(1.0,), trial=lambda value: trial)


@pytest.mark.parametrize("kind", ["state.h5", "history.csv", "summary.json"])
@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_numbers_that_are_none_are_found_in_every_file(kind: str, number: float, tmp_path: Path) -> None:
    for value in (1.0, number):
        path = tmp_path / kind
        if kind == "state.h5":
            with h5py.File(path, "w") as file:
                file["grains/x"] = [0.0, value]
        elif kind == "history.csv":
            path.write_text(f"time [s],x [m]\n0.0,{value!r}\n")
        else:
            path.write_text(json.dumps({"x": value}))
        assert bool(not_finite(tmp_path)) == (value is number)


def test_a_wrong_result_is_wrong(leito: LeitoProcess, tmp_path: Path) -> None:
    trial = replace(lasting(10.0), check=lambda run: [height_is(run, -1.0)])
    verdict = judge(axis_of(trial), 1.0, leito, tmp_path / "trial")
    assert verdict.outcome == "wrong" and not verdict.good


def test_what_does_not_end_hangs_and_the_next_run_finds_a_new_process(leito: LeitoProcess, tmp_path: Path) -> None:
    trial = replace(lasting(1e12), limit=0.5)
    assert judge(axis_of(trial), 1.0, leito, tmp_path / "trial").outcome == "hangs"
    assert judge(axis_of(lasting(10.0)), 1.0, leito, tmp_path / "trial").outcome == "right"


def test_the_change_of_an_outcome_is_closed_in_on(leito: LeitoProcess, tmp_path: Path) -> None:
    """A duration is refused below one step."""
    axis = replace(axis_of(lasting(1.0)), values=(0.1, 4.0), trial=lasting, sharpen=1.05)
    found = walk(axis, leito, tmp_path / "trial")
    assert [verdict.outcome for verdict in found] == ["refused", "refused", "right", "right"]
    assert found[1].value < 1.0 <= found[2].value < 1.05 * found[1].value
    assert ranges(found, axis, "refused").startswith("0.1 to 0.9")
