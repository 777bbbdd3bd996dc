"""The glued interface: small grains on the structure's boundary (G 2.3)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from coupled.errors import LeitoError
from coupled.interface import Pushed, shares
from meshes import BoundaryPolyline
from particles import Grains, ParticleSystem
from particles.beds import drop_height_on

Floats = NDArray[np.float64]
BODY = 0  # number of the glued grains among the prescribed bodies


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
        self.operator = shares(first, second, fraction, len(polyline.points))
        self._transpose = self.operator.T.tocsr()
        half = np.full(len(fraction), 0.5)
        self._velocity = shares(first, second, half, len(polyline.points)) if mean_velocity else None
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

    def describe(self) -> tuple[str, str]:
        return "glued grains, diameter", f"{len(self)}, {2 * self.radius:.4g} m"

    def enter(self, grains: Grains, material: int) -> Grains:
        return grains.with_prescribed(self.reference, self.radius, BODY, material=material)

    def facets(self, material: int) -> None:
        return None

    def fall_onto(self, grains: Grains | None) -> float:
        floor = float(np.min(self.reference[:, 1] - self.radius))
        radius = np.full(len(self), self.radius)
        return floor if grains is None else min(floor, drop_height_on(grains, self.reference, radius))

    def move(self, particles: ParticleSystem, displacement: Floats, before: Floats, interval: float) -> None:
        velocity = self.velocities((displacement - before) / interval)
        particles.steer(self._own(particles), self.places(displacement), interval, velocity)

    def forces(self, particles: ParticleSystem) -> Pushed:
        return self._pushed(particles.force_on(self._own(particles)))

    def impulses(self, particles: ParticleSystem) -> Pushed:
        return self._pushed(particles.impulse_on(self._own(particles)))

    def _pushed(self, force: Floats) -> Pushed:
        return Pushed(self.nodal_forces(force), force.sum(axis=0))

    def _own(self, particles: ParticleSystem) -> slice:
        """Places of the glued grains, the first of the prescribed ones."""
        first = particles.grains.n_free
        return slice(first, first + len(self))

    def contact_forces(self, particles: ParticleSystem) -> Floats:
        return particles.force_on(self._own(particles))

    def work(self, particles: ParticleSystem) -> float:
        return particles.work_by(self._own(particles))
