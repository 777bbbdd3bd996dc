"""What stops a run that has gone wrong, before it writes a checkpoint of it."""

from __future__ import annotations

import math

from coupled.errors import LeitoError
from coupled.model import Model
from coupled.observe import Observation

DEEPEST_OVERLAP = 0.5  # of the smaller radius: the linear contact has lost its meaning
ENERGY_MADE = 0.25  # of the energy turned over
NOISE = 1e-6  # of the energy stored: below it a relative error says nothing


class Unstable(LeitoError):
    """A run stopped by a watchdog."""


def watch(model: Model, seen: Observation) -> None:
    """Refuse to go on with a broken state.

    Raises
    ------
    Unstable
        With the quantity, its value, and what to change.
    """
    lost = [name for name, value in seen.numbers.items() if not math.isfinite(value)]
    if lost:
        raise Unstable(
            f"t = {model.time:g} s: {lost[0]} is no longer a finite number, the run is unstable; "
            "take a smaller time.step"
        )
    if seen.look is not None and seen.look.deepest > DEEPEST_OVERLAP:
        number = model.particles.grains.number[seen.look.deepest_at]
        raise Unstable(
            f"t = {model.time:g} s: overlap of grain {number} is {seen.look.deepest:.2f} of the smaller radius, above "
            f"{DEEPEST_OVERLAP:g}; take a stiffer contact.normal_stiffness or a smaller time.step"
        )
    balance = seen.balance
    stored = sum(abs(value) for value in balance.entries.values())
    if balance.error > ENERGY_MADE * balance.throughput and balance.error > NOISE * stored:
        raise Unstable(
            f"t = {model.time:g} s: {balance.error:.3g} J/m have come from nothing, {balance.relative_error:.0%} of "
            "the energy turned over; take a smaller time.step"
        )
