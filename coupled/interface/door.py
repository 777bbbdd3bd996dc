"""The door between grains and structure, whichever of its kinds a scene names."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from meshes import BoundaryPolyline
from particles import ContactLook, Facets, Grains, ParticleSystem

Floats = NDArray[np.float64]
POWER_STEPS, POWER_TOLERANCE = 300, 1e-4  # of the power iteration for the stiffness ratio


class Pushed(NamedTuple):
    """What the grains do to a structure."""

    nodal: Floats  # (n_b, 2) forces on the boundary nodes [N/m], couples included
    resultant: Floats  # (2,) their sum, from the contacts themselves


class Interface(Protocol):
    """Where grains meet a structure: `GluedGrains` or `FacetInterface`.

    Attributes
    ----------
    polyline : BoundaryPolyline
        Reference boundary.
    radius : float
        Of what the grains meet [m]; infinite for facets.
    drops_moment : bool
        Whether torques of the contacts are lost.
    operator : (k, n_b) sparse
        P: displacements of the closest contacts that are possible from those of the boundary nodes.
    """

    polyline: BoundaryPolyline
    radius: float
    drops_moment: bool
    operator: csr_matrix

    def describe(self) -> tuple[str, str]:
        """What it is made of, and how much of it, for `leito check`."""

    def enter(self, grains: Grains, material: int) -> Grains:
        """The grains and those that belong to the interface."""

    def facets(self, material: int) -> Facets | None:
        """The facets of the interface for a `ParticleSystem`, if it has any."""

    def fall_onto(self, grains: Grains | None) -> float:
        """How far it can be lowered before it touches free grains or the floor at y = 0 [m]."""

    def move(self, particles: ParticleSystem, displacement: Floats, before: Floats, interval: float) -> None:
        """Send it from boundary displacements `before` (n_b, 2) to `displacement` within `interval` [s]."""

    def forces(self, particles: ParticleSystem) -> Pushed:
        """Forces of the grains at the present time."""

    def impulses(self, particles: ParticleSystem) -> Pushed:
        """Impulses of the grains [N s/m] during the last `advance`."""

    def moment_dropped(self, particles: ParticleSystem) -> float:
        """Angular impulse [N m s/m] of the last `advance` that is not given to the structure."""

    def contact_forces(self, particles: ParticleSystem) -> Floats:
        """Forces (k, 2) [N/m] on the structure now: one for each glued grain; with facets one for each grain."""

    def closed(self, particles: ParticleSystem, look: ContactLook) -> tuple[csr_matrix, float]:
        """P of the contacts that are closed now (k, n_b), and the deepest of their overlaps [m]."""

    def work(self, particles: ParticleSystem) -> float:
        """Work [J/m] that it did on the grains since the start."""


def stiffness_ratio(
    operator: csr_matrix,
    stiffness: float,
    dashpot: float,
    interval: float,
    acceleration_by: Callable[[Floats], Floats],
) -> float:
    """The coupling's ``r = H^2 (k + 2 c/H) lambda``, with lambda the largest eigenvalue of P M^-1 P^T.

    That of a spring k [N/m] and a dashpot c [N s/m] to a fixed partner at every row of P, H [s] the
    structure's step: the predicted exchange is stable up to r = 2 (one mode that alternates in
    sign; the structure's own stiffness does not move the limit). Free partners give way, so a bed
    of grains bears more. `acceleration_by` maps nodal forces (n_b, 2) to boundary accelerations
    (n_b, 2); power iteration.
    """
    back = operator.T.tocsr()
    force = np.random.default_rng(0).normal(size=(operator.shape[0], 2))
    growth = 0.0
    for _ in range(POWER_STEPS):
        force /= np.linalg.norm(force)
        force = operator @ acceleration_by(back @ force)
        before, growth = growth, float(np.linalg.norm(force))
        if abs(growth - before) <= POWER_TOLERANCE * growth:
            break
    return (interval**2 * stiffness + 2.0 * interval * dashpot) * growth


def longest_window(ratio: float, stiffness: float, dashpot: float, interval: float, limit: float) -> float:
    """The H [s] at which `stiffness_ratio` is `limit`, when it is `ratio` at `interval` [s]."""
    by_mode = ratio / (interval**2 * stiffness + 2.0 * interval * dashpot)
    return (math.sqrt(dashpot**2 + stiffness * limit / by_mode) - dashpot) / stiffness


def shares(first: NDArray[np.int64], second: NDArray[np.int64], fraction: Floats, nodes: int) -> csr_matrix:
    """Rows with ``1 - s`` at the first node and s at the second, shape (k, nodes)."""
    rows = np.arange(len(fraction))
    values = np.concatenate([1.0 - fraction, fraction])
    places = (np.concatenate([rows, rows]), np.concatenate([first, second]))
    matrix = csr_matrix((values, places), shape=(len(fraction), nodes))
    matrix.eliminate_zeros()
    return matrix
