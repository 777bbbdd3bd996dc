"""A saved state seen with a smaller time step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coupled.errors import LeitoError

STEP = "run.step"  # of the grains [s], in a saved state
FORMER_STEP = "run.former_step"  # [s], in one that was made finer
COUNTERS = ("model.steps_done", "structure.steps", "particles.counters")  # the first number of each
ROUND_OFF = 1e-6


def with_finer_step(
    saved: Mapping[str, NDArray[Any]], step: float, gravity: tuple[float, float]
) -> Mapping[str, NDArray[Any]]:
    """A state made with the time step `saved[STEP]`, to go on with `step` [s]; itself if the two are the same.

    Counts of steps are multiplied, so that the time stays. Velocities of the leapfrog stand half a
    step after the positions: they are taken back by half the difference of the steps with the present
    forces. Global damping is left out of that: a relative error of its rate times the step.

    Raises
    ------
    LeitoError
        If the old step is no whole multiple of the new one.
    """
    former = float(saved.get(STEP, step))
    times = round(former / step)
    if times < 1 or abs(former - times * step) > ROUND_OFF * former:
        raise LeitoError(
            f"time.step = {step:g} s cannot take up a state of {former:g} s per step: take a whole fraction of it, "
            f"such as {former / 2:g} s"
        )
    if times == 1:
        return saved
    finer = {name: np.array(array) for name, array in saved.items()}
    for name in COUNTERS:
        if name in finer:
            finer[name].ravel()[0] *= times
    if "particles.grains.vx" in finer:
        _take_back(finer, 0.5 * (former - step), gravity)
        for name in ("lead_x", "lead_y", "lead_spin"):
            if f"particles.grains.{name}" in finer:
                finer[f"particles.grains.{name}"] /= times
    finer[STEP], finer[FORMER_STEP] = np.array(step), np.array(former)
    return finer


def _take_back(saved: dict[str, NDArray[Any]], interval: float, gravity: tuple[float, float]) -> None:
    """Velocities of the free grains `interval` [s] earlier."""

    def of(name: str) -> NDArray[Any]:
        return saved[f"particles.grains.{name}"][: int(saved["particles.grains.n_free"])]

    for axis, weight in zip("xy", gravity, strict=True):
        of(f"v{axis}")[:] -= interval * (of(f"f{axis}") * of("inverse_mass") + weight)
    of("omega")[:] -= interval * of("torque") * of("inverse_inertia")
