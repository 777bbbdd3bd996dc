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
from numpy.typing import NDArray

from coupled.errors import LeitoError
from coupled.output import history
from coupled.output.folder import SCENE
from coupled.output.frames import read_frame

Floats = NDArray[np.float64]
Frame = tuple[float, dict[str, NDArray[Any]]]

FREE = -1  # body of a grain that no motion is prescribed for


class Shaken(NamedTuple):
    """What a record needs to know of the shaking: period and start [s], amplitude [m], Gamma [-]."""

    period: float
    start: float
    amplitude: float
    gamma: float


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
        if not (folder / SCENE).exists() or not (folder / history.NAME).exists():
            raise LeitoError(f"{folder} holds no run ({SCENE} and {history.NAME}); give the folder of a run")
        self.folder = folder
        self.scene: dict[str, Any] = tomllib.loads((folder / SCENE).read_text())
        self.title = str(self.scene["title"])

    @cached_property
    def history(self) -> dict[str, Floats]:
        """Columns of the history."""
        return history.read_history(self.folder / history.NAME)

    @property
    def unit(self) -> str:
        """Of lengths: "m", or "-" of a dimensionless scene."""
        return "m" if self.scene.get("units", "SI") == "SI" else "-"

    @property
    def time_unit(self) -> str:
        return "s" if self.scene.get("units", "SI") == "SI" else "-"

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

    @property
    def shaken(self) -> Shaken | None:
        """The shaking of the walls, if they shake."""
        table = self.scene.get("shaking")
        if table is None:
            return None
        step = self.scene["time"]["step"]
        period = table["period"] if "period" in table else table["period_steps"] * step
        turn = 2.0 * math.pi / period
        amplitude = table["amplitude"] if "amplitude" in table else table["gamma"] * self.gravity / turn**2
        gamma = amplitude * turn**2 / self.gravity if self.gravity else math.inf
        return Shaken(period, table.get("start", 0.0), amplitude, gamma)

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
        times = []
        for path in self.frame_paths(name):
            with h5py.File(path, "r") as file:
                times.append(float(file.attrs["time"]))
        return np.array(times)
