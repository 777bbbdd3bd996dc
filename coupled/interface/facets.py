"""The facet interface: grains meet the boundary itself."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from coupled.interface.door import Pushed, shares
from meshes import BoundaryPolyline
from particles import ContactLook, Facets, Grains, ParticleSystem
from particles.beds import drop_height_of_facets

Floats = NDArray[np.float64]
TINY = np.finfo(float).tiny


class FacetInterface:
    """Discs against the boundary polyline: facets, corners and notches (`particles.Facets`).

    Forces act at the foot of each disc's centre and go to the two nodes of its facet in the shares
    of the foot, rolling moments as couples: resultant and moment of the nodal forces are those of
    the contacts to round-off. In elements of order 2 each half of a side is a straight facet.

    Parameters
    ----------
    polyline : BoundaryPolyline
        Reference boundary [m].
    boundaries : sequence of str
        Names of the boundaries that grains meet. Where they end, the last node is a tip.
    closest : float, optional
        Smallest distance between two contacts [m], the diameter of the smallest grain; None if no
        grain will come.

    Attributes
    ----------
    operator : (k, n_b) sparse
        P of the closest contacts that are possible: `closest` apart, on nodes where they can be. It
        is one arrangement among many, not the worst of all; on facets shorter than `closest` they
        stand on every node that is far enough from the one before, the first of the chain included.
    """

    radius = math.inf
    drops_moment = False

    def __init__(
        self, polyline: BoundaryPolyline, *, boundaries: Sequence[str] = ("outer",), closest: float | None = None
    ) -> None:
        self.polyline = polyline
        carrying = np.any([polyline.on(name) for name in boundaries], axis=0)
        self._facets, self._lengths = polyline.facets[carrying], polyline.lengths()[carrying]
        self.operator = self._possible(0.0 if closest is None else closest)

    def __len__(self) -> int:
        return len(self._facets)

    def describe(self) -> tuple[str, str]:
        return "facets, shortest", f"{len(self)}, {self._lengths.min():.4g} m"

    def enter(self, grains: Grains, material: int) -> Grains:
        return grains

    def facets(self, material: int) -> Facets:
        return Facets(points=self.polyline.points, facets=self._facets, material=material)

    def fall_onto(self, grains: Grains | None) -> float:
        points = self.polyline.points
        floor = float(points[self._facets, 1].min())
        return floor if grains is None else min(floor, drop_height_of_facets(grains, points, self._facets))

    def move(self, particles: ParticleSystem, displacement: Floats, before: Floats, interval: float) -> None:
        particles.facets.steer(self.polyline.points + displacement, interval)

    def forces(self, particles: ParticleSystem) -> Pushed:
        force = particles.facets.force
        return Pushed(force, force.sum(axis=0))

    def impulses(self, particles: ParticleSystem) -> Pushed:
        impulse = particles.facets.impulse
        return Pushed(impulse, impulse.sum(axis=0))

    def moment_dropped(self, particles: ParticleSystem) -> float:
        return 0.0

    def contact_forces(self, particles: ParticleSystem) -> Floats:
        return particles.facets.force_by_grain(len(particles.grains))

    def closed(self, particles: ParticleSystem, look: ContactLook) -> tuple[csr_matrix, float]:
        a = particles.facets.arrays
        slots = np.nonzero(a.pushes)[0]
        feature, push = a.feature[slots], a.push[slots]
        whole = push.sum(axis=1)
        share = np.einsum("kns,ks->kn", push, whole) / np.maximum(np.sum(whole**2, axis=1), TINY)[:, None]
        nodes = np.column_stack([a.before[feature], a.at[feature], a.after[feature]])
        used = (nodes >= 0) & (share != 0.0)
        rows = np.repeat(np.arange(len(slots)), used.sum(axis=1))
        operator = csr_matrix((share[used], (rows, nodes[used])), shape=(len(slots), len(self.polyline.points)))
        overlap = particles.facets.touching(particles.grains)[:, 2]
        return operator, float(overlap.max(initial=0.0))

    def work(self, particles: ParticleSystem) -> float:
        return particles.facets.work

    def _possible(self, closest: float) -> csr_matrix:
        """Contacts along the chains, each at least `closest` from the one before."""
        starts, apart = set(self._facets[:, 0].tolist()), closest * (1.0 - 1e-9)
        rows: list[tuple[int, int, float]] = []
        since, node = math.inf, -1
        for (start, end), length in zip(self._facets.tolist(), self._lengths, strict=True):
            number = max(1, int(length / apart)) if closest > 0.0 else 1
            if start != node or since >= apart:
                rows += [(start, end, k / number) for k in range(number)]
                since = 0.0
            since, node = since + length / number, end
            if end not in starts and since >= apart:
                rows.append((start, end, 1.0))
        first, second, fraction = (np.array(column) for column in zip(*rows, strict=True))
        return shares(first, second, fraction, len(self.polyline.points))
