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

    def nodal(self, displacement: NDArray[np.float64], *, turned_by: float = 0.0) -> dict[str, NDArray[np.float64]]:
        """Stress [Pa] and strain by name, (n,) in original order, averaged over cells around.

        `displacement` is seen in a frame that is turned by an angle [rad] against space; the components
        are those in space.
        """
        strain = self._body.nodes.mean_over_cells(self._at_nodes(displacement))
        if turned_by:
            strain = turned(strain, turned_by)
        return by_name(self._material.stress(strain), strain)

    def peaks(self, displacement: NDArray[np.float64]) -> StructurePeaks:
        """Largest von Mises stress and principal strain over the Gauss points of all cells."""
        strain = self._at_gauss(displacement)
        stress = von_mises(self._material.stress(strain))
        comm = self._body.comm
        return StructurePeaks(
            von_mises=comm.allreduce(float(stress.max(initial=0.0)), op=MPI.MAX),
            strain=comm.allreduce(float(largest_principal_strain(strain).max(initial=0.0)), op=MPI.MAX),
        )


def by_name(stress: NDArray[np.float64], strain: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Columns of nodal stress (n, 4) as xx, yy, xy, zz [Pa] and strain (n, 3) as xx, yy, xy."""
    columns = [*stress.T, von_mises(stress), *strain.T]
    return dict(zip(STRESS_AND_STRAIN, columns, strict=True))


def turned(tensor: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """``R t R^T``, R a turn by `angle` [rad], of a symmetric tensor (..., 3) as xx, yy, xy."""
    xx, yy, xy = np.moveaxis(tensor, -1, 0)
    deviator = ((xx - yy) / 2 + 1j * xy) * np.exp(2j * angle)
    mean = (xx + yy) / 2
    return np.stack([mean + deviator.real, mean - deviator.real, deviator.imag], axis=-1)
