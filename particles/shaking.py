"""Walls and prescribed grains that move to and fro."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particles.errors import ParticleError, require
from particles.kernels.layout import ShakingNumbers, WallArrays
from particles.kernels.shaking import displacements
from particles.state import Floats, Grains
from particles.walls import Wall


@dataclass(frozen=True, kw_only=True)
class Shaking:
    """Harmonic motion of all walls that are `shaken`, and of prescribed bodies, along one line.

    With ``u = (t - start)/period`` the displacement is ``A (1 - cos 2 pi u)``, from the lowest point and from rest,
    or ``A sin 2 pi u``, times an envelope that rises within `ramp` from `start` on and falls within `ramp` from
    `stop` on. It follows from the number of the step, not from a sum of increments: no drift, and the
    same after any number of steps to the round-off of t/period. The velocity that contacts see
    is the difference of two displacements over the step. Model 4.

    Parameters
    ----------
    amplitude : float
        A [m], half the stroke.
    period : float
        [s].
    direction : (2,) floats
        Of a positive displacement; normalised here.
    from_rest : bool
        The waveform 1 - cos; else sin, whose velocity jumps by ``2 pi A/period`` at the start unless there is a ramp.
    start : float
        When it begins [s].
    stop : float, optional
        When it ends [s]: with a ramp the envelope falls from then on, without one the period in hand is finished.
    ramp : float
        How long the envelope rises and falls [s], by ``3 s^2 - 2 s^3``; 0: at once.
    bodies : tuple of int
        Numbers of the prescribed bodies (`Grains.with_prescribed`) that move along. Their place at no displacement
        is that at which the system gets them; contacts see their velocity, and their work is `work_by`.
    """

    amplitude: float
    period: float
    direction: tuple[float, float] = (0.0, 1.0)
    from_rest: bool = True
    start: float = 0.0
    stop: float | None = None
    ramp: float = 0.0
    bodies: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        require("shaking amplitude", self.amplitude, above=0.0)
        require("shaking period", self.period, above=0.0)
        require("shaking start", self.start, at_least=0.0)
        require("shaking ramp", self.ramp, at_least=0.0)
        if self.stop is not None:
            require("shaking stop", self.stop, above=self.start)
        for number in self.direction:
            require("shaking direction", number)
        if not math.hypot(*self.direction) > 0.0:
            raise ParticleError("shaking direction must not be zero: give (0, 1) for up and down")

    @property
    def along(self) -> tuple[float, float]:
        """Unit vector of a positive displacement."""
        length = math.hypot(*self.direction)
        return (self.direction[0] / length, self.direction[1] / length)

    def displacement(self, time: ArrayLike) -> Floats:
        """Displacement [m] at times [s] of any shape."""
        times = np.asarray(time, float)
        return displacements(self.numbers(()), times.ravel()).reshape(times.shape)[()]

    def numbers(self, walls: Sequence[Wall], grains: Grains | None = None) -> ShakingNumbers:
        """What the kernels need, for the walls and the grains of a system."""
        for wall in walls:
            if wall.shaken and any(wall.velocity):
                raise ParticleError(
                    f"{wall.name} is shaken and has a velocity of its own, {wall.velocity}: leave out one of them"
                )
        carried = self._carried(grains)
        home = np.array([wall.point for wall in walls], float).reshape(-1, 2)
        return ShakingNumbers(
            moves=np.array([wall.shaken for wall in walls], bool),
            home_x=home[:, 0].copy(),
            home_y=home[:, 1].copy(),
            carried=carried if len(carried) else None,
            carried_x=np.zeros(0) if grains is None else grains.x[carried],
            carried_y=np.zeros(0) if grains is None else grains.y[carried],
            along_x=self.along[0],
            along_y=self.along[1],
            amplitude=float(self.amplitude),
            period=float(self.period),
            start=float(self.start),
            stop=self._last(),
            ramp=float(self.ramp),
            from_rest=bool(self.from_rest),
        )

    def _carried(self, grains: Grains | None) -> NDArray[np.int64]:
        """Places of the prescribed grains that move along."""
        if grains is None or not self.bodies:
            return np.zeros(0, np.int64)
        there = grains.bodies()
        for body in self.bodies:
            if body not in there:
                raise ParticleError(f"shaking moves body {body}, which no prescribed grain has: there are {[*there]}")
        return np.nonzero(np.isin(grains.body, self.bodies))[0]

    def _last(self) -> float:
        """When the envelope begins to fall, or without a ramp when the last whole period is over [s]."""
        if self.stop is None:
            return math.inf
        if self.ramp > 0.0:
            return float(self.stop)
        # one part in 1e9 keeps a stop at a whole number of periods from adding another by round-off
        periods = math.ceil((self.stop - self.start) / self.period * (1.0 - 1e-9))
        return self.start + periods * self.period


def shaking_of(shaking: Shaking | None, walls: Sequence[Wall], grains: Grains) -> ShakingNumbers | None:
    """What the kernels need of the shaking; refused if there is nothing to shake, or walls and no shaking."""
    shaken = [wall.name for wall in walls if wall.shaken]
    if shaking is None:
        if shaken:
            raise ParticleError(f"{shaken[0]} is shaken, but nothing says how: give shaking=Shaking(...)")
        return None
    if not shaken and not shaking.bodies:
        raise ParticleError("shaking moves no wall: give Wall(..., shaken=True), or Shaking(..., bodies=...)")
    return shaking.numbers(walls, grains)


def set_out(shaking: ShakingNumbers | None, walls: WallArrays, grains: Grains, time_step: float) -> None:
    """Give what shakes the velocity with which it sets out at the time 0: that of a sine jumps there.

    A difference of order 2 to one side, which is 0 for a start from rest.
    """
    if shaking is None:
        return
    near, far = displacements(shaking, time_step * np.array([1.0, 2.0]))
    speed = (4.0 * near - far) / (2.0 * time_step)
    walls.vx[shaking.moves], walls.vy[shaking.moves] = speed * shaking.along_x, speed * shaking.along_y
    if shaking.carried is not None:
        grains.vx[shaking.carried], grains.vy[shaking.carried] = speed * shaking.along_x, speed * shaking.along_y
