"""Pressure on a boundary: nodal forces from the places of its nodes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from structure.boundary import boundary_exchange
from structure.discrete import DiscreteBody
from structure.loads.facets import boundary_facets, on_facet
from structure.loads.load import Pressure


class PressedBoundary:
    """Nodal forces of a pressure, exact for straight and for curved facets.

    A facet runs along ``x(s) = sum N_b(s) x_b`` with the solid to its left, so that ``n ds = (dy, -dx)``
    and ``f_a = -p int N_a n ds = p (-sum S_ab y_b, sum S_ab x_b)``, ``S_ab = int N_a dN_b/ds ds``, summed
    over the facets: linear in the places of the nodes, whatever their displacement. On a closed boundary S is
    antisymmetric and f the gradient of ``-p A``, A the enclosed area on the solid's side: the trapezoidal
    work of a constant pressure between two shapes is ``-p`` times the change of A.

    Attributes
    ----------
    nodes : (k,)
        Original numbers of the nodes.
    """

    def __init__(self, body: DiscreteBody, load: Pressure) -> None:
        facets = boundary_facets(body, load.boundary)
        self.nodes, local = np.unique(facets, return_inverse=True)
        local = local.reshape(facets.shape)
        size = facets.shape[1]
        rows, columns = np.repeat(local, size, axis=1).ravel(), np.tile(local, size).ravel()
        values = np.tile(_along_facet(body.mesh.order).ravel(), len(facets))
        self._operator = csr_matrix((values, (rows, columns)), shape=(len(self.nodes),) * 2)
        self._reference = body.mesh.points[self.nodes]
        self._pressure, self.schedule = load.pressure, load.schedule
        self._exchange = boundary_exchange(body.nodes, self.nodes, body.comm)

    def force(self, displacement: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Nodal forces (k, 2) [N/m] at full strength; at the reference shape without `displacement` (k, 2) [m]."""
        places = self._reference if displacement is None else self._reference + displacement
        # S times a translation is zero: taken off beforehand, it leaves no round-off.
        x, y = (places - places[0]).T
        return self._pressure * np.column_stack([-(self._operator @ y), self._operator @ x])

    def displacement_of(self, displacement: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacement (k, 2) of the nodes, on every rank, out of this rank's flat unknowns."""
        return self._exchange.read((displacement,), ())[0][0]

    def add(self, force: NDArray[np.float64], into: NDArray[np.float64]) -> None:
        """Add nodal forces (k, 2) to this rank's flat array."""
        self._exchange.add(force, into)


def _along_facet(order: int) -> NDArray[np.float64]:
    """``int N_a dN_b/ds ds`` over one facet, nodes start, end (, middle)."""
    points, weights = np.polynomial.legendre.leggauss(order + 1)
    total = np.zeros((order + 1, order + 1))
    for point, weight in zip(points, weights, strict=True):
        values, slopes = on_facet(order, (point + 1.0) / 2.0)
        total += weight / 2.0 * np.outer(values, slopes)
    return total
