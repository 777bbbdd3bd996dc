"""Strain and stress of a displacement field, at nodes and at Gauss points."""

from __future__ import annotations

import numpy as np
from dolfinx import fem
from mpi4py import MPI
from numpy.typing import NDArray

from structure import compat, forms
from structure.discrete import DiscreteBody
from structure.material import PlaneStrain, largest_principal_strain, von_mises
from structure.results import STRESS_AND_STRAIN, StructurePeaks


class StressProbe:
    """Evaluates strain and stress of this body; compiled once."""

    def __init__(self, body: DiscreteBody, material: PlaneStrain) -> None:
        self._body, self._material = body, material
        mesh = body.mesh
        self._displacement = fem.Function(body.space)
        strain = forms.strain_components(self._displacement)
        owned_cells = mesh.domain.topology.index_map(2).size_local
        self._cells = np.arange(owned_cells, dtype=np.int32)
        gauss = compat.gauss_points(mesh.cell, 2 * mesh.order)
        self._at_nodes = compat.compiled_expression(strain, compat.interpolation_points(body.space))
        self._at_gauss = compat.compiled_expression(strain, gauss)

    def _strain(self, expression: fem.Expression, displacement: NDArray[np.float64]) -> NDArray[np.float64]:
        """Strain (owned cells, points, 3) of flat nodal displacements."""
        x = self._displacement.x
        x.array[: len(displacement)] = displacement
        x.scatter_forward()
        values = compat.evaluate(expression, self._body.mesh.domain, self._cells)
        return values.reshape(len(self._cells), -1, 3)

    def nodal(self, displacement: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Stress [Pa] and strain by name, (n,) in original order, averaged over cells around."""
        strain = self._strain(self._at_nodes, displacement)
        strain = self._body.nodes.mean_over_cells(strain)
        stress = self._material.stress(strain)
        columns = [*stress.T, von_mises(stress), *strain.T]
        return dict(zip(STRESS_AND_STRAIN, columns, strict=True))

    def peaks(self, displacement: NDArray[np.float64]) -> StructurePeaks:
        """Largest von Mises stress and principal strain over the Gauss points of all cells."""
        strain = self._strain(self._at_gauss, displacement)
        stress = von_mises(self._material.stress(strain))
        comm = self._body.comm
        return StructurePeaks(
            von_mises=comm.allreduce(float(stress.max(initial=0.0)), op=MPI.MAX),
            strain=comm.allreduce(float(largest_principal_strain(strain).max(initial=0.0)), op=MPI.MAX),
        )
