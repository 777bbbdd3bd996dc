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
    """Each disc meets the chain of nodes `chain`, whose solid is on its left, wherever its distance has an extremum.

    Feet on facets and on corners that point at the disc are minima and push; nodes of notches between two feet are
    maxima and pull as much. What is left is the push of the nearest point but in notches that a disc covers, where
    that would jump from one facet to the other.
    """

    def __init__(self, body: IndependentBody, discs: Discs, chain: np.ndarray) -> None:
        self.body, self.discs, self.chain = body, discs, chain

    def __call__(self, time: float, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nodal forces, and the normal force of each disc."""
        discs, chain, speeds = self.discs, self.chain, v.reshape(-1, 2)
        places, velocity = (self.body.points + u.reshape(-1, 2))[chain], speeds[chain]
        centres = (discs.centres + time * discs.velocity)[:, None]
        own = np.broadcast_to(discs.velocity, discs.centres.shape)[:, None]
        along = np.diff(places, axis=0)
        after_start = np.sum((centres - places[:-1]) * along, axis=2) >= 0.0  # (discs, facets)
        after_end = np.sum((centres - places[1:]) * along, axis=2) >= 0.0
        size = np.sum(along**2, axis=1)
        share = np.sum((centres - places[:-1]) * along, axis=2) / size
        nodal, pushes = np.zeros((len(self.body.points), 2)), np.zeros(len(centres))

        def add(
            sign: np.ndarray, foot: np.ndarray, speed: np.ndarray, ends: list[tuple[np.ndarray, np.ndarray]]
        ) -> None:
            """Forces of the features with a sign, shared by nodes `ends` (node of each feature, share of each pair)."""
            arm = foot - centres
            distance = np.hypot(*np.moveaxis(arm, 2, 0))
            near = (sign != 0) & (distance < discs.radius)
            normal = arm / np.where(near, distance, 1.0)[:, :, None]
            closing = -np.sum((speed - own) * normal, axis=2)
            push = near * sign * law(discs, discs.radius - distance, closing)
            pushes[:] += push.sum(axis=1)
            for node, part in ends:
                np.add.at(nodal, node, ((part * push)[:, :, None] * normal).sum(axis=0))

        foot = places[:-1] + share[:, :, None] * along
        speed = velocity[:-1] + share[:, :, None] * np.diff(velocity, axis=0)
        one = np.ones_like(share)
        add(after_start.astype(int) - after_end, foot, speed, [(chain[:-1], one - share), (chain[1:], share)])
        left, right = np.pad(after_end, ((0, 0), (1, 0)), constant_values=True), np.pad(after_start, ((0, 0), (0, 1)))
        if chain[0] == chain[-1]:  # closed: the last node is the first, and has been counted
            left[:, 0], right[:, -1] = left[:, -1], left[:, -1]
        here = np.broadcast_to(places, (len(centres), *places.shape))
        add(left.astype(int) - right, here, velocity, [(chain, np.ones(left.shape))])
        return nodal.ravel(), pushes


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
