"""One row of numbers that tell how the model stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coupled.balance import Balance, take_balance
from coupled.model import Model
from coupled.scene.history import intruder_columns, unit_of
from particles import ContactLook


@dataclass(frozen=True)
class Observation:
    """Numbers by name (units by `coupled.scene.history.unit_of`), with what they came from."""

    numbers: dict[str, float]
    balance: Balance
    look: ContactLook | None

    def row(self, units: str = "SI") -> dict[str, float]:
        """Numbers by name with unit, for the history of a scene whose key `units` is given."""
        return {f"{name} [{unit_of(name, units)}]": value for name, value in self.numbers.items()}


def observe(model: Model, start: dict[str, float] | None) -> Observation:
    """Look at the model; `start` are the ledger's entries at the beginning. Collective under MPI."""
    look = model.particles.look() if model.particles is not None else None
    balance = take_balance(model, look, start)
    numbers = {"time": model.time}
    if model.structure is not None:
        numbers |= _structure_numbers(model)
    if model.particles is not None and model.particles.grains.n_free:
        numbers |= _grain_numbers(model, look) | _followed_numbers(model)
    numbers["ledger_error"], numbers["ledger_relative_error"] = balance.error, balance.relative_error
    if model.interface is not None:
        numbers |= _interface_numbers(model, balance)
    if model.closed_ratio is not None:
        numbers["stiffness_ratio"] = model.closed_ratio.now(model.particles, look)
    if model.particles is not None:
        numbers["momentum_residual"] = momentum_residual(model)
    return Observation(numbers | balance.entries, balance, look)


def momentum_residual(model: Model) -> float:
    """Force on grains and walls plus force on nodes, over the sum of magnitudes: round-off."""
    residual = model.particles.force_residual()
    scale = float(np.abs(model.nodal_force).sum())
    if scale > 0.0:
        gap = np.abs(model.nodal_force.sum(axis=0) - model.reaction).max()
        residual = max(residual, float(gap) / scale)
    return residual


def _interface_numbers(model: Model, balance: Balance) -> dict[str, float]:
    """The works on both sides, and the moment that glued grains have not passed on, if they drop it."""
    sums = model.exchanged
    numbers = {
        "interface_residual": balance.interface_residual,
        "interface_residual_window": sums.worst_window,
        "interface_work": sums.work,
    }
    if model.interface.drops_moment:
        numbers |= {"moment_dropped": sums.moment_dropped, "moment_dropped_share": sums.share_dropped}
    return numbers


def _structure_numbers(model: Model) -> dict[str, float]:
    body = model.structure
    applied, centroid, peaks = body.external_force(), body.centroid(), body.peaks()
    numbers = {"applied_x": applied[0], "applied_y": applied[1]}
    if model.interface is not None:
        numbers |= {"reaction_x": model.reaction[0], "reaction_y": model.reaction[1]}
    beyond = {"local_rotation": peaks.local_rotation, "compression": peaks.compression}
    return numbers | {
        "centroid_x": centroid[0],
        "centroid_y": centroid[1],
        "rotation": body.mean_rotation(),
        "max_von_mises": peaks.von_mises,
        "max_strain": peaks.strain,
        **{name: value for name, value in beyond.items() if value is not None},
    }


def _followed_numbers(model: Model) -> dict[str, float]:
    """Centres and velocities of the intruders, and the displacement of the walls that shake."""
    system, numbers = model.particles, {}
    for k, number in enumerate(model.followed):
        grains = system.grains
        at = int(np.nonzero(grains.number == number)[0][0])
        of_grain = [float(array[at]) for array in (grains.x, grains.y, grains.vx, grains.vy)]
        numbers |= dict(zip(intruder_columns(k), of_grain, strict=True))
    if system.shaking is not None:
        floors = [wall.shaken for wall in system.walls if wall.name == "floor"]
        floor = any(floors) if floors else bool(system.shaking.bodies)  # rows in its place
        axis = "x" if system.shaking.along[0] else "y"
        numbers[f"{'floor' if floor else 'walls'}_{axis}"] = float(system.shaking.displacement(system.time))
    return numbers


def _grain_numbers(model: Model, look: ContactLook) -> dict[str, float]:
    grains = model.particles.grains
    free = slice(grains.n_free)
    return {
        "contacts": look.count,
        "coordination": float(look.contacts[free].mean()),
        "deepest_overlap": look.deepest,
        "fastest_grain": float(np.sqrt(np.max(grains.vx[free] ** 2 + grains.vy[free] ** 2))),
        "highest_grain": float(np.max(grains.y[free] + grains.radius[free])),
    }
