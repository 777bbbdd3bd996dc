"""Between this rank's unknowns and the original node order, which no number of ranks changes."""

from __future__ import annotations

import numpy as np
from dolfinx import fem
from numpy.typing import NDArray

from meshes import StructureMesh
from structure import compat


class NodeMap:
    """Maps nodal arrays between the owned part of a rank and the original order.

    Attributes
    ----------
    owned : (owned nodes,)
        Original number of each node of this rank, in the order of its unknowns.
    cells : (owned cells, k)
        Original numbers of the nodes of this rank's cells, in the order of the cell's unknowns.
    """

    def __init__(self, mesh: StructureMesh, space: fem.FunctionSpace) -> None:
        self._comm = mesh.domain.comm
        self._count = len(mesh.points)
        dofs = space.dofmap.index_map
        local = compat.cell_nodes(mesh.domain)
        original = np.asarray(mesh.domain.geometry.input_global_indices)
        numbers = np.full(dofs.size_local + dofs.num_ghosts, -1, dtype=np.int64)
        for cell, nodes in enumerate(local):
            numbers[space.dofmap.cell_dofs(cell)] = original[nodes]
        self.owned = numbers[: dofs.size_local].copy()
        owned_cells = mesh.domain.topology.index_map(2).size_local
        self.cells = original[local[:owned_cells]]
        self._everyone = np.concatenate(self._comm.allgather(self.owned))

    def gather(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Owned values (flat, two per node) -> (n, 2) in original order, on every rank."""
        result = np.empty((self._count, 2))
        shares = self._comm.allgather(values.reshape(-1, 2))
        result[self._everyone] = np.concatenate(shares)
        return result

    def share(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """The owned part, flat, of (n, 2) values in original order."""
        return np.ascontiguousarray(values[self.owned]).ravel()

    def mean_over_cells(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Cells' own nodal values (owned cells, k, c) -> average per node (n, c), everywhere."""
        components = values.shape[-1]
        sums = np.zeros((self._count, components + 1))
        np.add.at(sums[:, :components], self.cells, values)
        np.add.at(sums[:, components], self.cells, 1.0)
        sums = self._comm.allreduce(sums)
        return sums[:, :components] / sums[:, components:]


def fill(function: fem.Function, values: NDArray[np.float64]) -> None:
    """Owned values into a function, ghosts from their owners."""
    function.x.array[: len(values)] = values
    function.x.scatter_forward()
