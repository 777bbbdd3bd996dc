"""Units in what is said of a scene: all of them in SI, none in a dimensionless one but the wall's seconds."""

from __future__ import annotations

import copy
import re
from pathlib import Path
from typing import Any

import pytest
from bad_scenes import SHAKEN, changed

from coupled.cli.scenes import list_scenes
from coupled.errors import LeitoError, QuantityError, SceneError
from coupled.quantities import evaluate
from coupled.report.check import check_scene
from coupled.running.run import run_scene
from coupled.scene import Scene, dump_scene, load_scene
from coupled.scene.quantities import ColumnValue
from coupled.scene.units import in_units

UNIT = re.compile(r"\d \(?(m|s|kg|N|J|Pa|Hz|1/s)(\^|/|\b)|\[(m|s|N|kg|J)[]/]|\bin [mNs]\b")
RECIPE = {"from_drop_height": 0.1, "max_overlap": 0.05, "restitution": 0.5}


def scene(units: str, **changes: Any) -> Scene:
    """Everything that has a unit: a recipe, shaken walls, intruders, a dashpot."""
    tables = changed(
        SHAKEN, {"units": units, "contact": {"recipe": RECIPE, "friction": 0.3}, "time.step": 2e-5, **changes}
    )
    return Scene.model_validate(tables)


@pytest.mark.parametrize(
    ("text", "bare"),
    [
        ("time.step is 2 times 0.1 s, the limit", "time.step is 2 times 0.1, the limit"),
        ("grain 3 at (0.1, -2e-3) m moves at 3 m/s, 5 more", "grain 3 at (0.1, -2e-3) moves at 3, 5 more"),
        ("4 sides of 1000 N/m, 2 N/m^(3/2) and 3 N s/m", "4 sides of 1000, 2 and 3"),
        ("must be greater than 0 (grain radius [m]), in 3 steps", "must be greater than 0 (grain radius), in 3 steps"),
        ("give it in m; a share [-] of 3 %", "give it; a share [-] of 3 %"),
    ],
)
def test_sentences_lose_their_units_and_nothing_else(text: str, bare: str) -> None:
    assert in_units(text, "dimensionless") == bare
    assert in_units(text, "SI") == text


@pytest.mark.parametrize("units", ["SI", "dimensionless"])
def test_check_tells_units_in_si_alone(units: str) -> None:
    rows = [" ".join(row) for row in check_scene(scene(units)) if row[0] != "cost"]
    told = [row for row in rows if UNIT.search(row)]
    assert (len(told) > 8) if units == "SI" else told == []


@pytest.mark.parametrize("units", ["SI", "dimensionless"])
def test_log_of_a_run_tells_units_in_si_alone(units: str, tmp_path: Path) -> None:
    late = {"name": "late", "kind": "value", "column": "time", "time": 3.0}
    asked = scene(units, **{"time.duration": 0.01, "output.figures": False, "quantities": [late]})
    out = run_scene(asked, out=tmp_path / "run", threads=1, progress=False)
    clock = re.compile(r"simulated in [\d.]+ s|wall time \[s\]")
    lines = [clock.sub("", line) for line in (out / "log.txt").read_text().splitlines()]
    told = [line for line in lines if UNIT.search(line)]
    assert any("recipe" in line for line in lines) and any("late of" in line for line in lines)
    assert (len(told) > 4) if units == "SI" else told == []


@pytest.mark.parametrize("units", ["SI", "dimensionless"])
def test_errors_tell_units_in_si_alone(units: str, tmp_path: Path) -> None:
    sound = scene(units)
    path = tmp_path / "scene.toml"
    path.write_text(dump_scene(sound))
    said = []
    for wrong in (
        "grains.sizes.0.radius=-1.0",
        "grains.sizes.0.radius=3.0",
        "output.history_interval=1e-9",
        "intruders.0.x=7.0",
    ):
        with pytest.raises(SceneError) as refused:
            load_scene(path, [wrong])
        said.append(str(refused.value))
    places = [(0.005 + 0.006 * (k % 15), 0.005 + 0.006 * (k // 15)) for k in range(49)]
    piled = copy.deepcopy(sound.model_dump(exclude_none=True)) | {"intruders": []}
    piled["grains"] |= {"layout": "list", "positions": [*places, (places[0][0] + 1e-4, places[0][1])]}
    with pytest.raises(LeitoError) as stopped:
        run_scene(Scene.model_validate(piled), out=tmp_path / "run", threads=1, progress=False)
    said.append(str(stopped.value))
    (tmp_path / "summary.json").write_text("{}")
    (tmp_path / "history.csv").write_text("time [s]\n0.0\n1.0\n")
    with pytest.raises(QuantityError) as unknown:
        evaluate(ColumnValue(name="late", column="time", time=3.0), tmp_path)
    said.append(str(unknown.value))
    assert [bool(UNIT.search(sentence)) for sentence in said] == [units == "SI"] * len(said), said


def test_list_tells_durations_in_the_units_of_the_scenes(capsys: pytest.CaptureFixture[str]) -> None:
    list_scenes()
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines()}
    assert " 615  " in lines["brazil_nut"] and re.search(r"\d s  ", lines["bed"])
