"""Plane motion of a rigid body: three coordinates, their rates, and what nodes do."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshes import StructureMesh
from structure.results import STRESS_AND_STRAIN, StructureFields, StructurePeaks, cell_kind

NO_STRESS = StructurePeaks(von_mises=0.0, strain=0.0)


@dataclass(frozen=True, kw_only=True)
class RigidMotion:
    """Motion of the centroid and turn about it: reference arm R goes to ``x + Q(angle) R``.

    shift (2,) [m], angle [rad], velocity (2,) [m/s], spin [rad/s], acceleration (2,) [m/s^2],
    angular_acceleration [rad/s^2]; counter-clockwise positive.
    """

    shift: NDArray[np.float64]
    angle: float = 0.0
    velocity: NDArray[np.float64]
    spin: float = 0.0
    acceleration: NDArray[np.float64]
    angular_acceleration: float = 0.0

    def turned(self, arms: NDArray[np.float64]) -> NDArray[np.float64]:
        """Present arms (n, 2) [m] of reference arms (n, 2)."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return arms @ np.array([[c, s], [-s, c]])

    def displacement_of(self, arms: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacement (n, 2) [m] of the points at reference arms (n, 2)."""
        if self.angle == 0.0:
            return np.tile(self.shift, (len(arms), 1))
        return self.turned(arms) - arms + self.shift

    def velocity_of(self, arms: NDArray[np.float64]) -> NDArray[np.float64]:
        """Velocity (n, 2) [m/s], ``v + spin e_z x r``."""
        return self.velocity + self.spin * _quarter_turn(self.turned(arms))

    def acceleration_of(self, arms: NDArray[np.float64]) -> NDArray[np.float64]:
        """Acceleration (n, 2) [m/s^2], ``a + alpha e_z x r - spin^2 r``."""
        present = self.turned(arms)
        turning = self.angular_acceleration * _quarter_turn(present)
        return self.acceleration + turning - self.spin**2 * present


def _quarter_turn(arms: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.column_stack([-arms[:, 1], arms[:, 0]])


def rigid_fields(mesh: StructureMesh, centroid: NDArray[np.float64], motion: RigidMotion) -> StructureFields:
    """Fields of a rigid body: displacement and velocity; stress and strain are zero."""
    arms = mesh.points - centroid
    moving = {"displacement": motion.displacement_of(arms), "velocity": motion.velocity_of(arms)}
    zero = {name: np.zeros(len(arms)) for name in STRESS_AND_STRAIN}
    return StructureFields(
        points=mesh.points,
        cells=mesh.cells,
        cell_kind=cell_kind(mesh.cell, mesh.order),
        point_data=moving | zero,
    )
