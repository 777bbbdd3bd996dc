"""The theory of large strain: a St Venant-Kirchhoff solid."""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from structure import compat
from structure.discrete import DiscreteBody
from structure.elements import ElementName, StandardElement
from structure.errors import StructureError
from structure.material import PlaneStrain, Rayleigh, largest_principal_strain, von_mises
from structure.results import StructurePeaks
from structure.stress import by_name
from structure.theories.gradients import GradientProbe, green_lagrange, least_stretch, logarithmic
from structure.theories.large_strain_step import LargeStrainStepper
from structure.theories.turning import TurningTheory


class LargeStrainTheory(TurningTheory):
    """Plane strain, ``S = lam tr(E) 1 + 2 mu E`` with the Green-Lagrange strain E; see `Theory`.

    Any displacement and rotation. Stress in the outputs is Cauchy's, ``sigma = F S F^T/det F``,
    ``sigma_zz = lam tr(E)/det F``; strain is the logarithmic one, ``ln V``; both in the axes of space.

    The material is not to be trusted in strong compression: under a uniaxial stretch s it resists with
    ``(lam + 2 mu) s (s^2 - 1)/2``, which has its peak at s = 0.577, and it does not keep cells from
    turning inside out. Standard elements only.
    """

    name = "large_strain"

    def __init__(
        self,
        body: DiscreteBody,
        material: PlaneStrain,
        *,
        element: ElementName | None,
        damping: Rayleigh | None,
        time_step: float,
    ) -> None:
        if element not in (None, "standard"):
            raise StructureError(
                f"element = {element!r} is not for theory = 'large_strain': its strains are small ones; use "
                "element = 'standard', of order 2 where the body bends"
            )
        self._body, self._material = body, material
        self.stiffness = StandardElement(body, material).stiffness_matrix()
        self.stepper = LargeStrainStepper(body, material, damping=damping, time_step=time_step)
        self._at_nodes: GradientProbe | None = None
        self._at_gauss: GradientProbe | None = None

    def nodal_stress(self) -> dict[str, NDArray[np.float64]]:
        """See `Theory`; averages of each cell's own Cauchy stress and logarithmic strain."""
        if self._at_nodes is None:
            self._at_nodes = GradientProbe(self._body, compat.interpolation_points(self._body.space))
        gradient = self._at_nodes(self.stepper.displacement)
        both = np.concatenate([self._cauchy(gradient), logarithmic(gradient)], axis=-1)
        mean = self._body.nodes.mean_over_cells(both)
        return by_name(mean[:, :4], mean[:, 4:])

    def peaks(self) -> StructurePeaks:
        """See `Theory`."""
        mesh, comm = self._body.mesh, self._body.comm
        if self._at_gauss is None:
            self._at_gauss = GradientProbe(self._body, compat.gauss_points(mesh.cell, 2 * mesh.order))
        gradient = self._at_gauss(self.stepper.displacement)
        stress, strain = von_mises(self._cauchy(gradient)), largest_principal_strain(logarithmic(gradient))
        return StructurePeaks(
            von_mises=comm.allreduce(float(stress.max(initial=0.0)), op=MPI.MAX),
            strain=comm.allreduce(float(strain.max(initial=0.0)), op=MPI.MAX),
            compression=comm.allreduce(float((1.0 - least_stretch(gradient)).max(initial=0.0)), op=MPI.MAX),
        )

    def _cauchy(self, gradient: NDArray[np.float64]) -> NDArray[np.float64]:
        """Cauchy stress [Pa] (..., 4) as xx, yy, xy, zz of displacement gradients (..., 2, 2)."""
        xx, yy, xy, zz = np.moveaxis(self._material.stress(green_lagrange(gradient)), -1, 0)
        second = np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)
        deformation = np.eye(2) + gradient
        volume = np.linalg.det(deformation)
        stress = deformation @ second @ np.swapaxes(deformation, -1, -2)
        parts = [stress[..., 0, 0], stress[..., 1, 1], stress[..., 0, 1], zz]
        return np.stack(parts, axis=-1) / volume[..., None]
