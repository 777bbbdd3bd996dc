"""The glued interface: small grains on the structure's boundary (G 2.3)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, diags

from coupled.errors import LeitoError
from coupled.interface.couples import FacetCouples
from coupled.interface.door import Pushed, shares
from meshes import BoundaryPolyline
from particles import ContactLook, Grains, ParticleSystem
from particles.beds import drop_height_on

Floats = NDArray[np.float64]
BODY = 0  # number of the glued grains among the prescribed bodies


class GluedGrains:
    """Discs that sit on boundary facets, moved by the nodes and passing their forces to them.

    One on every node of the boundaries asked for and ``per_facet - 1`` equally spaced between two
    nodes. A glued grain at the fraction s of a facet follows ``(1 - s) u_1 + s u_2``, and its
    force goes to the two nodes in the same shares: one sparse operator P and its transpose, so
    that virtual work agrees by construction. The torque on a glued grain, which is the moment of the
    force at the contact about the facet's line (arm: the grain's radius) and the rolling moment,
    goes to the nodes as a couple, and the grain turns with its facet; without `couple` the torque is
    dropped and the grain does not turn, as in the source.

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
    couple : bool
        Keep the torques (`FacetCouples`).

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
        couple: bool = True,
    ) -> None:
        self.polyline = polyline
        carrying = np.any([polyline.on(name) for name in boundaries], axis=0)
        facets = polyline.facets[carrying]
        seats = _seats(facets, per_facet)
        self.operator = shares(seats.first, seats.second, seats.fraction, len(polyline.points))
        self._transpose = self.operator.T.tocsr()
        self._couples = FacetCouples(seats.on_nodes(len(polyline.points))[facets], seats.facet) if couple else None
        half = np.full(len(seats.facet), 0.5)
        self._velocity = shares(seats.first, seats.second, half, len(polyline.points)) if mean_velocity else None
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
        own, goal = self._own(particles), self.places(displacement)
        start = _centres(particles, own) if self._velocity is None else self.places(before)
        particles.steer(own, goal, interval, self.velocities((displacement - before) / interval))
        if self._turns(particles):
            particles.grains.omega[own] = self._couples.spins(start, goal, interval)

    def forces(self, particles: ParticleSystem) -> Pushed:
        own = self._own(particles)
        force, couples = particles.force_on(own), None
        if self._turns(particles):
            couples = self._couples.now(particles.grains.torque[own], _centres(particles, own))
        return self._pushed(force, couples)

    def impulses(self, particles: ParticleSystem) -> Pushed:
        own = self._own(particles)
        impulse, couples = particles.impulse_on(own), None
        if self._turns(particles):
            couples = self._couples.over_window(particles.angular_impulse_on(own))
        return self._pushed(impulse, couples)

    def _pushed(self, force: Floats, couples: Floats | None) -> Pushed:
        return Pushed(self.nodal_forces(force if couples is None else force + couples), force.sum(axis=0))

    def _turns(self, particles: ParticleSystem) -> bool:
        """Whether there are torques, and they are kept."""
        return self._couples is not None and particles.contact.spins

    @property
    def drops_moment(self) -> bool:
        return self._couples is None

    def moment_dropped(self, particles: ParticleSystem) -> float:
        return 0.0 if self._couples is not None else float(particles.angular_impulse_on(self._own(particles)).sum())

    def _own(self, particles: ParticleSystem) -> slice:
        """Places of the glued grains, the first of the prescribed ones."""
        first = particles.grains.n_free
        return slice(first, first + len(self))

    def contact_forces(self, particles: ParticleSystem) -> Floats:
        return particles.force_on(self._own(particles))

    def closed(self, particles: ParticleSystem, look: ContactLook) -> tuple[csr_matrix, float]:
        own = self._own(particles)
        contacts, overlap = look.contacts[own], look.overlap[own]
        touching = np.nonzero(contacts)[0]
        several = diags(np.sqrt(contacts[touching]))  # partners of one grain add up
        return (several @ self.operator[touching]).tocsr(), float(overlap.max(initial=0.0))

    def work(self, particles: ParticleSystem) -> float:
        return particles.work_by(self._own(particles))


def _centres(particles: ParticleSystem, own: slice) -> Floats:
    """Centres (k, 2) [m] of some grains alone: all of them would be a copy as long as the bed."""
    return np.column_stack([particles.grains.x[own], particles.grains.y[own]])


class _Seats(NamedTuple):
    """Where glued grains sit: (k,) each, the facet, its nodes, and the share of its length."""

    facet: NDArray[np.int64]
    first: NDArray[np.int64]
    second: NDArray[np.int64]
    fraction: Floats

    def on_nodes(self, nodes: int) -> NDArray[np.int64]:
        """The grain on each node, -1 where there is none."""
        grain = np.full(nodes, -1)
        for node, end in ((self.first, 0.0), (self.second, 1.0)):
            there = np.nonzero(self.fraction == end)[0]
            grain[node[there]] = there
        return grain


def _seats(facets: NDArray[np.int64], per_facet: int) -> _Seats:
    """Seats in the order of the facets, and on the last nodes of open chains at the end."""
    last = np.nonzero(np.isin(facets[:, 1], np.setdiff1d(facets[:, 1], facets[:, 0])))[0]
    facet = np.append(np.repeat(np.arange(len(facets)), per_facet), last)
    fraction = np.append(np.tile(np.arange(per_facet) / per_facet, len(facets)), np.ones(len(last)))
    return _Seats(facet, facets[facet, 0], facets[facet, 1], fraction)
