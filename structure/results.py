"""What a structure tells about itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, kw_only=True)
class StructureEnergies:
    """Energies [J/m]; ``kinetic + strain + rayleigh_loss + scheme_loss - external_work - boundary_work`` stays.

    Attributes
    ----------
    kinetic, strain
        ``v . M v/2`` and ``u . K u/2``, or the strain energy of the theory in use.
    rayleigh_loss
        Lost in Rayleigh damping since the start.
    external_work
        Trapezoidal work of the loads since the start (of the drive, for a prescribed motion).
    boundary_work
        Trapezoidal work of the nodal forces given to `advance` since the start.
    scheme_loss
        Taken by the scheme of time integration since the start (`NewmarkStepper.scheme_loss_of_step`); zero
        where it conserves, as Newmark's (1/4, 1/2) does.
    """

    kinetic: float
    strain: float
    rayleigh_loss: float
    external_work: float
    boundary_work: float
    scheme_loss: float = 0.0


@dataclass(frozen=True, kw_only=True)
class StructurePeaks:
    """Extremes over all Gauss points.

    Attributes
    ----------
    von_mises
        Largest von Mises stress [Pa].
    strain
        Largest magnitude of a principal strain, by the measure of the theory.
    local_rotation
        Largest rotation [rad] of the material against the frame of the body, where the theory has one.
    compression
        1 less the smallest principal stretch, at least 0, where strain may be large.
    """

    von_mises: float
    strain: float
    local_rotation: float | None = None
    compression: float | None = None


STRESS_AND_STRAIN = (
    "sigma_xx", "sigma_yy", "sigma_xy", "sigma_zz", "von_mises",
    "strain_xx", "strain_yy", "strain_xy",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class StructureFields:
    """Fields on the nodes in original order, the same for any number of ranks, on every rank.

    Attributes
    ----------
    points : (n, 2)
        Reference positions [m].
    cells : (m, k)
        Nodes of each cell in VTK order.
    cell_kind : str
        "quadrilateral", "quadrilateral9", "triangle" or "triangle6".
    point_data : dict
        "displacement" (n, 2) [m], "velocity" (n, 2) [m/s] and (n,) each: "sigma_xx", "sigma_yy",
        "sigma_xy", "sigma_zz", "von_mises" [Pa], "strain_xx", "strain_yy", "strain_xy" (tensor
        component). Stress and strain are averages, over the cells around a node, of each cell's
        own value there; "von_mises" is that of the averaged stress.
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    cell_kind: str
    point_data: dict[str, NDArray[np.float64]]


def cell_kind(cell: str, order: int) -> str:
    """Name of the cell with its number of nodes where that is not the number of corners."""
    return cell if order == 1 else cell + {"quadrilateral": "9", "triangle": "6"}[cell]
