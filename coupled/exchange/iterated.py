"""The iterated exchange: a window is run again from a snapshot until grains and structure agree on its end."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coupled.errors import ExchangeError
from coupled.exchange.secants import Secants

if TYPE_CHECKING:
    from coupled.model import Model, Snapshot

Floats = NDArray[np.float64]
JUMP = 0.01  # of the boundary's motion, by which it may remain uncertain where the force of a new contact jumps
ROUND_OFF = 1e-13  # of the largest coordinate: a change that small is not the exchange's


@dataclass(frozen=True, kw_only=True)
class Iteration:
    """When an iterated window is finished.

    Parameters
    ----------
    tolerance : float
        Largest change of the boundary by a further iteration, over its largest motion in the window [-]. It is the
        share of the interface's work that the two sides may disagree about.
    most : int
        Iterations after which a window that has not come that far ends the run.
    """

    tolerance: float = 1e-6
    most: int = 20


class IteratedExchange:
    """The exchange that is solved for: the boundary at a window's end under the forces that it causes.

    The grains go through the window with the boundary on its way to a guess, the structure steps under their
    forces to where these take it, and the guess is corrected by the difference (`Secants`). Grains and structure
    go back to the window's beginning each time.

    The force that the structure gets at a window's end is f_k, that of the last grain step, without sub-cycling.
    With k substeps it is the g1 for which ``(g0 + g1)/2`` is the trapezoidal mean of the k + 1 forces of the
    window, ``f_mean + (f_0 - f_k)/(2 k)``: a scheme that sees only the mean of both ends takes up momentum and work
    of the grains exactly as they gave them. Schemes that dissipate see more than that mean; they get
    ``f_mean + (f_k - f_0)/2``.

    Parameters
    ----------
    model : Model
        With grains on rank 0, structure and interface.
    iteration : Iteration

    Attributes
    ----------
    trials : int
        Runs of windows so far.
    unsettled, farthest : int, float
        Windows that could not be settled to the tolerance, and the farthest any was off [-].
    """

    def __init__(self, model: Model, iteration: Iteration) -> None:
        self._model, self._wanted = model, iteration
        points = model.structure.polyline.points
        self._noise = ROUND_OFF * float(np.abs(points).max())
        self._secants = Secants(points.size, self._noise)
        self._before: Snapshot | None = None
        self._given, self._velocity = model.nodal_force, model.structure.boundary_velocity
        scheme = getattr(model.structure, "scheme", None)  # rigid bodies have none and keep the mean
        self._keeps_means = scheme is None or scheme.conserves
        self.trials = self.unsettled = 0
        self.farthest = 0.0

    def step(self) -> None:
        """Take one window.

        Raises
        ------
        ExchangeError
            It does not converge.
        """
        model, body, secants = self._model, self._model.structure, self._secants
        started, stepping, trial = time.perf_counter(), 0.0, 0
        self._before = before = model.snapshot(self._before)
        place, start, velocity = self._guess(), body.boundary_displacement, body.boundary_velocity
        force_before = self._force_now()
        secants.begin()
        best = (math.inf, place)
        while True:
            trial += 1
            model.move_grains(place)
            moved = time.perf_counter()
            force = self._force_at_end(force_before)
            body.advance(force)
            stepping += time.perf_counter() - moved
            change = body.boundary_displacement - place
            left = self._left(change, body.boundary_displacement - start)
            if left <= self._wanted.tolerance:
                break
            if trial == self._wanted.most:
                self._accept(left)
                break
            best = min(best, (left, place), key=lambda seen: seen[0])
            place = place + secants.step(place.ravel(), change.ravel()).reshape(place.shape)
            if trial == self._wanted.most - 1:
                place = best[1]
            model.rewind(before, forget=False)
        self._given, self._velocity = force, velocity
        self.trials += trial
        model.seconds["structure"] += stepping
        model.seconds["exchange"] += time.perf_counter() - started - stepping

    def _guess(self) -> Floats:
        """Boundary displacement (n_b, 2) [m] to begin with.

        Where g alternates about the forces the acceleration does so too, and that of the last window's mean is taken.
        """
        body, window = self._model.structure, self._model.window
        if self._model.substeps == 1 or not self._keeps_means:
            return body.predict(window)
        return body.predict(window, order=1) + 0.5 * window * (body.boundary_velocity - self._velocity)

    def _force_now(self) -> Floats | None:
        """Forces (n_b, 2) [N/m] on the nodes at the present time, where sub-cycling asks for them. On rank 0."""
        model = self._model
        if model.substeps == 1 or model.particles is None:
            return None
        return model.interface.forces(model.particles).nodal

    def _force_at_end(self, before: Floats | None) -> Floats:
        """What the structure gets [N/m] (n_b, 2) at the end of a window that began with the forces `before`."""
        model = self._model
        if before is None:
            return model.nodal_force
        now = self._force_now()
        if self._keeps_means:
            return 2.0 * model.nodal_force + (before - now) / model.substeps - self._given
        return model.nodal_force + 0.5 * (now - before)

    def state(self) -> dict[str, Floats]:
        """What the next window needs beside the state of the model; nothing writes into these arrays."""
        counts = np.array([self.trials, self.unsettled, self.farthest])
        return self._secants.state() | {"given_force": self._given, "velocity": self._velocity, "counts": counts}

    def restore(self, saved: Mapping[str, Floats]) -> None:
        """Take up a `state`; without one, that of a run with another exchange, begin with the present forces."""
        if saved:
            self._secants.restore(saved)
            self._given, self._velocity = saved["given_force"], saved["velocity"]
            self.trials, self.unsettled = (int(count) for count in saved["counts"][:2])
            self.farthest = float(saved["counts"][2])
        else:
            self._given, self._velocity = self._model.nodal_force, self._model.structure.boundary_velocity

    def _left(self, change: Floats, motion: Floats) -> float:
        """The change of the boundary over its motion; rank 0's counts, as it alone has the grains' place."""
        size = float(np.abs(change).max())
        left = size / float(np.abs(motion).max()) if size > self._noise else 0.0
        comm = self._model.structure.comm
        return left if comm.size == 1 else comm.bcast(left, root=0)

    def _accept(self, left: float) -> None:
        """Count a window that stands at a jump of the forces, where no guess agrees; refuse what is farther off."""
        wanted, now = self._wanted, self._model.structure.time
        if left <= JUMP:
            self.unsettled += 1
            self.farthest = max(self.farthest, left)
            return
        raise ExchangeError(
            f"t = {now:g} s: the exchange has not converged in {wanted.most} iterations, a further one would "
            f"change the boundary by {left:.2g} of its motion in the step, above interface.tolerance = "
            f"{wanted.tolerance:g}; take a smaller time.step, or raise interface.iterations"
        )
