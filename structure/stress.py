"""Strain and stress of a displacement field, at nodes and at Gauss points."""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from structure import compat
from structure.discrete import DiscreteBody
from structure.elements import Element
from structure.material import PlaneStrain, largest_principal_strain, von_mises
from structure.results import STRESS_AND_STRAIN, StructurePeaks


class StressProbe:
    """Evaluates strain and stress of this body; compiled once."""

    def __init__(self, body: DiscreteBody, material: PlaneStrain, element: Element) -> None:
        self._body, self._material = body, material
        mesh = body.mesh
        self._at_nodes = element.strain_at(compat.interpolation_points(body.space))
        self._at_gauss = element.strain_at(compat.gauss_points(mesh.cell, 2 * mesh.order))

    def nodal(self, displacement: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Stress [Pa] and strain by name, (n,) in original order, averaged over cells around."""
        strain = self._body.nodes.mean_over_cells(self._at_nodes(displacement))
        stress = self._material.stress(strain)
        columns = [*stress.T, von_mises(stress), *strain.T]
        return dict(zip(STRESS_AND_STRAIN, columns, strict=True))

    def peaks(self, displacement: NDArray[np.float64]) -> StructurePeaks:
        """Largest von Mises stress and principal strain over the Gauss points of all cells."""
        strain = self._at_gauss(displacement)
        stress = von_mises(self._material.stress(strain))
        comm = self._body.comm
        return StructurePeaks(
            von_mises=comm.allreduce(float(stress.max(initial=0.0)), op=MPI.MAX),
            strain=comm.allreduce(float(largest_principal_strain(strain).max(initial=0.0)), op=MPI.MAX),
        )
