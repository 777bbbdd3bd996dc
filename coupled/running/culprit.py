"""Where it is that a run goes wrong, in words: a grain and its contact, a node, a line of the ledger."""

from __future__ import annotations

import numpy as np

from coupled.balance import Balance
from coupled.interface.glued import BODY
from coupled.model import Model
from particles import ContactLook
from particles.spots import deepest_touch


def name_of_grain(model: Model, place: int) -> str:
    """A grain by its number and place: free, glued or of a row."""
    grains = model.particles.grains
    at = f"at ({grains.x[place]:.4g}, {grains.y[place]:.4g}) m"
    body = int(grains.body[place])
    if body < 0:
        return f"grain {grains.number[place]} {at}"
    within = place - grains.bodies()[body].start
    return f"glued grain {within} {at}" if body == BODY else f"row grain {within} {at}"


def touch_of(model: Model, place: int) -> str:
    """A grain with its deepest contact, the overlap and the speed of approach."""
    system = model.particles
    touch, grain = deepest_touch(system, place), name_of_grain(model, place)
    if touch is None:
        return grain
    if touch.partner is not None:
        partner = name_of_grain(model, touch.partner)
    elif touch.wall is not None:
        partner = f"wall {system.walls[touch.wall].name!r}"
    else:
        partner = "the boundary of the structure"
    return (
        f"{grain} and {partner} (overlap {touch.depth:.3g} of the smaller radius, "
        f"{'closing' if touch.approach >= 0.0 else 'parting'} at {abs(touch.approach):.3g} m/s)"
    )


def name_of_node(model: Model, node: int) -> str:
    """A boundary node of the structure by its number and place."""
    body = model.structure
    x, y = (body.polyline.points + body.boundary_displacement)[node]
    return f"boundary node {node} at ({x:.4g}, {y:.4g}) m"


def passage_of(model: Model) -> str:
    """The two that were deepest in each other where a new contact list was made."""
    system, passage = model.particles, model.particles.passage

    def named(number: int) -> str:
        return name_of_grain(model, int(np.nonzero(system.grains.number == number)[0][0]))

    partner = f"wall {system.walls[passage.wall].name!r}" if passage.partner is None else named(passage.partner)
    return f"{named(passage.grain)} and {partner}"


def liveliest_node(model: Model) -> str:
    """The boundary node with the largest acceleration."""
    size = np.hypot(*model.structure.boundary_acceleration.T)
    node = int(np.argmax(np.where(np.isfinite(size), size, np.inf)))
    return f"{name_of_node(model, node)} with an acceleration of {size[node]:.3g} m/s2"


def fastest_line(balance: Balance, since: Balance) -> str:
    """The line of the ledger that has changed most."""
    change = {name: balance.entries[name] - since.entries.get(name, 0.0) for name in balance.entries}
    name = max(change, key=lambda key: abs(change[key]))
    return f"{name} changed by {change[name]:+.3g} J/m"


def fastest_grain(model: Model, look: ContactLook) -> int:
    """Place of the fastest free grain that touches something, or of the fastest; there must be a free one."""
    grains = model.particles.grains
    free = slice(grains.n_free)
    speed = np.hypot(grains.vx[free], grains.vy[free])
    touching = np.where(look.contacts[free] > 0, speed, -1.0)
    return int(np.argmax(touching if touching.max() >= 0.0 else speed))
