"""What is advanced: grains, a structure, or both with the exchange between them."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupled.exchange.iterated import IteratedExchange, Iteration
from coupled.exchange.sums import Exchanged
from coupled.interface.closed_ratio import ClosedRatio
from coupled.interface.door import Interface, Pushed
from particles import ParticleSystem
from particles import Snapshot as GrainSnapshot
from structure import Structure, agreed_force, withhold_force

Floats = NDArray[np.float64]


class Snapshot(NamedTuple):
    """A moment of a model in memory, this rank's share."""

    grains: GrainSnapshot | None
    structure: dict[str, Any] | None
    own: tuple[int, Floats | None, Pushed, Exchanged]
    exchange: dict[str, Floats]


class Model:
    """Grains, a structure, or both, advanced in steps of the structure.

    One coupled step of length ``H = substeps dt``:

    - predicted (default): the interface moves to the predicted boundary ``u + H v + H^2 a/2``
      while the grains take their `substeps`; the contact force goes to the nodes at the new time;
      the structure steps. With k substeps the force is the mean of those at ``H/k, 2 H/k ... H``, which
      belongs to ``(k + 1)/(2 k) H``; the last two means are extrapolated to the window's end,
      ``f + (k - 1)/(2 k) (f - f_old)``. Given to the nodes as it is, the mean lags and feeds energy into
      the interface at any step.
    - lagged (the source's order): the structure steps with the forces of the last window; the
      interface moves to where it went while the grains take their substeps.
    - iterated: the window is run again until both agree on its end (`IteratedExchange`).

    Under MPI the structure lives on all ranks, the grains on rank 0, where `particles` is not None.

    Parameters
    ----------
    particles : ParticleSystem, optional
    structure : Structure, optional
    interface : Interface, optional
        Needed with both; its grains or facets are those of `particles`.
    substeps : int
        Grain steps per structure step.
    lagged : bool
        The source's order of the exchange.
    iteration : Iteration, optional
        Have the iterated exchange.

    Attributes
    ----------
    nodal_force : (n_b, 2)
        Of the grains on the boundary nodes in the last window [N/m], its mean with sub-cycling.
    reaction : (2,)
        Its resultant, from the contacts themselves [N/m].
    exchanged : Exchanged
        Sums over the windows; on rank 0.
    followed : tuple of int
        Numbers of the grains that the history follows.
    closed_ratio : ClosedRatio or None
        Watches the stiffness ratio, where whoever made the model wants it.
    """

    def __init__(
        self,
        *,
        particles: ParticleSystem | None = None,
        structure: Structure | None = None,
        interface: Interface | None = None,
        substeps: int = 1,
        lagged: bool = False,
        iteration: Iteration | None = None,
        time_step: float,
    ) -> None:
        self.particles, self.structure, self.interface = particles, structure, interface
        self.substeps, self.lagged = substeps, lagged
        self.window = substeps * time_step
        self.steps_done = 0
        self.seconds = {"grains": 0.0, "structure": 0.0, "exchange": 0.0}
        self._boundary = None if structure is None else structure.boundary_displacement
        self.nodal_force = np.zeros_like(structure.polyline.points) if structure is not None else np.zeros((0, 2))
        self.reaction = np.zeros(2)
        self.exchanged = Exchanged()
        if particles is not None and interface is not None:
            particles.start()
            self._take(interface.forces(particles))
        if structure is not None and interface is not None:
            structure.begin_under(self.nodal_force)
        self.closed_ratio: ClosedRatio | None = None
        self.followed: tuple[int, ...] = ()
        self.iterated = None
        if iteration is not None and interface is not None:
            self.iterated = IteratedExchange(self, iteration)

    @property
    def time(self) -> float:
        """Present time [s]."""
        return self.steps_done * self.window

    def advance(self, steps: int) -> None:
        """Take `steps` structure steps (grain steps, if there is no structure)."""
        if self.structure is None:
            started = time.perf_counter()
            if self.particles is not None:
                self.particles.advance(steps * self.substeps)
            self.seconds["grains"] += time.perf_counter() - started
        elif self.interface is None:
            started = time.perf_counter()
            for _ in range(steps):
                self.structure.advance(self.nodal_force)
            self.seconds["structure"] += time.perf_counter() - started
        else:
            step = self._step()
            for _ in range(steps):
                step()
                self._count()
            if self.structure.comm.size > 1:  # an error of the last step reaches the ranks without grains here
                agreed_force(self.nodal_force, self.nodal_force.shape, self.structure.comm)
        self.steps_done += steps

    def _step(self) -> Callable[[], None]:
        """The exchange in use."""
        if self.iterated is not None:
            return self.iterated.step
        return self._lagged_step if self.lagged else self._predicted_step

    def _predicted_step(self) -> None:
        started, before = time.perf_counter(), self.nodal_force
        self.move_grains(self.structure.predict(self.window))
        moved = time.perf_counter()
        force, ahead = self.nodal_force, 0.5 * (self.substeps - 1) / self.substeps
        self.structure.advance(force + ahead * (force - before) if ahead else force)
        self.seconds["structure"] += time.perf_counter() - moved
        self.seconds["exchange"] += moved - started

    def _lagged_step(self) -> None:
        started = time.perf_counter()
        self.structure.advance(self.nodal_force)
        stepped = time.perf_counter()
        self.move_grains(self.structure.boundary_displacement)
        self.seconds["structure"] += stepped - started
        self.seconds["exchange"] += time.perf_counter() - stepped

    def move_grains(self, displacement: Floats) -> None:
        """Take the grains through one window that ends with the boundary at `displacement`."""
        if self.particles is None:
            return
        particles, interface = self.particles, self.interface
        interface.move(particles, displacement, self._boundary, self.window)
        self._boundary = displacement
        started = time.perf_counter()
        try:
            particles.advance(self.substeps)
        except Exception as error:
            withhold_force(error, self.nodal_force.shape, self.structure.comm)
            raise
        taken = time.perf_counter() - started
        self.seconds["grains"] += taken
        self.seconds["exchange"] -= taken
        if self.substeps == 1:
            self._take(interface.forces(particles))
        else:
            received = interface.impulses(particles)
            self._take(Pushed(received.nodal / self.window, received.resultant / self.window))

    def _count(self) -> None:
        """Enter the window that has just ended."""
        started = time.perf_counter()
        if self.particles is not None:
            parts = (self.interface, self.particles, self.structure)
            self.exchanged = self.exchanged.after_window(*parts, self.window, self.nodal_force, self._boundary)
        self.seconds["exchange"] += time.perf_counter() - started

    def _take(self, pushed: Pushed) -> None:
        self.nodal_force, self.reaction = pushed

    @property
    def contact_force(self) -> Floats:
        """Forces (k, 2) [N/m] on the structure now: one for each glued grain; with facets one for each grain."""
        return self.interface.contact_forces(self.particles)

    def snapshot(self, into: Snapshot | None = None) -> Snapshot:
        """The present moment, for `rewind`; the memory of a former one, `into`, is used again."""
        grains = None
        if self.particles is not None:
            grains = self.particles.snapshot(None if into is None else into.grains)
        body = None if self.structure is None else self.structure.snapshot()
        exchange = {} if self.iterated is None else self.iterated.state()
        own = (self.steps_done, self._boundary, Pushed(self.nodal_force, self.reaction), self.exchanged)
        return Snapshot(grains, body, own, exchange)

    def rewind(self, snapshot: Snapshot, *, forget: bool = True) -> None:
        """Go back to a moment of this model: what follows has the same bits.

        `forget`: what the iterated exchange has learnt since.
        """
        self.steps_done, self._boundary, pushed, self.exchanged = snapshot.own
        self._take(pushed)
        if snapshot.structure is not None:
            self.structure.rewind(snapshot.structure)
        if snapshot.grains is not None:
            snapshot.grains.rewind()
        if self.iterated is not None and forget:
            self.iterated.restore(snapshot.exchange)

    def state(self) -> dict[str, NDArray[Any]]:
        """Everything that is needed to go on with the same bits; whole on rank 0."""
        saved: dict[str, NDArray[Any]] = {"model.steps_done": np.array(self.steps_done)}
        saved |= {"model.nodal_force": self.nodal_force.copy(), "model.reaction": self.reaction.copy()}
        if self.structure is not None:
            saved["model.boundary"] = self._boundary.copy()
            saved |= {f"structure.{name}": array for name, array in self.structure.state().items()}
        if self.particles is not None:
            saved |= {f"particles.{name}": array for name, array in self.particles.state().items()}
            saved["model.exchanged"] = np.array(self.exchanged)
        if self.iterated is not None:
            saved |= {f"exchange.{name}": array for name, array in self.iterated.state().items()}
        return saved

    def restore(self, saved: Mapping[str, NDArray[Any]]) -> None:
        """Go back to a state of the same scene; rank 0's counts."""
        self.steps_done = int(saved["model.steps_done"])
        if self.structure is not None:
            self.structure.restore(_part(saved, "structure."))
            self._boundary = np.array(saved["model.boundary"])
        if self.particles is not None:
            self.particles.restore(_part(saved, "particles."))
            self._take(Pushed(np.array(saved["model.nodal_force"]), np.array(saved["model.reaction"])))
            self.exchanged = Exchanged(*saved.get("model.exchanged", np.zeros(0)).tolist())  # older states have none
        if self.iterated is not None:
            self.iterated.restore(_part(saved, "exchange."))


def _part(saved: Mapping[str, NDArray[Any]], prefix: str) -> dict[str, NDArray[Any]]:
    return {name.removeprefix(prefix): array for name, array in saved.items() if name.startswith(prefix)}
