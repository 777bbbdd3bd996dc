"""Loads as vectors of nodal forces, assembled once and scaled by their ramps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from structure import forms
from structure.discrete import DiscreteBody
from structure.errors import StructureError
from structure.loads import BodyForce, BoundaryLoad, Load, PointLoad, ramp

BULGE = 1.05  # a point of a round shape may lie that much farther away than one of its polygon


class LoadVectors:
    """The external force on a body as a function of time.

    Attributes
    ----------
    full : (loads, owned unknowns)
        Nodal forces [N/m] of each load at full strength.
    constant_from : float
        Time [s] from which the force no longer changes.
    """

    def __init__(self, body: DiscreteBody, loads: Sequence[Load]) -> None:
        self._loads = tuple(loads)
        rows = [_vector(body, load) for load in self._loads]
        self.full = np.array(rows).reshape(len(rows), body.unknowns)
        self.constant_from = max((load.ramp_time for load in self._loads), default=0.0)
        shares = self.full.reshape(len(rows), body.unknowns // 2, 2).sum(axis=1)
        self._resultants = body.comm.allreduce(shares)

    def factors(self, time: float) -> NDArray[np.float64]:
        """Ramp factors (loads,) at `time` [s]."""
        return np.array([ramp(load, time) for load in self._loads])

    def at(self, time: float) -> NDArray[np.float64]:
        """This rank's nodal forces (owned unknowns,) [N/m] at `time` [s]."""
        return self.factors(time) @ self.full

    def resultant(self, time: float) -> NDArray[np.float64]:
        """Resultant (2,) [N/m] over all ranks at `time` [s]."""
        return self.factors(time) @ self._resultants


def _vector(body: DiscreteBody, load: Load) -> NDArray[np.float64]:
    match load:
        case BodyForce():
            return body.weigh(np.tile(np.array(load.acceleration, float), body.unknowns // 2))
        case BoundaryLoad():
            return _on_boundary(body, load)
        case PointLoad():
            return _on_node(body, load)
    raise StructureError(f"load {load!r} is not known: use a BodyForce, a BoundaryLoad or a PointLoad")


def _on_boundary(body: DiscreteBody, load: BoundaryLoad) -> NDArray[np.float64]:
    named = body.mesh.boundaries
    if load.boundary not in named:
        raise StructureError(
            f"boundary = '{load.boundary}' is not a boundary of this mesh: use one of {', '.join(sorted(named))}"
        )
    weights = forms.boundary_weights(body.space, body.mesh, named[load.boundary])
    length = body.comm.allreduce(weights.sum())
    return np.outer(weights / length, load.total_force).ravel()


def _on_node(body: DiscreteBody, load: PointLoad) -> NDArray[np.float64]:
    polyline = body.mesh.outer_polyline
    distance = np.hypot(*(polyline.points - np.asarray(load.point)).T)
    nearest = int(np.argmin(distance))
    lengths = polyline.lengths()
    reach = max(lengths[nearest], lengths[nearest - 1]) / 2
    if distance[nearest] > reach * BULGE:
        raise StructureError(
            f"point = {tuple(load.point)!r} lies {distance[nearest]:.3g} m from the nearest node "
            f"of the outer boundary, {tuple(polyline.points[nearest].tolist())!r}: at most half a "
            f"facet, {reach:.3g} m, is allowed"
        )
    vector = np.zeros((body.unknowns // 2, 2))
    vector[body.nodes.owned == body.mesh.outer_nodes[nearest]] = load.force
    return vector.ravel()
