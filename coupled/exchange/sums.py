"""What has passed between grains and structure, window by window."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupled.interface.door import Interface
from particles import ParticleSystem
from structure import Structure

Floats = NDArray[np.float64]


class Exchanged(NamedTuple):
    """Sums over the windows of a run, on rank 0.

    The grains' side of a window is the trapezoidal work of all grain steps, forces at places on the interface's way;
    the structure's is that of the nodal forces as it got them, over the way it went. Moments are about the mean
    place of the boundary nodes.

    Attributes
    ----------
    work : float
        Sum of the magnitudes of the work [J/m] of the interface on the grains in each window: what the
        difference of both works is measured against.
    worst_window : float
        Largest magnitude [J/m] of that difference in one window.
    moment_dropped : float
        Sum of the angular impulses [N m s/m] of the contacts that the structure did not get.
    dropped, passed : float
        Sums of the magnitudes [N m s/m] in each window of these, and of the moment of the forces that it got.
    given, received : float
        Works [J/m] of the interface on the grains and of the nodal forces on the structure since the start.
    """

    work: float = 0.0
    worst_window: float = 0.0
    moment_dropped: float = 0.0
    dropped: float = 0.0
    passed: float = 0.0
    given: float = 0.0
    received: float = 0.0

    def after_window(
        self,
        interface: Interface,
        particles: ParticleSystem,
        structure: Structure,
        interval: float,
        force: Floats,
        displacement: Floats,
    ) -> Exchanged:
        """The sums after one more window of `interval` [s].

        force, displacement : (n_b, 2)
            Of the grains on the boundary nodes [N/m], and of these nodes at the end of the interface's way [m].
        """
        given, received = interface.work(particles), structure.boundary_work
        done, taken = given - self.given, received - self.received
        dropped = passed = 0.0
        if interface.drops_moment:
            dropped = interface.moment_dropped(particles)
            places, impulse = structure.polyline.points + displacement, interval * force
            arm = places - places.mean(axis=0)
            passed = float(arm[:, 0] @ impulse[:, 1] - arm[:, 1] @ impulse[:, 0])
        return Exchanged(
            work=self.work + abs(done),
            worst_window=max(self.worst_window, abs(done + taken)),
            moment_dropped=self.moment_dropped + dropped,
            dropped=self.dropped + abs(dropped),
            passed=self.passed + abs(passed),
            given=given,
            received=received,
        )

    def share_of_work(self, residual: float) -> float:
        """A difference of works [J/m] over the work exchanged."""
        return abs(residual) / self.work if self.work > 0.0 else 0.0

    @property
    def share_dropped(self) -> float:
        """Moments dropped over those passed, by magnitude in each window."""
        return self.dropped / self.passed if self.passed > 0.0 else 0.0
