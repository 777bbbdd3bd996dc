"""What is tried: a scene at one value of an axis, and how its result is judged."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coupled.output import checkpoint
from coupled.output.history import read_history

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Measured:
    """A number of a run against what it must be, right if the two differ by no more than `allowed`."""

    what: str
    value: float
    expected: float
    allowed: float

    @property
    def share(self) -> float:
        """Difference over what is allowed; infinite if the number is none."""
        off = abs(self.value - self.expected)
        if not np.isfinite(off):
            return np.inf
        return off / self.allowed if self.allowed > 0.0 else (np.inf if off else 0.0)

    def __str__(self) -> str:
        return f"{self.what} {self.value:.6g}, expected {self.expected:.6g} to {self.allowed:.2g}"


@dataclass(frozen=True)
class Finished:
    """The folder of a run that has come to its end."""

    folder: Path

    @cached_property
    def history(self) -> dict[str, Floats]:
        """Columns by name."""
        return read_history(self.folder / "history.csv")

    @cached_property
    def summary(self) -> dict[str, Any]:
        return json.loads((self.folder / "summary.json").read_text())

    @cached_property
    def state(self) -> dict[str, NDArray[Any]]:
        """The last checkpoint."""
        return checkpoint.load(self.folder / checkpoint.NAME)[0]

    def grains(self, name: str) -> Floats:
        """An array of the free grains at the end, in the order of the scene."""
        free = int(self.state["particles.grains.n_free"])
        values = np.empty(free)
        values[self.state["particles.grains.number"][:free]] = self.state[f"particles.grains.{name}"][:free]
        return values


Check = Callable[[Finished], Sequence[Measured]]


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One run of the command.

    Attributes
    ----------
    scene : dict
        Tables of the scene file. Output defaults to few rows, no frames and no figures.
    check : callable
        Of a run that ends: numbers against a closed form, a conservation law, a reference or a scaling law.
    prepare : callable, optional
        Puts into the folder of the run what is to be there before, for `arguments` such as ``--resume``.
    limit : float
        Wall time [s] beyond which the run hangs; kernels may have to be compiled first.
    """

    scene: dict[str, Any]
    check: Check
    prepare: Callable[[Path], None] | None = None
    arguments: tuple[str, ...] = ()
    limit: float = 300.0


@dataclass(frozen=True, kw_only=True)
class Axis:
    """A direction in which the program is pushed.

    Attributes
    ----------
    part : str
        Heading of the page under which it stands: "Grains", "Structure", "Coupling".
    name : str
        What grows along it, with its unit.
    text : str
        The scene, and against what it is checked: one or two sentences of the page.
    values : tuple
        Tried by ``make validate``, in their order.
    trial : callable
        Of a value.
    quick : dict
        Tried by ``make test``: outcome expected, by value.
    sharpen : float, optional
        Values are positive numbers: the place where the outcome changes between two of them is found to this ratio.
    show : callable
        A value in words.
    """

    part: str
    name: str
    text: str
    values: tuple[Any, ...]
    trial: Callable[[Any], Trial]
    quick: dict[Any, str] = field(default_factory=dict)
    sharpen: float | None = None
    show: Callable[[Any], str] = lambda value: value if isinstance(value, str) else f"{value:.4g}"
