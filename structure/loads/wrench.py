"""Loads that turn with a rigid body, as a resultant and a moment in the body's own axes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from structure.loads.pressure import PressedBoundary


@dataclass(frozen=True, kw_only=True)
class Wrench:
    """Resultant (2,) [N/m] on the body as it lies at the start, moment [N] about the centroid."""

    force: NDArray[np.float64]
    moment: float

    def force_on(self, angle: float) -> NDArray[np.float64]:
        """Resultant (2,) [N/m] on the body turned by `angle` [rad]."""
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, -s], [s, c]]) @ self.force


class FollowingLoads:
    """The pressures that follow a rigid body: of the present shape, which is the turned one.

    Parameters
    ----------
    followers
        The pressed boundaries.
    arms : (n, 2)
        Reference places of all nodes from the centroid [m], in original order.
    """

    def __init__(self, followers: Sequence[PressedBoundary], arms: NDArray[np.float64]) -> None:
        self._schedules = [follower.schedule for follower in followers]
        rows = []
        for follower in followers:
            force, (x, y) = follower.force(), arms[follower.nodes].T
            rows.append([*force.sum(axis=0), x @ force[:, 1] - y @ force[:, 0]])
        self._rows = np.array(rows).reshape(-1, 3)

    def at(self, time: float) -> Wrench:
        """What acts at `time` [s]."""
        force_x, force_y, moment = np.array([s.factor(time) for s in self._schedules]) @ self._rows
        return Wrench(force=np.array([force_x, force_y]), moment=float(moment))
