"""Keeps the last good state of a run in memory, and goes back to it to find where it went wrong."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

from mpi4py import MPI
from numpy.typing import NDArray

from coupled.errors import ExchangeError, LeitoError
from coupled.model import Model, Snapshot
from coupled.running import watchdog
from coupled.running.ranks import on_root, together
from coupled.running.sign import Remedy, Sign
from coupled.running.watchdog import Glance
from particles import ParticleError
from structure import StepError, StructureError

LOOK = 1000  # grain steps between two looks: together with the copy of the state 0.5 % of the steps' time
ROUGH = 32  # strides in which the way from the last good look is first gone again
LONGEST_WAIT = 64  # looks, before grains that turn about for another reason are looked at again
FAULTS = (ParticleError, StructureError, LeitoError)  # what a step may raise because the run is unstable

FROM_START = {  # what to change about a scene that is wrong from its start
    "contact": "place them farther apart, or make the contact stiffer",
    "step": "take a smaller time.step, or smaller numbers where it starts",
}


class Good(NamedTuple):
    """A state that all watchdogs have passed."""

    moment: Snapshot
    glance: Glance
    step: int


class Failed(LeitoError):
    """A run that a watchdog or a step itself has ended. The model stands at `before_sign`.

    Attributes
    ----------
    sign : Sign
        The first one, with its place.
    good : Good
        The last good look before it.
    state : dict
        Of the model at that look.
    time : float
        Of the sign [s].
    """

    def __init__(self, sign: Sign, good: Good, state: dict[str, NDArray[Any]], time: float) -> None:
        super().__init__(sign.what)
        self.sign, self.good, self.state, self.time = sign, good, state, time


class Guard:
    """Watches a model on its way. All methods are collective under MPI.

    Parameters
    ----------
    model : Model
    start : dict
        The ledger's entries at the beginning of the run [J/m].
    comm : MPI communicator

    Raises
    ------
    Failed
        From `advance`, `check` and `keep`: after going back and finding the first sign.
    """

    def __init__(self, model: Model, start: dict[str, float], comm: MPI.Intracomm) -> None:
        self._model, self._start, self._comm = model, start, comm
        self._turned, self._wait, self._waited = False, 1, 0
        self._shook = False
        seen = watchdog.glance(model, start)
        self._good = Good(model.snapshot(), seen, model.steps_done)
        sign = self._sign(seen)
        if sign is not None:
            change = FROM_START.get(sign.remedy, "change the scene")
            raise watchdog.Unstable(f"t = {model.time:g} s, before the first step: {sign.what}; {change}")

    def advance(self, steps: int) -> None:
        """Take steps; one that cannot be taken ends the run."""
        until = self._model.steps_done + steps
        sign = self._try(steps)
        if sign is not None:
            raise self._failure(sign, until)

    def check(self, seen: Glance) -> None:
        """Look for signs in an observation."""
        sign = self._sign(seen)
        if sign is not None:
            raise self._failure(sign, self._model.steps_done)

    def keep(self) -> Good:
        """Look for signs, those of a rattling bed as well, and keep the state if there are none."""
        seen = watchdog.glance(self._model, self._start)
        self.check(seen)
        if on_root(self._comm, self._turns_twice):
            sign = on_root(self._comm, lambda: watchdog.rattle(self._model))
            if sign is not None:
                raise self._failure(sign, self._model.steps_done, rattles=True)
            self._wait = min(2 * self._wait, LONGEST_WAIT)
        if on_root(self._comm, self._shakes_twice):
            sign = watchdog.feeding_exchange(self._model, seen.look)
            if sign is not None:
                raise self._failure(sign, self._model.steps_done)
        turned = max(seen.balance.throughput, self._good.glance.turned)
        kept = replace(seen, turned=turned)
        self._good = Good(self._model.snapshot(self._good.moment), kept, self._model.steps_done)
        return self._good

    def _turns_twice(self) -> bool:
        """Whether grains turn about in this look as in the last one, and it is time to ask why."""
        before, self._turned = self._turned, watchdog.turning_grains(self._model)
        self._waited += 1
        if not (before and self._turned and self._waited >= self._wait):
            return False
        self._waited = 0
        return True

    def _shakes_twice(self) -> bool:
        """Whether grains on the structure turn about in this look as in the last one."""
        before, self._shook = self._shook, watchdog.turning_at_structure(self._model)
        return before and self._shook

    def _sign(self, seen: Glance) -> Sign | None:
        return on_root(self._comm, lambda: watchdog.first_sign(self._model, seen, self._good.glance))

    def _try(self, steps: int) -> Sign | None:
        """Take steps; the sign, if one cannot be taken."""
        try:
            together(self._comm, lambda: self._model.advance(steps))
        except FAULTS as fault:
            return Sign(str(fault), _remedy(fault), fault.largest_step if isinstance(fault, StepError) else 1.0)
        return None

    def _sign_again(self, rattles: bool) -> Sign | None:
        """As `_sign`, of the present state; `rattles`: grains that turn about are one now."""
        found = self._sign(watchdog.glance(self._model, self._start))
        if found is None and rattles and on_root(self._comm, lambda: watchdog.turning_grains(self._model)):
            found = on_root(self._comm, lambda: watchdog.rattle(self._model))
        return found

    def _failure(self, sign: Sign, until: int, *, rattles: bool = False) -> Failed:
        """Go back to the last good look and from there to the first sign: in strides, then step by step.

        The way is the same to the bit. If it shows no sign before the step `until`, `sign` is the
        first one. The model is left at the last step without a sign.
        """
        model, good, time = self._model, self._good, self._model.time
        model.rewind(good.moment)
        state, before = model.state(), model.snapshot()
        for stride in (max(1, (until - good.step) // ROUGH), 1):
            found, before = None, model.snapshot(before)
            while found is None and model.steps_done < until:
                before, steps = model.snapshot(before), min(stride, until - model.steps_done)
                time = (model.steps_done + steps) * model.window
                found = self._try(steps) or self._sign_again(rattles)
            sign = found or sign
            model.rewind(before)
        return Failed(sign, good, state, time)


def _remedy(fault: Exception) -> Remedy:
    """What to change about a step that could not be taken."""
    if isinstance(fault, ExchangeError):
        return "exchange"
    return "step" if isinstance(fault, ParticleError) else "structure"
