"""The signs by which a run is seen to go wrong."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass

import numpy as np

from coupled.balance import Balance, take_balance
from coupled.errors import LeitoError
from coupled.model import Model
from coupled.running import culprit
from coupled.running.body_signs import body_sign
from coupled.running.sign import FARTHEST_STEP, Sign
from particles import ContactLook, sharp_limit
from particles.spots import alternating, touching_bodies

DEEPEST_OVERLAP = 0.5  # of the smaller radius: the linear contact has lost its meaning
ENERGY_MADE = 0.25  # of the energy turned over
OF_PRESENT = 0.01  # of kinetic and elastic energy, that energy made between two looks must exceed
AT_INTERFACE = 0.05  # of the same, that the interface may make whatever else is turned over; in sound runs up to 1e-3
ROUND_OFF = 8 * sys.float_info.epsilon  # of the largest coordinate, of a place after some sums
NOISE = 1e-6  # of the energy stored: below it a relative error says nothing
TURNING_AT_STRUCTURE = 0.1  # of the grains on the structure, for its exchange to be looked at
FEWEST_TURNING = 2
TURNING = 2e-3  # share of the free grains that turn about at every step; in sound beds up to 4e-4


class Unstable(LeitoError):
    """A run stopped by a watchdog."""


@dataclass(frozen=True)
class Glance:
    """What a watchdog looks at: the ledger, the contacts and a cell that is inside out at one moment.

    `beyond` says that an observation is far outside the theory of the structure; looks alone do not tell. `turned` is
    the most energy [J/m] that looks up to this one have seen turned over since the start.
    """

    balance: Balance
    look: ContactLook | None
    overturned: int | None
    beyond: str | None = None
    turned: float = 0.0


def glance(model: Model, start: dict[str, float]) -> Glance:
    """Look at the model; `start` are the ledger's entries at the beginning. Collective under MPI."""
    look = model.particles.look() if model.particles is not None else None
    return Glance(take_balance(model, look, start), look, overturned_cell(model))


def overturned_cell(model: Model) -> int | None:
    """A cell of the structure that is inside out, if any. Collective under MPI."""
    return None if model.structure is None else model.structure.overturned_cell()


def first_sign(model: Model, seen: Glance, since: Glance) -> Sign | None:
    """What is wrong with a state, if anything; `since` is the last look that found nothing. On rank 0."""
    return (
        _not_finite(model, seen)
        or body_sign(model, seen.overturned, seen.beyond)
        or _too_deep(model, seen)
        or _passed(model)
        or _too_fast(model, seen)
        or _energy_made(model, seen, since)
        or _energy_made_in_all(model, seen, since)
    )


def _not_finite(model: Model, seen: Glance) -> Sign | None:
    lost = [name for name, value in seen.balance.entries.items() if not math.isfinite(value)]
    if not lost:
        return None
    where = ""
    if model.particles is not None and model.particles.grains.n_free:
        grains = model.particles.grains
        speed = np.hypot(grains.vx, grains.vy)
        bad = np.nonzero(~np.isfinite(speed))[0]
        where = f", first at {culprit.name_of_grain(model, int(bad[0]))}" if len(bad) else ""
    if model.structure is not None and not where:
        where = f", worst at {culprit.liveliest_node(model)}"
    return Sign(f"{lost[0]} is no longer a finite number{where}", "step")


def _too_deep(model: Model, seen: Glance) -> Sign | None:
    if seen.look is None or not seen.look.deepest > DEEPEST_OVERLAP:
        return None
    return Sign(
        f"the overlap of {culprit.touch_of(model, seen.look.deepest_at)} is {seen.look.deepest:.3g} of the smaller "
        f"radius, above {DEEPEST_OVERLAP:g}",
        "contact",
    )


def _passed(model: Model) -> Sign | None:
    """What was too deep between two looks, or within a step."""
    if model.particles is None or not model.particles.passage.depth > DEEPEST_OVERLAP:
        return None
    passage = model.particles.passage
    within = f", going {passage.stride:.3g} of it in one step" if passage.stride > FARTHEST_STEP else ""
    return Sign(
        f"{culprit.passage_of(model)} have overlapped by {passage.depth:.3g} of the smaller radius{within}, more than "
        f"{DEEPEST_OVERLAP:g}",
        "step" if within else "contact",
    )


def _too_fast(model: Model, seen: Glance) -> Sign | None:
    """A grain that goes on after half its radius in a step has contacts that are not resolved."""
    if seen.look is None or not model.particles.grains.n_free:
        return None
    grains, place = model.particles.grains, culprit.fastest_grain(model, seen.look)
    share = float(np.hypot(grains.vx[place], grains.vy[place])) * model.particles.time_step / grains.radius[place]
    if seen.look.contacts[place] == 0 or share <= FARTHEST_STEP:
        return None
    return Sign(
        f"{culprit.touch_of(model, place)} goes {share:.2f} of its radius in a step, more than {FARTHEST_STEP:g}",
        "step",
    )


def _energy_made(model: Model, seen: Glance, since: Glance) -> Sign | None:
    """Energy from nothing since the last look, against what was turned over and what is there."""
    now, then = seen.balance, since.balance
    made = now.error - then.error
    turned = 0.5 * sum(abs(now.entries[name] - then.entries.get(name, 0.0)) for name in now.entries)
    present = _present(now)
    stored = sum(abs(value) for value in now.entries.values())
    residual = now.interface_residual - then.interface_residual
    at_interface = residual > 0.5 * made > 0.5 * AT_INTERFACE * present
    if not made > max(NOISE * stored, _round_off(model)):
        return None
    if not (at_interface or made > max(ENERGY_MADE * turned, OF_PRESENT * present)):
        return None
    return _energy_sign(model, made, made / turned, seen, then)


def _energy_made_in_all(model: Model, seen: Glance, since: Glance) -> Sign | None:
    """Energy from nothing, or gone nowhere, since the start.

    After a rebound without loss all is as it was, and nothing turned over. An exchange far above its limit may lose
    more than it makes, in contacts that open each time.
    """
    balance = seen.balance
    stored = sum(abs(value) for value in balance.entries.values())
    turned = max(balance.throughput, since.turned)
    least = max(ENERGY_MADE * turned, NOISE * stored, OF_PRESENT * _present(balance), _round_off(model))
    if not abs(balance.error) > least:
        return None
    return _energy_sign(model, balance.error, abs(balance.error) / turned if turned else math.inf, seen, None)


def _round_off(model: Model) -> float:
    """Energy [J/m] of what goes to and fro by the round-off of its places in a step: below it nothing counts."""
    energy = 0.0
    if model.particles is not None and model.particles.grains.n_free:
        grains, free = model.particles.grains, slice(model.particles.grains.n_free)
        reach = max(float(np.abs(grains.x).max()), float(np.abs(grains.y).max()))
        energy += _jittering(float((1.0 / grains.inverse_mass[free]).sum()), reach, model.particles.time_step)
    if model.structure is not None:
        body = model.structure
        reach = float(np.abs(body.mesh.outer_polyline.points + body.boundary_displacement).max())
        energy += _jittering(body.mass, reach, model.window)
    return energy


def _jittering(mass: float, reach: float, step: float) -> float:
    """Kinetic energy [J/m] of the round-off of places that reach so far [m], gone in a step [s]."""
    return 0.5 * mass * (ROUND_OFF * reach / step) ** 2


def _present(balance: Balance) -> float:
    """Kinetic and elastic energy [J/m]."""
    moving = sum(abs(v) for name, v in balance.entries.items() if name.endswith(("kinetic", "rotational")))
    return moving + sum(v for name, v in balance.entries.items() if name.endswith(("_springs", "_strain")))


def _energy_sign(model: Model, made: float, share: float, seen: Glance, then: Balance | None) -> Sign:
    """Where energy came from nothing: at the interface if its two works differ by most of it, else among the grains."""
    now = seen.balance
    whence = "have come from nothing" if made > 0.0 else "have gone nowhere"
    text = f"{abs(made):.3g} J/m {whence}, {share:.0%} of the energy turned over"
    if then is not None:
        text += f" ({culprit.fastest_line(now, then)})"
    residual = now.interface_residual - (then.interface_residual if then is not None else 0.0)
    if model.interface is not None and abs(residual) > 0.5 * abs(made):
        return Sign(f"{text}, at the interface; liveliest is {culprit.liveliest_node(model)}", "exchange")
    if model.particles is None or not model.particles.grains.n_free:
        return Sign(f"{text}; liveliest is {culprit.liveliest_node(model)}", "structure")
    return Sign(f"{text}; fastest is {culprit.touch_of(model, culprit.fastest_grain(model, seen.look))}", "step")


def turning_grains(model: Model) -> bool:
    """Whether more grains turn about from step to step than births of contacts explain. On rank 0."""
    system = model.particles
    return system is not None and len(alternating(system)) > max(TURNING * system.grains.n_free, 1)


def turning_at_structure(model: Model) -> bool:
    """Whether many of the grains that touch the structure turn about from step to step. On rank 0."""
    system = model.particles
    if system is None or model.closed_ratio is None:
        return False
    turning = alternating(system)
    if len(turning) < FEWEST_TURNING:  # most often: touching grains are sought only then
        return False
    touching = touching_bodies(system)
    return len(np.intersect1d(turning, touching)) >= max(FEWEST_TURNING, TURNING_AT_STRUCTURE * len(touching))


def feeding_exchange(model: Model, look: ContactLook | None) -> Sign | None:
    """The contacts of the structure are stiffer than its exchange bears, and grains on it turn about. Collective.

    Contacts that open and dashpots keep such an exchange from exploding, and what it makes of energy may be little
    beside what is there.
    """
    ratio, limit = model.closed_ratio.now(model.particles, look), model.closed_ratio.limit
    if ratio <= limit:
        return None
    return Sign(
        f"grains on the structure turn about at every step, as its closed contacts have the stiffness ratio r = "
        f"{ratio:.3g}, above {limit:.4g}",
        "exchange",
        limit / ratio,
    )


def rattle(model: Model) -> Sign | None:
    """The time step is above the limit of the present contacts, and grains turn about in it. On rank 0.

    Friction and opening contacts keep such a bed from exploding: its grains rattle in their places,
    which neither overlaps nor the ledger show. Costs a Lanczos iteration: ask where `turning_grains`.
    """
    system = model.particles
    limit = sharp_limit(system)
    if not system.time_step > limit.step:
        return None
    return Sign(
        f"{len(alternating(system))} of {system.grains.n_free} grains turn about at every step, as the time step is "
        f"{system.time_step / limit.step:.3g} times the limit of the present contacts, {limit.step:.3g} s; the fastest "
        f"mode is that of {culprit.touch_of(model, limit.grain)}",
        "step",
    )
