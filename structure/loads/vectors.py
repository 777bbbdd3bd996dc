"""Loads as nodal forces: what keeps its direction assembled once, what follows the body computed anew."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from structure import forms
from structure.discrete import DiscreteBody
from structure.errors import StructureError
from structure.loads.facets import boundary_tags
from structure.loads.load import BodyForce, BoundaryLoad, Load, PointLoad, Pressure
from structure.loads.point_location import shares_at
from structure.loads.pressure import PressedBoundary
from structure.loads.schedules import Schedule


class LoadVectors:
    """The external force on a body as a function of time and, where a pressure follows, of its shape.

    Loads with equal schedules are added up once: a step costs one scaled vector per different schedule.

    Attributes
    ----------
    schedules, vectors : (schedules), (schedules, owned unknowns)
        The different schedules, and this rank's nodal forces [N/m] of fixed direction at full strength.
    followers : tuple of PressedBoundary
        Pressures that follow.
    constant_from : float
        Time [s] from which the force no longer changes on a body at rest.
    """

    def __init__(self, body: DiscreteBody, loads: Sequence[Load]) -> None:
        self.followers = tuple(
            PressedBoundary(body, load) for load in loads if isinstance(load, Pressure) and load.follows
        )
        summed: dict[Schedule, NDArray[np.float64]] = {}
        for load in loads:
            if not (isinstance(load, Pressure) and load.follows):
                vector = _vector(body, load)
                summed[load.schedule] = summed[load.schedule] + vector if load.schedule in summed else vector
        self.schedules = tuple(summed)
        self.vectors = np.array(list(summed.values())).reshape(len(summed), body.unknowns)
        timed = [*self.schedules, *(follower.schedule for follower in self.followers)]
        self.constant_from = max((schedule.constant_from for schedule in timed), default=0.0)
        shares = self.vectors.reshape(len(summed), body.unknowns // 2, 2).sum(axis=1)
        self._resultants = body.comm.allreduce(shares)

    def factors(self, time: float) -> NDArray[np.float64]:
        """Factors (schedules,) at `time` [s]."""
        return np.array([schedule.factor(time) for schedule in self.schedules])

    def at(self, time: float, displacement: NDArray[np.float64]) -> NDArray[np.float64]:
        """This rank's nodal forces (owned unknowns,) [N/m] at `time` [s], `displacement` (owned unknowns,) [m]."""
        force = self.factors(time) @ self.vectors
        for follower in self.followers:
            now = follower.force(follower.displacement_of(displacement))
            follower.add(follower.schedule.factor(time) * now, force)
        return force

    def resultant(self, time: float, displacement: NDArray[np.float64]) -> NDArray[np.float64]:
        """Resultant (2,) [N/m] over all ranks at `time` [s]."""
        total = self.factors(time) @ self._resultants
        for follower in self.followers:
            now = follower.force(follower.displacement_of(displacement))
            total = total + follower.schedule.factor(time) * now.sum(axis=0)
        return total

    def at_full_strength(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Nodal forces (owned unknowns,) and resultant (2,) [N/m] of fixed direction, every factor 1."""
        return self.vectors.sum(axis=0), self._resultants.sum(axis=0)


def _vector(body: DiscreteBody, load: Load) -> NDArray[np.float64]:
    """This rank's nodal forces (owned unknowns,) [N/m] of a load of fixed direction at full strength."""
    match load:
        case BodyForce():
            return body.weigh(np.tile(np.array(load.acceleration, float), body.unknowns // 2))
        case BoundaryLoad():
            weights = forms.boundary_weights(body.space, body.mesh, boundary_tags(body, load.boundary))
            return np.outer(weights / body.comm.allreduce(weights.sum()), load.total_force).ravel()
        case PointLoad():
            return _at_point(body, load)
        case Pressure():
            pressed, vector = PressedBoundary(body, load), np.zeros(body.unknowns)
            pressed.add(pressed.force(), vector)
            return vector
    raise StructureError(f"load {load!r} is not known: use a BodyForce, a BoundaryLoad, a PointLoad or a Pressure")


def _at_point(body: DiscreteBody, load: PointLoad) -> NDArray[np.float64]:
    vector = np.zeros((body.unknowns // 2, 2))
    for node, share in zip(*shares_at(body.mesh, load.point), strict=True):
        vector[body.nodes.owned == node] += share * np.asarray(load.force)
    return vector.ravel()
