"""The outer boundary seen through the unknowns: forces in, motion out."""

from __future__ import annotations

import math

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from structure.errors import StepError, StructureError
from structure.nodes import NodeMap


def agreed_force(force: NDArray[np.float64], shape: tuple[int, ...], comm: MPI.Intracomm) -> NDArray[np.float64]:
    """A copy of the nodal forces of rank 0, on every rank; its error, if it has one instead (`withhold_force`).

    Raises
    ------
    StructureError
        The array has not the `shape` (n_b, 2).
    """
    if comm.rank == 0 and np.shape(force) != shape:
        wrong = StructureError(
            f"boundary_force has shape {np.shape(force)}: one force per boundary node, {shape}, is needed"
        )
        withhold_force(wrong, shape, comm)
        raise wrong
    if comm.size == 1:
        return np.array(force, dtype=float)
    packet = np.zeros(shape[0] * shape[1] + 1)  # the last number is not zero where an error follows
    if comm.rank == 0:
        packet[:-1] = np.ravel(force)
    comm.Bcast(packet, root=0)
    if packet[-1] != 0.0:
        raise comm.bcast(None, root=0)
    return packet[:-1].reshape(shape)


def require_finite(works: float, force: NDArray[np.float64], time: float, time_step: float) -> None:
    """Refuse to go on after a step whose works are none, whatever made them so.

    Parameters
    ----------
    works : float
        Sum of the works [J/m] of forces over the motion of the step, or of all steps: not finite as soon as a force
        or a displacement of the boundary is not.
    force : (n_b, 2)
        Nodal forces of the step [N/m].
    time, time_step : float
        End and length of the step [s].

    Raises
    ------
    StepError
    """
    if math.isfinite(works):
        return
    lost = np.argwhere(~np.isfinite(force))
    if len(lost):
        node = int(lost[0, 0])
        raise StepError(
            f"t = {time:g} s: the force on boundary node {node} is ({force[node, 0]:g}, {force[node, 1]:g}) N/m: give "
            "finite numbers; if grains have made it, use a smaller time step"
        )
    raise StepError(
        f"t = {time:g} s: the motion of the structure has left the finite numbers in a step of {time_step:g} s: its "
        "loads are too large or its numbers too far apart; change them, or take a smaller step"
    )


def withhold_force(error: Exception, shape: tuple[int, ...], comm: MPI.Intracomm) -> None:
    """Tell the other ranks, who wait in `agreed_force`, that rank 0 has no forces but an error; call it there."""
    if comm.size > 1:
        packet = np.ones(shape[0] * shape[1] + 1)
        comm.Bcast(packet, root=0)
        comm.bcast(error, root=0)


class LocalBoundary:
    """All unknowns are on this rank: plain indexing."""

    def __init__(self, nodes: NodeMap, outer_nodes: NDArray[np.int64]) -> None:
        row = np.argsort(nodes.owned)[outer_nodes]
        self._dofs = np.column_stack([2 * row, 2 * row + 1])

    def add(self, force: NDArray[np.float64], into: NDArray[np.float64]) -> None:
        """Add nodal forces (n_b, 2) to the flat force array."""
        into[self._dofs] += force

    def read(
        self, arrays: tuple[NDArray[np.float64], ...], sums: tuple[float, ...]
    ) -> tuple[list[NDArray[np.float64]], tuple[float, ...]]:
        """Boundary values (n_b, 2) of flat arrays, and the sums over all ranks."""
        return [array.take(self._dofs) for array in arrays], sums


class SharedBoundary:
    """Unknowns on several ranks: the one gather brings motion back."""

    def __init__(self, nodes: NodeMap, outer_nodes: NDArray[np.int64], comm: MPI.Intracomm) -> None:
        self._comm = comm
        place = np.full(outer_nodes.max() + 1, -1)
        place[outer_nodes] = np.arange(len(outer_nodes))
        inside = nodes.owned <= outer_nodes.max()
        rows = np.flatnonzero(inside)
        rows = rows[place[nodes.owned[rows]] >= 0]
        self._mine = place[nodes.owned[rows]]
        self._dofs = np.column_stack([2 * rows, 2 * rows + 1])
        self._places = comm.allgather(self._mine)
        self._shape = (len(outer_nodes), 2)

    def add(self, force: NDArray[np.float64], into: NDArray[np.float64]) -> None:
        """Add nodal forces (n_b, 2) to this rank's flat force array."""
        into[self._dofs] += force[self._mine]

    def read(
        self, arrays: tuple[NDArray[np.float64], ...], sums: tuple[float, ...]
    ) -> tuple[list[NDArray[np.float64]], tuple[float, ...]]:
        """Boundary values (n_b, 2) of flat arrays, and the sums over all ranks, in rank order."""
        width = 2 * len(arrays)
        mine = [array.take(self._dofs) for array in arrays]
        packet = np.concatenate([np.hstack(mine).ravel(), sums])
        counts = [width * len(places) + len(sums) for places in self._places]
        received = np.empty(sum(counts))
        self._comm.Allgatherv(packet, [received, counts])
        table = np.empty((self._shape[0], width))
        totals = np.zeros(len(sums))
        begin = 0
        for places, count in zip(self._places, counts):
            share = received[begin : begin + count]
            table[places] = share[: width * len(places)].reshape(-1, width)
            totals += share[width * len(places) :]
            begin += count
        values = [np.ascontiguousarray(table[:, k : k + 2]) for k in range(0, width, 2)]
        return values, tuple(totals.tolist())


def boundary_exchange(
    nodes: NodeMap, outer_nodes: NDArray[np.int64], comm: MPI.Intracomm
) -> LocalBoundary | SharedBoundary:
    """The exchange that fits the number of ranks."""
    if comm.size == 1:
        return LocalBoundary(nodes, outer_nodes)
    return SharedBoundary(nodes, outer_nodes, comm)
