"""Numbers of the long run: what is in its folder, and in what was noted from outside."""

from __future__ import annotations

import json
from fractions import Fraction
from functools import cached_property
from pathlib import Path

import numpy as np
from long_run import AT, LAST, LATE, PERIOD, RESUMED_SAMPLES, ROWS, RUN, SAMPLES, SETTLING, STEP
from numpy.typing import NDArray

from coupled.campaign.statistics import Interval, confidence
from coupled.output import checkpoint
from coupled.output.history import read_history
from coupled.scene import Scene, load_scene

Floats = NDArray[np.float64]


class LongRun:
    """What is in the folder of the run and in the samples from outside."""

    @cached_property
    def samples(self) -> NDArray[np.void]:
        """What was noted of the process between its first row and its last."""
        return _noted(SAMPLES, ROWS)

    @cached_property
    def resumed(self) -> NDArray[np.void]:
        """The same of the process that took up the copy."""
        return _noted(RESUMED_SAMPLES, AT + ROWS)

    @cached_property
    def history(self) -> dict[str, Floats]:
        return read_history(RUN / "history.csv")

    @cached_property
    def summary(self) -> dict[str, float]:
        return json.loads((RUN / "summary.json").read_text())

    @cached_property
    def steps(self) -> NDArray[np.int64]:
        """Of the rows of the history."""
        return np.rint(self.history["time"] / float(STEP)).astype(np.int64)

    @property
    def gamma(self) -> float:
        return self._scene.shaking.gamma

    @cached_property
    def speed(self) -> float:
        """Largest velocity of the floor."""
        return self._amplitude * 2.0 * np.pi / self._scene.shaking.period

    @cached_property
    def floor_error(self) -> Floats:
        """Place of the floor less its closed form in exact arithmetic, at each row."""
        dt, motion = Fraction(float(STEP)), self._scene.shaking
        turns = [(step * dt - Fraction(motion.start)) / Fraction(motion.period) for step in self.steps.tolist()]
        turned = np.array([float(turn % 1) if turn > 0 else 0.0 for turn in turns])
        return self.history["floor_y"] - 2.0 * self._amplitude * np.sin(np.pi * turned) ** 2

    @property
    def round_off(self) -> Floats:
        """What the round-off of the time moves the floor by, at each row."""
        return self.speed * np.spacing(self.history["time"])

    @cached_property
    def ends(self) -> NDArray[np.bool_]:
        """Rows at the ends of periods, the beginning of the shaking the first."""
        return (self.steps >= SETTLING) & (self.steps % PERIOD == 0)

    def rows(self, hundred: int) -> NDArray[np.bool_]:
        """Rows of the first hundred periods, the second, ..."""
        first = SETTLING + 100 * hundred * PERIOD
        return (self.steps > first) & (self.steps <= first + 100 * PERIOD)

    def work(self, hundred: int) -> Interval:
        """Work of the floor and the walls in a period, the bed answering in twice its period."""
        works = np.diff(self.history["walls_work"][self.ends][::2]) / 2.0
        return confidence(works[50 * hundred : 50 * hundred + 50])

    def mean(self, name: str, hundred: int) -> Interval:
        """A column of the history, likewise."""
        return confidence(self.history[name][self.rows(hundred)].reshape(50, -1).mean(axis=1))

    @property
    def begun(self) -> float:
        """Resident memory at a tenth of the way [B]."""
        return float(self.samples["resident"][self.samples["step"] > LAST / 10][0])

    @cached_property
    def memory_slope(self) -> float:
        """Bytes per step of the resident memory, over the second half of the way."""
        late = self.samples[self.samples["step"] > LAST / 2]
        return float(np.polyfit(late["step"], late["resident"], 1)[0])

    def lists(self) -> tuple[float, float]:
        """New contact lists per period until the copy, the settling included, and from there to the end."""
        before, after = (
            int(checkpoint.load(folder / checkpoint.NAME)[0]["particles.counters"][1]) for folder in (LATE, RUN)
        )
        return before / (AT / PERIOD), (after - before) / ((LAST - AT) / PERIOD)

    @cached_property
    def _scene(self) -> Scene:
        return load_scene(RUN / "scene.toml")

    @property
    def _amplitude(self) -> float:
        return self._scene.shaking.amplitude_of(self._scene.shaking.period, self._scene.gravity)


def _noted(path: Path, first: int) -> NDArray[np.void]:
    """Rows from a step on, until the end, where the summary is written."""
    rows = np.genfromtxt(path, delimiter=",", names=True, deletechars="", ndmin=1)
    return rows[(rows["step"] >= first) & (rows["step"] < LAST)]
