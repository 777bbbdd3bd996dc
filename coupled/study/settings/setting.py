"""One way to run a scene, and what it came to."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, Protocol

from coupled.scene import Scene

Role = Literal["base", "knob", "preset", "finer", "reference", "combination"]
Status = Literal["done", "refused", "failed", "stopped", "left out"]


class Load(Protocol):
    """Reads the scene of the study with further overrides and a preset."""

    def __call__(self, changes: tuple[str, ...] = (), accuracy: str | None = None) -> Scene: ...


@dataclass(frozen=True, kw_only=True)
class Setting:
    """A scene with some of its knobs turned.

    Parameters
    ----------
    name : str
        What tables and pictures call it.
    role : str
        "base" is the scene as it is, "finer" the next finest setting after the reference.
    knobs : tuple
        Pairs of the names of the knobs that are turned and their values as text.
    changes : tuple
        Overrides of keys, ``"time.step=1e-5"``.
    accuracy : str, optional
        Preset under the changes.
    threads : int
        For the grains.
    speed_only : bool
        Whether no bit of the results must differ from the base's.
    work : float
        Estimated cost over that of the base [-].
    """

    name: str
    role: Role
    knobs: tuple[tuple[str, str], ...] = ()
    changes: tuple[str, ...] = ()
    accuracy: str | None = None
    threads: int = 1
    speed_only: bool = False
    work: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Ran:
    """What a setting came to, over its samples.

    Parameters
    ----------
    setting : Setting
    status : str
        "done" if every sample has come to its end and has one quantity at least.
    message : str
        The sentence of a setting that was refused, failed or stopped, or why it lacks some quantities.
    values : dict
        Quantity to its value in each sample, in the order of the seeds; those that every sample has.
    wall_seconds, cpu_seconds, steps_per_second : float
        Mean over the samples of the run's own work [s, s, 1/s].
    same_bits : bool, optional
        Whether all rows of all histories are those of the base; None where that is not asked.
    """

    setting: Setting
    status: Status
    message: str = ""
    values: dict[str, tuple[float, ...]] = field(default_factory=dict)
    wall_seconds: float = float("nan")
    cpu_seconds: float = float("nan")
    steps_per_second: float = float("nan")
    same_bits: bool | None = None

    @property
    def done(self) -> bool:
        """Whether there are values."""
        return self.status == "done"

    @property
    def lacking(self) -> str:
        """What is missing of it and why, in words; empty if nothing is."""
        return self.message if self.done else f"{self.status}: {self.message}"
