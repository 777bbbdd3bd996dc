"""The frame that turns with a body: the rotation that fits best, and the displacement seen in it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from structure.discrete import DiscreteBody

Complex = NDArray[np.complex128]


class Pose(NamedTuple):
    """Where a body is, seen from its centroid.

    Vectors of the plane are complex numbers, x + i y, one per owned node; a turn by t is the
    factor ``exp(i t)``.

    arms : present positions relative to the centroid [m], (n,); local : displacement w in the frame
    [m], (n,); angle : of the frame [rad], within (-pi, pi]; hold : rho = |z| [kg m].
    """

    arms: Complex
    local: Complex
    angle: float
    hold: float


class MeanFrame:
    """The frame at the angle ``t = arg z``, ``z = int rho (X . x + i X x x)``, of a discrete body.

    X and x are the reference and present positions relative to the centroid; ``w = R(t)^T x - X``.
    By this choice of t, w has no mean rotation: ``int rho X x w = 0``.
    """

    def __init__(self, body: DiscreteBody) -> None:
        self._body = body
        self.arms = as_complex(body.mesh.points[body.nodes.owned] - body.centroid)
        self.turning = as_complex(body.measures[2])

    def pose(self, displacement: NDArray[np.float64]) -> Pose:
        """Pose of a displacement (owned unknowns,) [m]; collective."""
        body = self._body
        x, y, cross, along = body.totals(body.measures @ displacement).tolist()
        moved = as_complex(displacement) - complex(x, y) / body.mass
        z = complex(body.inertia + along, cross)
        angle = math.atan2(z.imag, z.real)
        # exp(-i t) (X + moved) - X without the difference of large numbers
        back = complex(-2.0 * math.sin(angle / 2) ** 2, -math.sin(angle))
        local = (1.0 + back) * moved + back * self.arms
        return Pose(self.arms + moved, local, angle, abs(z))

    def spin(self, pose: Pose, velocity: NDArray[np.float64]) -> float:
        """Rate of the angle [rad/s] at nodal velocities (owned unknowns,) [m/s]; collective."""
        along = np.exp(1j * pose.angle) * self.turning
        return self._body.total(float(np.vdot(along, as_complex(velocity)).real)) / pose.hold

    def relative_velocity(self, velocity: NDArray[np.float64]) -> Complex:
        """Velocities [m/s] less that of the centroid; collective."""
        x, y = (self._body.momentum(velocity) / self._body.mass).tolist()
        return as_complex(velocity) - complex(x, y)


def wrapped(angle: float) -> float:
    """The angle [rad] less whole turns, within [-pi, pi]."""
    return math.remainder(angle, 2 * math.pi)


def unwrapped(angle: float, near: float) -> float:
    """The angle [rad] plus the whole turns that bring it nearest to another."""
    return angle + 2 * math.pi * round((near - angle) / (2 * math.pi))


def as_complex(values: NDArray[np.float64]) -> Complex:
    """Pairs x, y, flat or (n, 2), as x + i y (n,): the same memory where it is contiguous."""
    return np.ascontiguousarray(values).reshape(-1).view(np.complex128)
