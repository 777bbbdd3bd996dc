"""A moment of a system kept in memory, to run from it again with the same bits."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from particles.history import NAMES as HISTORY

if TYPE_CHECKING:
    from particles.system import ParticleSystem

Arrays = list[NDArray[Any]]
STEADY = (
    "radius", "mass", "inertia", "inverse_mass", "inverse_inertia", "roll_compliance", "material", "body", "number",
)  # fmt: skip
LISTED = ("x_listed", "y_listed")
OF_WALLS = ("px", "py", "vx", "vy", "gain_x", "gain_y", "force")
OF_FACETS = ("x", "y", "vx", "vy", "fx", "fy", "work", "side", "side_now", "pushes", "push", *LISTED)


class Snapshot:
    """What steps change, copied; the contact list itself by reference, as a new one replaces it whole.

    What only the sorting of grains changes is copied again after a new list alone, so that a snapshot taken
    at each of a few steps costs a third of `ParticleSystem.state`.

    Parameters
    ----------
    system : ParticleSystem
    """

    def __init__(self, system: ParticleSystem) -> None:
        self._system = system
        self._lists: tuple[Any, ...] = (None,)
        self._steady: Arrays = []
        self._moving: Arrays = []

    def take(self) -> None:
        """Keep the present state, in place of the one before."""
        system = self._system
        system.start()
        listing = system.list
        if self._lists[0] is not listing.pairs:
            self._steady = _copied(self._steady, self._of_lists())
        self._counters = (system.steps_done, system.rebuilds, listing.skin, system.passage)
        self._lists = (listing.pairs, listing.walls, None if system.facets is None else system.facets.arrays)
        self._moving = _copied(self._moving, self._of_steps())

    def rewind(self) -> None:
        """Go back to the state that was taken."""
        system = self._system
        sorted_again = system.list.pairs is not self._lists[0]
        system.list.pairs, system.list.walls, facets = self._lists
        if facets is not None:
            system.facets.arrays = facets
        system.steps_done, system.rebuilds, system.list.skin, system.passage = self._counters
        if sorted_again:
            _put(self._steady, self._of_lists())
        _put(self._moving, self._of_steps())

    def _of_lists(self) -> Iterable[NDArray[Any]]:
        """Arrays that change with a new list only."""
        grains = self._system.grains
        return [getattr(grains, name) for name in (*STEADY, *LISTED)]

    def _of_steps(self) -> Iterable[NDArray[Any]]:
        """Arrays that every step may change."""
        system = self._system
        pairs, walls, ledger = system.list.pairs, system.list.walls, system.ledger
        moving = [array for name, array in system.grains.arrays().items() if name not in STEADY + LISTED]
        for group in (pairs, walls):
            moving += [getattr(group, name) for name in HISTORY]
        moving += [getattr(walls, name) for name in OF_WALLS]
        moving += [pairs.crossing, system.impulse]
        if ledger is not None:
            moving += [ledger.loss, ledger.prescribed_work]
        if system.facets is not None:
            facets = system.facets.arrays
            moving += [getattr(facets, name) for name in OF_FACETS + HISTORY] + [facets.impulse]
        return moving


def _copied(into: Arrays, arrays: Iterable[NDArray[Any]]) -> Arrays:
    """Copies of arrays, in the memory of the last ones where they have the same sizes."""
    copies = []
    for k, array in enumerate(arrays):
        if k < len(into) and into[k].shape == array.shape:
            np.copyto(into[k], array)
            copies.append(into[k])
        else:
            copies.append(array.copy())
    return copies


def _put(values: Arrays, arrays: Iterable[NDArray[Any]]) -> None:
    for array, value in zip(arrays, values, strict=True):
        array[:] = value
