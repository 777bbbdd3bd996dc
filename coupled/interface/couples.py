"""Torques of glued grains as couples on the facets under them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coupled.interface.door import shares

Floats = NDArray[np.float64]
Plane = NDArray[np.complex128]  # vectors of the plane, x + i y
Whole = NDArray[np.int64]


class FacetCouples:
    """Passes torques on glued grains to the nodes, and the turning of facets to the grains.

    A torque T on a facet t (from its first node to its second) becomes the forces ``q`` on the second
    node and ``-q`` on the first, ``q = T (-t_y, t_x)/|t|^2``: no resultant, moment T. The spin of a facet
    is what T does work on, ``q . (v_2 - v_1)/T = ((v_2 - v_1) . n)/L``. A grain on a node between two
    facets has half a share in each.

    Parameters
    ----------
    facets : (m, 2) ints
        Glued grains on the first and second node of each facet.
    on : (k,) ints
        Facet of each glued grain, the one that it begins on a node.
    """

    def __init__(self, facets: Whole, on: Whole) -> None:
        self._first, self._second = np.ascontiguousarray(facets.T)
        ending = np.full(len(on), -1)
        ending[self._second] = np.arange(len(facets))
        begins = np.isin(np.arange(len(on)), self._first)
        beside = np.where(begins & (ending >= 0), ending, on)
        self._turn = shares(on, beside, np.full(len(on), 0.5), len(facets))
        self._give = self._turn.T.tocsr()
        self._middle = np.ones(len(facets), complex)

    def spins(self, before: Floats, after: Floats, interval: float) -> Floats:
        """Spins (k,) [rad/s] of glued grains whose centres (k, 2) [m] go straight from `before` to `after`."""
        start, end = self._along(before), self._along(after)
        self._middle = 0.5 * (start + end)
        return self._turn @ (((end - start) / self._middle).imag / interval)

    def now(self, torque: Floats, places: Floats) -> Floats:
        """Forces (k, 2) on the grains that stand on nodes, from torques (k,) on grains at `places` (k, 2) [m]."""
        return self._couples(torque, self._along(places))

    def over_window(self, turning: Floats) -> Floats:
        """The same for angular impulses of the last window, by the facets in its middle: exact in virtual work."""
        return self._couples(turning, self._middle)

    def _couples(self, torque: Floats, along: Plane) -> Floats:
        force, couple = np.zeros(len(torque), complex), (self._give @ torque) * (1j / along.conj())
        force[self._first] -= couple
        force[self._second] += couple
        return force.view(float).reshape(-1, 2)

    def _along(self, places: Floats) -> Plane:
        """From the first node of each facet to its second (m,) [m]."""
        place = np.ascontiguousarray(places).view(complex)[:, 0]
        return place[self._second] - place[self._first]
