"""One run of many, and what came of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from coupled.scene import Scene

Status = Literal["done", "failed", "stopped"]


@dataclass(frozen=True, kw_only=True)
class Task:
    """A run that is to be made.

    Parameters
    ----------
    name : str
        What the user knows it by.
    scene : Scene
    folder : Path
        Of its results.
    threads : int
        For its grains.
    shared : Path, optional
        Folder whose `beds` it shares with other runs; the one above `folder` by default.
    """

    name: str
    scene: Scene
    folder: Path
    threads: int = 1
    shared: Path | None = None


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What came of a task.

    Parameters
    ----------
    task : Task
    status : str
        "done": its summary is there; "failed": `message` says why; "stopped": the user asked for it, and what
        was begun has a checkpoint.
    message : str
        One sentence, empty where it is done.
    wall_seconds, cpu_seconds : float
        Wall time and processor time of its steps and their output, without loading, compiling, building and
        settling a bed [s]; NaN where it is not done, and of runs of versions that did not count it.
    """

    task: Task
    status: Status
    message: str = ""
    wall_seconds: float = float("nan")
    cpu_seconds: float = float("nan")
