"""A run as its files tell it: scene, history, frames one at a time."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray

from coupled.errors import LeitoError
from coupled.output import history
from coupled.output.folder import SCENE, SUMMARY, require_folder
from coupled.output.frames import read_frame
from coupled.scene.grains import USUAL_WALLS
from coupled.scene.units import in_units
from particles import Shaking

Floats = NDArray[np.float64]
Frame = tuple[float, dict[str, NDArray[Any]]]

FREE = -1  # body of a grain that no motion is prescribed for


class Shaken(NamedTuple):
    """What a record needs to know of the shaking."""

    motion: Shaking
    walls: tuple[str, ...]  # that move; the floor also where rows stand for it
    gamma: float  # Gamma [-], infinite without gravity

    @property
    def period(self) -> float:
        """[s]."""
        return self.motion.period

    @property
    def start(self) -> float:
        """When it begins [s]."""
        return self.motion.start

    @property
    def periods(self) -> int | None:
        """Number of periods with the whole amplitude or a rising one; None: it does not stop."""
        stop = self.motion.stop
        if stop is None:
            return None
        count = (stop - self.start) / self.period
        # without a ramp the period in hand is finished; one part in 1e9 for the round-off of whole periods
        return math.floor(count * (1.0 + 1e-9)) if self.motion.ramp > 0.0 else math.ceil(count * (1.0 - 1e-9))


class Record:
    """The folder of a run, read on demand.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    LeitoError
        If it holds no run.
    """

    def __init__(self, folder: Path) -> None:
        require_folder(folder)
        if not (folder / SCENE).exists() or not (folder / history.NAME).exists():
            raise LeitoError(f"{folder} holds no run ({SCENE} and {history.NAME}); give the folder of a run")
        self.folder = folder
        self.scene: dict[str, Any] = tomllib.loads((folder / SCENE).read_text())
        self.title = str(self.scene["title"])
        self._frame_times: dict[str, Floats] = {}

    @cached_property
    def history(self) -> dict[str, Floats]:
        """Columns of the history."""
        return history.read_history(self.folder / history.NAME)

    @property
    def lacks(self) -> str | None:
        """What there is of a run that has not come to its end, in words; None of one that has."""
        time, asked = self.history["time"], self.scene["time"]
        last = float(time[-1]) if len(time) else 0.0
        margin = 0.5 * float(np.median(np.diff(time))) if len(time) > 1 else 0.0  # it ends at a whole step
        at_rest = asked.get("stop_at_rest") is not None and (self.folder / SUMMARY).exists()
        if at_rest or last >= asked["duration"] - margin:
            return None
        said = f"{self.folder} ends at t = {last:g} s of {asked['duration']:g} s"
        return f"{in_units(said, self.units)}: leito run with --resume goes on with it"

    @property
    def units(self) -> str:
        """That key of the scene."""
        return str(self.scene.get("units", "SI"))

    @property
    def unit(self) -> str:
        """Of lengths: "m", or "-" of a dimensionless scene."""
        return "m" if self.units == "SI" else "-"

    @property
    def time_unit(self) -> str:
        return "s" if self.units == "SI" else "-"

    @property
    def gravity(self) -> float:
        """Magnitude [m/s2]."""
        return math.hypot(*self.scene.get("gravity", (0.0, 0.0)))

    @property
    def box(self) -> dict[str, Any] | None:
        """The table of the box."""
        table: dict[str, Any] | None = self.scene.get("box")
        return table

    @property
    def period(self) -> tuple[float | None, float | None]:
        """Lengths after which x and y repeat [m]."""
        box = self.box or {}
        axes = box.get("periodic", ())
        return (box["width"] if "x" in axes else None, box["height"] if "y" in axes else None)

    @cached_property
    def shaken(self) -> Shaken | None:
        """The shaking of the walls, if they shake."""
        table = self.scene.get("shaking")
        if table is None:
            return None
        step = self.scene["time"]["step"]
        period = table["period"] if "period" in table else table["period_steps"] * step
        turn = 2.0 * math.pi / period
        amplitude = table["amplitude"] if "amplitude" in table else table["gamma"] * self.gravity / turn**2
        from_rest = table.get("waveform", "cosine") == "cosine"
        motion = Shaking(
            amplitude=amplitude,
            period=period,
            direction=(1.0, 0.0) if table.get("direction", "y") == "x" else (0.0, 1.0),
            from_rest=from_rest,
            start=table.get("start", 0.0),
            stop=table.get("stop"),
            ramp=table.get("ramp", 0.0 if from_rest else period),
        )
        gamma = amplitude * turn**2 / self.gravity if self.gravity else math.inf
        standing = (self.box or {}).get("walls", USUAL_WALLS if self.box else ())
        walls = tuple(table.get("walls") or standing)
        if "floor" not in standing and any(row.get("shaken", True) for row in self.scene.get("rows", ())):
            walls += ("floor",)
        return Shaken(motion, walls, gamma)

    def moved(self, time: ArrayLike, *walls: str) -> Floats:
        """How far walls have gone at times (...) [s]: (..., 2) [m]; zero unless all of them shake."""
        shaken, times = self.shaken, np.asarray(time, float)
        if shaken is None or not set(walls) <= set(shaken.walls):
            return np.zeros((*times.shape, 2))
        return np.multiply.outer(shaken.motion.displacement(times), shaken.motion.along)

    def box_moved(self, time: ArrayLike) -> Floats:
        """How far the box has gone at times (...) [s]: (..., 2) [m], along with its sides and with its floor."""
        along, up = self.moved(time, "left", "right")[..., 0], self.moved(time, "floor")[..., 1]
        return np.stack([along, up], axis=-1)

    @property
    def intruders(self) -> int:
        """Number of grains that the history follows."""
        return len(self.scene.get("intruders", ()))

    def intruder_places(self, body: NDArray[Any]) -> NDArray[np.int64]:
        """Where the intruders stand in a frame whose grains have the bodies (n,): last of the free ones."""
        free = np.nonzero(body == FREE)[0]
        return free[len(free) - self.intruders :]

    def frame_paths(self, name: str) -> list[Path]:
        """Frames of "grains" or "structure", in time."""
        return sorted((self.folder / "frames").glob(f"{name}.*.h5"))

    def frames(self, name: str, every: int) -> Iterator[Frame]:
        """Time [s] and arrays of every n-th frame, one at a time."""
        for path in self.frame_paths(name)[::every]:
            yield read_frame(path)

    def frame_times(self, name: str) -> Floats:
        """Times of all frames [s]."""
        if name not in self._frame_times:
            times = []
            for path in self.frame_paths(name):
                with h5py.File(path, "r") as file:
                    times.append(float(file.attrs["time"]))
            self._frame_times[name] = np.array(times)
        return self._frame_times[name]
