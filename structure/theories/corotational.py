"""The corotational theory: small strain in one frame that turns with the body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from structure import compat
from structure.discrete import DiscreteBody
from structure.elements import ElementName, element_of
from structure.material import PlaneStrain, Rayleigh
from structure.results import StructurePeaks
from structure.stress import StressProbe
from structure.theories.corotational_step import CorotationalStepper
from structure.theories.gradients import GradientProbe, rotation
from structure.theories.turning import TurningTheory


class CorotationalTheory(TurningTheory):
    """Linear elasticity of the displacement seen in the mean frame; see `CorotationalStepper`, `Theory`.

    The body may turn by any angle; strain, and the rotation of its parts against the frame, must be
    small: a part turned by an angle t shows the strain ``cos t - 1``. Any element.
    """

    name = "corotational"

    def __init__(
        self,
        body: DiscreteBody,
        material: PlaneStrain,
        *,
        element: ElementName | None,
        damping: Rayleigh | None,
        time_step: float,
    ) -> None:
        self._body, self._material = body, material
        self._element = element_of(element, body, material)
        self.stiffness = self._element.stiffness_matrix()
        self.stepper = CorotationalStepper(body, self.stiffness, damping=damping, time_step=time_step)
        self._probe: StressProbe | None = None
        self._gradient: GradientProbe | None = None

    def nodal_stress(self) -> dict[str, NDArray[np.float64]]:
        """See `Theory`."""
        pose = self.stepper.pose()
        return self._stress_probe().nodal(pose.local.view(np.float64), turned_by=pose.angle)

    def peaks(self) -> StructurePeaks:
        """See `Theory`; with the largest rotation of the material against the frame."""
        local = self.stepper.pose().local.view(np.float64)
        if self._gradient is None:
            mesh = self._body.mesh
            self._gradient = GradientProbe(self._body, compat.gauss_points(mesh.cell, 2 * mesh.order))
        largest = float(np.abs(rotation(self._gradient(local))).max(initial=0.0))
        return replace(self._stress_probe().peaks(local), local_rotation=self._body.comm.allreduce(largest, op=MPI.MAX))

    def _stress_probe(self) -> StressProbe:
        if self._probe is None:
            self._probe = StressProbe(self._body, self._material, self._element)
        return self._probe
