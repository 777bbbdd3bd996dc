"""The program at its extremes: right, refused or stopped, and nothing else."""

from pathlib import Path
from typing import Any

import pytest
from all_axes import AXES
from leito_process import LeitoProcess
from limit_search import defects, walk
from limits_page import page
from trials import Axis
from verdict import judge

PAGE = Path(__file__).parents[2] / "docs" / "validation" / "extremes.md"
QUICK = [pytest.param(axis, value, id=f"{axis.name}, {axis.show(value)}") for axis in AXES for value in axis.quick]


@pytest.mark.parametrize(("axis", "value"), QUICK)
def test_end_of_a_run(axis: Axis, value: Any, leito: LeitoProcess, tmp_path: Path) -> None:
    verdict = judge(axis, value, leito, tmp_path / "trial")
    assert verdict.outcome == axis.quick[value], str(verdict)


@pytest.mark.validate
def test_map_of_the_limits(leito: LeitoProcess, tmp_path: Path) -> None:
    """Writes the page, whatever is found on the way."""
    found = [(axis, walk(axis, leito, tmp_path / "trial")) for axis in AXES]
    PAGE.write_text(page(found))
    bad = [f"{axis.name} {verdict}" for axis, verdicts in found for verdict in defects(verdicts)]
    assert not bad, "\n".join(bad)
