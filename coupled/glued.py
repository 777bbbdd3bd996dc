"""The glued interface: small grains on the structure's boundary (G 2.3)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from coupled.errors import LeitoError
from meshes import BoundaryPolyline

Floats = NDArray[np.float64]
POWER_STEPS, POWER_TOLERANCE = 300, 1e-4  # of the power iteration for the stiffness ratio


class GluedGrains:
    """Discs that sit on boundary facets, moved by the nodes and passing their forces to them.

    One on every node of the boundaries asked for and ``per_facet - 1`` equally spaced between two
    nodes. A glued grain at the fraction s of a facet follows ``(1 - s) u_1 + s u_2``, and its
    force goes to the two nodes in the same shares: one sparse operator P and its transpose, so
    that virtual work agrees by construction. The torque on a glued grain is dropped, as in the
    source; with it goes the moment of the force about the facet's line (arm: the grain's radius).

    Parameters
    ----------
    polyline : BoundaryPolyline
        Reference boundary [m].
    per_facet : int
        Glued grains per facet, the one on its first node included.
    boundaries : sequence of str
        Names of the boundaries that carry grains.
    diameter : float, optional
        [m]; by default the smallest spacing, at which neighbours touch.
    mean_velocity : bool
        Give each grain the mean velocity of its facet's nodes (G 2.3) instead of the
        interpolated one; a grain on a node between two facets takes that of the facet it begins.

    Attributes
    ----------
    operator : (n_glued, n_b) sparse
        P.
    radius : float
        [m].
    reference : (n_glued, 2)
        Positions on the reference shape [m].

    Raises
    ------
    LeitoError
        If the diameter is larger than the smallest spacing.
    """

    def __init__(
        self,
        polyline: BoundaryPolyline,
        *,
        per_facet: int,
        boundaries: Sequence[str] = ("outer",),
        diameter: float | None = None,
        mean_velocity: bool = False,
    ) -> None:
        self.polyline = polyline
        carrying = np.any([polyline.on(name) for name in boundaries], axis=0)
        facets = polyline.facets[carrying]
        fraction = np.tile(np.arange(per_facet) / per_facet, len(facets))
        first, second = np.repeat(facets, per_facet, axis=0).T
        open_ends = np.setdiff1d(facets[:, 1], facets[:, 0])
        closing = facets[np.isin(facets[:, 1], open_ends)]
        first, second = np.append(first, closing[:, 0]), np.append(second, closing[:, 1])
        fraction = np.append(fraction, np.ones(len(closing)))
        self.operator = _weights(first, second, fraction, len(polyline.points))
        self._transpose = self.operator.T.tocsr()
        half = np.full(len(fraction), 0.5)
        self._velocity = _weights(first, second, half, len(polyline.points)) if mean_velocity else None
        spacing = float(polyline.lengths()[carrying].min()) / per_facet
        self.radius = 0.5 * (spacing if diameter is None else diameter)
        if 2.0 * self.radius > spacing * (1.0 + 1e-9):
            raise LeitoError(
                f"glued diameter {2.0 * self.radius:g} m is larger than the smallest spacing {spacing:g} m: "
                "glued grains would overlap; take a smaller diameter or fewer per facet"
            )
        self.reference = self.operator @ polyline.points

    def __len__(self) -> int:
        return len(self.reference)

    def places(self, displacement: Floats) -> Floats:
        """Centres (n_glued, 2) [m] under boundary displacements (n_b, 2) [m]."""
        return self.reference + self.operator @ displacement

    def velocities(self, velocity: Floats) -> Floats | None:
        """Facet-mean velocities (n_glued, 2) [m/s], or None where grains simply follow their places."""
        return None if self._velocity is None else self._velocity @ velocity

    def nodal_forces(self, force: Floats) -> Floats:
        """Forces (n_b, 2) [N/m] on the nodes from forces (n_glued, 2) on the glued grains."""
        return self._transpose @ force

    def stiffness_ratio(
        self,
        stiffness: float,
        dashpot: float,
        interval: float,
        acceleration_by: Callable[[Floats], Floats],
    ) -> float:
        """The coupling's ``r = H^2 (k + 2 c/H) lambda``, with lambda the largest eigenvalue of P M^-1 P^T.

        That of every glued grain on a spring k [N/m] and a dashpot c [N s/m] to a fixed partner, H
        [s] the structure's step: the predicted exchange is stable up to r = 2 (one mode that
        alternates in sign; the structure's own stiffness does not move the limit). Free partners
        give way, so a bed of grains bears more. `acceleration_by` maps nodal forces (n_b, 2) to
        boundary accelerations (n_b, 2); power iteration.
        """
        force = np.random.default_rng(0).normal(size=(len(self), 2))
        growth = 0.0
        for _ in range(POWER_STEPS):
            force /= np.linalg.norm(force)
            force = self.operator @ acceleration_by(self.nodal_forces(force))
            before, growth = growth, float(np.linalg.norm(force))
            if abs(growth - before) <= POWER_TOLERANCE * growth:
                break
        return (interval**2 * stiffness + 2.0 * interval * dashpot) * growth


def _weights(first: NDArray[np.int64], second: NDArray[np.int64], fraction: Floats, nodes: int) -> csr_matrix:
    """Rows with ``1 - s`` at the first node and s at the second."""
    rows = np.arange(len(fraction))
    values = np.concatenate([1.0 - fraction, fraction])
    places = (np.concatenate([rows, rows]), np.concatenate([first, second]))
    matrix = csr_matrix((values, places), shape=(len(fraction), nodes))
    matrix.eliminate_zeros()
    return matrix
