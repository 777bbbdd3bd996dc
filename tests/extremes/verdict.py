"""Runs a trial and says what became of it.

Three ends are good: ``right`` (checked), ``refused`` at the start in a sentence, ``stopped`` in a sentence with the
last good state on disk. All others are defects: ``wrong`` without a word, ``not finite`` in a file, ``hangs``,
``breaks`` (a traceback, or a process that dies), ``mute`` (no sentence), ``no state`` (stopped, and the state
cannot be read).
"""

from __future__ import annotations

import csv
import json
import math
import shutil
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
import tomli_w
from leito_process import LeitoProcess, Said
from trials import Axis, Finished, Measured, Trial

from coupled.cli.app import USER_ERROR
from coupled.errors import LeitoError
from coupled.output import checkpoint
from coupled.output.folder import BEFORE_FAILURE

GOOD = ("right", "refused", "stopped")
QUIET = {"frames_per_second": 0.0, "figures": False}


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """The end of a trial at one value of an axis; `measured` is the number that is farthest from what it must be."""

    value: object
    outcome: str
    sentence: str = ""
    measured: Measured | None = None

    @property
    def good(self) -> bool:
        return self.outcome in GOOD

    def __str__(self) -> str:
        return f"{self.value}: {self.outcome}; {self.sentence or self.measured}"


def judge(axis: Axis, value: object, leito: LeitoProcess, folder: Path) -> Verdict:
    """Run the trial of a value in a folder, which is emptied before and removed after a good end."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    trial, out = axis.trial(value), folder / "run"
    output = QUIET | trial.scene.get("output", {})
    (folder / "scene.toml").write_text(tomli_w.dumps({"title": axis.name} | trial.scene | {"output": output}))
    if trial.prepare is not None:
        trial.prepare(out)
    command = ("run", str(folder / "scene.toml"), "--out", str(out), "--threads", "1", "--no-progress")
    said = leito.run(command + trial.arguments, trial.limit)
    outcome, sentence, measured = _end(trial, said, out)
    verdict = Verdict(value=value, outcome=outcome, sentence=sentence, measured=measured)
    if verdict.good:
        shutil.rmtree(folder)
    return verdict


def _end(trial: Trial, said: Said, out: Path) -> tuple[str, str, Measured | None]:
    text = said.text.strip()
    last = text.splitlines()[-1] if text else ""
    if said.code is None:
        return ("hangs" if "no answer" in text else "breaks"), text, None
    if "Traceback" in text or said.code not in (0, USER_ERROR):
        return "breaks", last, None
    if lost := not_finite(out):
        return "not finite", lost, None
    if said.code == 0:
        return _ended(trial, Finished(out), text)
    sentence = last.removeprefix("leito: ").replace(str(out) + "/", "").replace(str(out.parent) + "/", "")
    if sentence == last or len(sentence) < 20:
        return "mute", text, None
    if not (out / BEFORE_FAILURE).exists():
        ran = trial.prepare is None and (out / checkpoint.NAME).exists()
        return ("no state" if ran else "refused"), sentence, None
    try:
        checkpoint.load(out / BEFORE_FAILURE)
    except LeitoError as error:
        return "no state", str(error), None
    return "stopped", sentence, None


def _ended(trial: Trial, run: Finished, text: str) -> tuple[str, str, Measured | None]:
    """A run that came to its end: all that was to be simulated, and what the trial itself asks."""
    notes = "; ".join(line.removeprefix("leito: note: ") for line in text.splitlines() if "note: " in line)
    if stray := [line for line in text.splitlines() if not line.startswith("leito: ")]:
        return "breaks", stray[0], None  # a warning of a library is no word of ours
    time = trial.scene["time"]
    whole = Measured(
        what="simulated time [s]",
        value=run.summary["simulated_seconds"],
        expected=time["duration"],
        allowed=0.5000001 * run.summary["time_step"] * trial.scene.get("interface", {}).get("substeps", 1),
    )
    if "stop_at_rest" not in time and whole.share > 1.0:
        return "wrong", notes, whole
    worst = max(trial.check(run), key=lambda number: number.share)
    return ("right" if worst.share <= 1.0 else "wrong"), notes, worst


def not_finite(folder: Path) -> str:
    """The first number in the files of a run that is none, in words; empty without any."""
    for path in sorted(folder.rglob("*")):
        found = ""
        if path.suffix == ".h5":
            with h5py.File(path, "r") as file:
                found = _first_in(file)
        elif path.suffix == ".csv":
            with open(path, newline="") as file:
                rows = list(csv.reader(file))
            bad = [rows[0][k] for row in rows[1:] for k, cell in enumerate(row) if not math.isfinite(float(cell))]
            found = bad[0] if bad else ""
        elif path.suffix == ".json":
            lost: list[str] = []
            json.loads(path.read_text(), parse_constant=lost.append)
            found = lost[0] if lost else ""
        if found:
            return f"{path.relative_to(folder)}: {found}"
    return ""


def _first_in(file: h5py.File) -> str:
    lost: list[str] = []

    def look(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and not np.isfinite(item[()]).all():
            lost.append(name)

    file.visititems(look)
    return lost[0] if lost else ""
