"""The corotational theory: small strain in one frame that turns with the body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from structure import compat
from structure.discrete import DiscreteBody
from structure.elements import ElementName, element_of
from structure.errors import StructureError
from structure.loads.vectors import LoadVectors
from structure.material import PlaneStrain, Rayleigh
from structure.results import StructurePeaks
from structure.stress import StressProbe
from structure.theories.corotational_step import CorotationalStepper
from structure.theories.gradients import GradientProbe, rotation


class CorotationalTheory:
    """Linear elasticity of the displacement seen in the mean frame; see `CorotationalStepper`, `Theory`.

    The body may turn by any angle; strain, and the rotation of its parts against the frame, must be
    small: a part turned by an angle t shows the strain ``cos t - 1``. Any element.
    """

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

    def rotation(self) -> float:
        """See `Theory`; whole turns counted."""
        return self.stepper.turn

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

    def static_displacement(self, loads: LoadVectors) -> NDArray[np.float64]:
        """See `Theory`; refused."""
        raise no_statics("corotational")

    def memory(self) -> dict[str, NDArray[np.float64]]:
        """See `Theory`: the whole turns."""
        return {"rotation": np.array(self.rotation())}

    def recall(self, state: dict[str, NDArray[np.float64]]) -> None:
        """See `Theory`."""
        self.stepper.resume(float(state["rotation"]))

    def _stress_probe(self) -> StressProbe:
        if self._probe is None:
            self._probe = StressProbe(self._body, self._material, self._element)
        return self._probe


def no_statics(theory: str) -> StructureError:
    """What is said where a position of rest is asked of a theory that is not linear."""
    return StructureError(
        f"static_displacement is that of theory = 'linear', not of '{theory}': let the body come to rest under "
        "Rayleigh damping instead"
    )
