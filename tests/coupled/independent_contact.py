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
    """Each disc meets the nearest point of the chain of nodes `chain`, whose solid is on its left."""

    def __init__(self, body: IndependentBody, discs: Discs, chain: np.ndarray) -> None:
        self.body, self.discs, self.chain = body, discs, chain
        places = body.points[chain]
        middle = (places[1:] + places[:-1]) / 2
        apart = np.linalg.norm(discs.centres[:, None] - middle, axis=2)
        self.candidates = np.argsort(apart, axis=1)[:, :3]

    def __call__(self, time: float, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nodal forces, and the normal force of each disc."""
        discs, count = self.discs, len(self.candidates)
        places = (self.body.points + u.reshape(-1, 2))[self.chain]
        centres = discs.centres + time * discs.velocity
        begin, end = places[self.candidates], places[self.candidates + 1]
        along = end - begin
        share = np.sum((centres[:, None] - begin) * along, axis=2) / np.sum(along**2, axis=2)
        share = np.clip(share, 0.0, 1.0)
        arms = begin + share[:, :, None] * along - centres[:, None]
        best = np.argmin(np.sum(arms**2, axis=2), axis=1)
        rows = np.arange(count)
        facet, share, arm = self.candidates[rows, best], share[rows, best], arms[rows, best]
        distance = np.hypot(*arm.T)
        normal = arm / distance[:, None]
        first, second = self.chain[facet], self.chain[facet + 1]
        speeds = v.reshape(-1, 2)
        speed = (1 - share)[:, None] * speeds[first] + share[:, None] * speeds[second]
        push = law(discs, discs.radius - distance, -np.sum((speed - discs.velocity) * normal, axis=1))
        nodal = np.zeros((len(self.body.points), 2))
        np.add.at(nodal, first, ((1 - share) * push)[:, None] * normal)
        np.add.at(nodal, second, (share * push)[:, None] * normal)
        return nodal.ravel(), push


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
