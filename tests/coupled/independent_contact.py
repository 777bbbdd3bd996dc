"""Contact of an independent body with discs on prescribed ways, without friction, in numpy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from independent_beam import IndependentBeam
from independent_body import IndependentBody


@dataclass(frozen=True, kw_only=True)
class Discs:
    """Discs (k,): centres at t = 0 (k, 2) [m], velocities (k, 2) [m/s], radius [m]; the contact's k_n and c_n."""

    centres: np.ndarray
    radius: float
    stiffness: float
    dashpot: float = 0.0
    velocity: np.ndarray | float = 0.0


class OnGluedDiscs:
    """Each disc meets the one of its own on the body: at `share` between nodes `first` and `second`."""

    def __init__(
        self,
        body: IndependentBody,
        discs: Discs,
        first: np.ndarray,
        second: np.ndarray,
        share: np.ndarray,
        radius: float,
    ) -> None:
        self.discs, self.reach = discs, radius + discs.radius
        self.place = body.between(first, second, share)
        self.reference = self.place @ body.points.ravel()

    def __call__(self, time: float, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nodal forces, and the normal force of each pair."""
        discs = self.discs
        arm = (self.reference + self.place @ u).reshape(-1, 2) - discs.centres - time * discs.velocity
        distance = np.hypot(*arm.T)
        normal = arm / distance[:, None]
        closing = -np.sum(((self.place @ v).reshape(-1, 2) - discs.velocity) * normal, axis=1)
        push = law(discs, self.reach - distance, closing)
        return self.place.T @ (push[:, None] * normal).ravel(), push


class OnFacets:
    """Each disc meets the nearest point of the chain of nodes `chain`, whose solid is on its left.

    Places in the plane are complex numbers here.
    """

    def __init__(self, body: IndependentBody, discs: Discs, chain: np.ndarray) -> None:
        self.discs, self.chain, self.size = discs, chain, body.size
        self.reference, self.centres = _plane(body.points)[chain], _plane(discs.centres)
        self.speed = 0.0 if np.isscalar(discs.velocity) else _plane(discs.velocity)
        middle = (self.reference[1:] + self.reference[:-1]) / 2
        self.candidates = np.argsort(np.abs(self.centres[:, None] - middle), axis=1)[:, :2]
        self.rows = np.arange(len(self.centres))

    def __call__(self, time: float, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nodal forces, and the normal force of each disc."""
        discs, chain = self.discs, self.chain
        places, speeds = self.reference + _plane(u)[chain], _plane(v)[chain]
        along = np.diff(places)
        unit = along / (along.real**2 + along.imag**2)
        from_begin = (self.centres + time * self.speed)[:, None] - places[self.candidates]
        share = np.clip((from_begin * unit.conj()[self.candidates]).real, 0.0, 1.0)
        arms = share * along[self.candidates] - from_begin
        best = self.rows, np.argmin(arms.real**2 + arms.imag**2, axis=1)
        facet, share, arm = self.candidates[best], share[best], arms[best]
        distance = np.abs(arm)
        normal = arm / distance
        speed = (1 - share) * speeds[facet] + share * speeds[facet + 1] - self.speed
        push = law(discs, discs.radius - distance, -(speed * normal.conj()).real)
        nodes = np.concatenate([chain[facet], chain[facet + 1]])
        force = np.concatenate([(1 - share) * push * normal, share * push * normal])
        nodal = np.zeros(self.size)
        for component, values in enumerate((force.real, force.imag)):
            nodal[component::2] = np.bincount(nodes, values, self.size // 2)
        return nodal, push


def _plane(values: np.ndarray) -> np.ndarray:
    """(x, y) pairs, flat or in rows, as complex numbers."""
    return np.ascontiguousarray(values, dtype=float).reshape(-1).view(complex)


def law(discs: Discs, overlap: np.ndarray, closing: np.ndarray) -> np.ndarray:
    """Spring and dashpot that never pull."""
    touching = overlap > 0.0
    return touching * np.maximum(0.0, discs.stiffness * overlap + discs.dashpot * closing)


def row_below(
    beam: IndependentBeam, interface: str, springs: np.ndarray, *, radius: float, stiffness: float
) -> OnGluedDiscs | OnFacets:
    """Fixed discs at the abscissae `springs` that just touch the lower face of a beam, or discs glued to it."""
    standoff = radius if interface == "glued" else 0.0
    centres = np.column_stack([springs, np.full(len(springs), -radius - standoff)])
    discs = Discs(centres=centres, radius=radius, stiffness=stiffness)
    if interface == "glued":
        return OnGluedDiscs(beam, discs, *beam.facet_of(springs), radius=radius)
    return OnFacets(beam, discs, np.arange(beam.along + 1))
