"""The linear theory: small strain and small rotation about the reference shape."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from structure.discrete import DiscreteBody
from structure.elements import ElementName, element_of
from structure.loads.vectors import LoadVectors
from structure.material import PlaneStrain, Rayleigh
from structure.results import StructurePeaks
from structure.schemes import Scheme
from structure.statics import balanced_displacement
from structure.stress import StressProbe
from structure.theories.newmark import NewmarkStepper


class LinearTheory:
    """``M a + C v + K u = f``, ``C = c_a M + c_b K``; see `Theory`.

    A body that turns as a whole is stressed by the turn: a rotation by an angle t shows the
    strain ``cos t - 1``.
    """

    def __init__(
        self,
        body: DiscreteBody,
        material: PlaneStrain,
        *,
        element: ElementName | None,
        damping: Rayleigh | None,
        scheme: Scheme,
        time_step: float,
    ) -> None:
        self._body, self._material = body, material
        self._element = element_of(element, body, material)
        self.stiffness = self._element.stiffness_matrix()
        self.stepper = NewmarkStepper(
            mass=body.mass_matrix,
            stiffness=self.stiffness,
            damping=_damping_matrix(body.mass_matrix, self.stiffness, damping),
            scheme=scheme,
            time_step=time_step,
            arms=(body.mesh.points[body.nodes.owned] - body.mesh.outer_polyline.points[0]) @ np.array([1.0, 1j]),
        )
        self._probe: StressProbe | None = None

    def rotation(self) -> float:
        """See `Theory`; within (-pi, pi]."""
        return self._body.mean_rotation(self.stepper.displacement)

    def nodal_stress(self) -> dict[str, NDArray[np.float64]]:
        """See `Theory`."""
        return self._stress_probe().nodal(self.stepper.displacement)

    def peaks(self) -> StructurePeaks:
        """See `Theory`."""
        return self._stress_probe().peaks(self.stepper.displacement)

    def static_displacement(self, loads: LoadVectors) -> NDArray[np.float64]:
        """See `Theory`; free of rigid motion."""
        return balanced_displacement(self._body, self.stiffness, self._material, loads)

    def memory(self) -> dict[str, NDArray[np.float64]]:
        """See `Theory`: what a step needs of the one before."""
        stepper, memory = self.stepper, {}
        if stepper.looks_back:
            memory["force"] = self._body.nodes.gather(stepper.force)
        if stepper.damped_before is not None:
            memory["damped"] = self._body.nodes.gather(stepper.damped_before)
        return memory

    def recall(self, state: dict[str, NDArray[np.float64]]) -> None:
        """See `Theory`."""
        stepper = self.stepper
        if stepper.looks_back:
            stepper.force[:] = self._body.nodes.share(state["force"])
            stepper.remember_force()
        if stepper.damped_before is not None:
            stepper.damped_before[:] = self._body.nodes.share(state["damped"])
            stepper.look_ahead()

    def _stress_probe(self) -> StressProbe:
        if self._probe is None:
            self._probe = StressProbe(self._body, self._material, self._element)
        return self._probe


def _damping_matrix(mass: PETSc.Mat, stiffness: PETSc.Mat, damping: Rayleigh | None) -> PETSc.Mat | None:
    """``c_a M + c_b K``, or None without damping."""
    if damping is None or damping.mass_factor == damping.stiffness_factor == 0.0:
        return None
    matrix = stiffness.copy()
    matrix.scale(damping.stiffness_factor)
    same = PETSc.Mat.Structure.SAME_NONZERO_PATTERN
    matrix.axpy(damping.mass_factor, mass, structure=same)
    return matrix
