"""Discs in motion: state, contacts, walls and the leapfrog, behind one object."""

from collections.abc import Mapping, Sequence
from typing import Any

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from particles.contact import Contact, ContactTable, GlobalDamping
from particles.errors import ParticleError, require
from particles.facets import FacetContacts, Facets
from particles.kernels import advance as stepping
from particles.kernels import energy as looking
from particles.kernels.layout import (
    DAMPING_AHEAD,
    LEDGER_COLUMNS,
    WALL_WORK,
    FacetArrays,
    GrainArrays,
    LeadArrays,
    LedgerArrays,
)
from particles.kernels.motion import kick
from particles.look import ContactLook
from particles.neighbours import LISTS_PER_SORT, ContactList, block_starts
from particles.passing import Passage, deepest_passage
from particles.periodic import checked_period
from particles.shaking import Shaking, set_out, shaking_of
from particles.snapshot import Snapshot
from particles.state import PRECISIONS, Grains
from particles.threads import use_threads
from particles.walls import Wall

SCHEMES = ("leapfrog", "velocity_verlet")
LOSSES = ("normal_dashpot", "tangential_dashpot", "sliding", "rolling_dashpot", "rolling_slip", "global_damping")


class ParticleSystem:
    """Discs, their contacts and walls, advanced by the leapfrog.

    One step: drift ``x += dt v``; new contact list if a grain may have crossed the skin; contact
    forces at the new positions with the velocities of the half step between; kick ``v += dt F/m``
    (the prescribed grains keep the velocity they were given). Model 1.4; Gomes 2014, section 2.1.2.

    Parameters
    ----------
    grains : Grains
        Taken over and reordered in memory.
    contact : ContactModel or ContactTable
    time_step : float
        dt [s].
    walls : sequence of Wall
    shaking : Shaking, optional
        Motion of the walls that are `shaken`, and of prescribed bodies.
    facets : Facets, optional
        A polyline that moves with its nodes; not together with a period.
    gravity : (2,) floats
        [m/s2].
    damping : GlobalDamping, optional
    ledger : bool
        Keep losses and works for the energy balance.
    period : (2,) of float or None
        Lengths [m] after which x and y repeat, from 0 on; at least 5 of the largest radii. Positions
        are not folded back: a grain that goes around keeps counting.
    scheme : str
        "leapfrog", or "velocity_verlet", which differs in what dashpots and drag see: the velocity
        ``v(n-1/2) + dt a(n-1)/2`` at the present time instead of ``v(n-1/2)``.
    precision : str
        "float64", or "float32": forces, masses and what contacts remember are stored in single precision, computed
        in double. Positions, velocities and radii are always double. It takes a quarter less memory, and more time.
    skin_factor : float
        On the reach of the contact list beyond contact, which is chosen for the speed of the grains: a longer list that
        is made less often. It changes the order of sums, and so the last bits.
    threads : int
        The same bits for any number.

    Attributes
    ----------
    passage : Passage
        The deepest overlap met so far where a new list was made; centres do not pass each other unseen.

    Raises
    ------
    ParticleError
        For impossible parameters, coinciding centres, or a state that is no longer finite.
    """

    def __init__(
        self,
        grains: Grains,
        contact: Contact,
        *,
        time_step: float,
        walls: Sequence[Wall] = (),
        shaking: Shaking | None = None,
        facets: Facets | None = None,
        gravity: Sequence[float] = (0.0, 0.0),
        damping: GlobalDamping | None = None,
        ledger: bool = True,
        period: Sequence[float | None] = (None, None),
        scheme: str = "leapfrog",
        precision: str = "float64",
        skin_factor: float = 1.0,
        threads: int = 1,
    ) -> None:
        require("time step", time_step, above=0.0)
        if len(grains) == 0:
            raise ParticleError("a particle system needs at least one grain")
        most = max(int(grains.material.max()), *(part.material for part in [*walls, *([facets] if facets else [])]), 0)
        if isinstance(contact, ContactTable) and most >= contact.materials:
            raise ParticleError(f"material {most} has no row in the table of {contact.materials} contact laws: add it")
        self.grains = grains
        self.contact = contact
        self.walls = tuple(walls)
        self.shaking = shaking
        self._shaken = shaking_of(shaking, self.walls, grains)
        self.time_step = float(time_step)
        for name, value, allowed in (("scheme", scheme, SCHEMES), ("precision", precision, PRECISIONS)):
            if value not in allowed:
                raise ParticleError(f"{name} {value!r} must be one of {', '.join(allowed)}")
        self.scheme = scheme
        require("skin factor", skin_factor, above=0.0)
        grains.keep_in(precision)
        grains.keep_leads(scheme == "velocity_verlet")
        if not contact.spins:
            grains.torque[:] = 0.0  # no step writes it
        self.gravity = np.array(gravity, float)
        self.damping = damping
        self.threads = use_threads(threads)
        self.steps_done = self.rebuilds = 0
        self.blocks = block_starts(grains.n_free, len(grains))
        self.impulse = np.zeros((len(grains) - grains.n_free, 3))
        self.ledger = None
        if ledger:
            self.ledger = LedgerArrays(
                np.zeros((len(self.blocks) - 1, LEDGER_COLUMNS)), np.zeros(len(grains) - grains.n_free)
            )
        self.period = checked_period(period, grains.radius)
        if facets is not None and self.period != (None, None):
            raise ParticleError("facets do not go together with periodic sides: leave out one of them")
        self.facets = None if facets is None else FacetContacts(facets, contact, ledger=ledger)
        options = {"ledger": ledger, "period": self.period, "facets": self.facets}
        options |= {"precision": precision, "skin_factor": skin_factor, "smallest": float(grains.radius.min())}
        self.list = ContactList(contact, list(walls), **options)
        self._started, self.passage = False, Passage()

    # -- stepping -----------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Time of the present positions [s] since the system was made."""
        return self.steps_done * self.time_step

    def start(self) -> None:
        """Forces at the initial positions and the first half kick, which makes the leapfrog order 2."""
        if self._started:
            return
        self._rebuild()
        arrays, laws = self._arrays(), self.contact.numbers()
        set_out(self._shaken, self.list.walls, self.grains, self.time_step)
        stepping.forces(arrays, self.list.pairs, self.list.walls, self._facets(), *laws, None, self.ledger, 0.0)
        half, lead = 0.5 * self.time_step, self._lead()
        for block in range(len(self.blocks) - 2):
            kick(block, arrays, *self.gravity, self.contact.spins, self._damping(), lead, self.ledger, half)
        for gain in lead or ():
            gain *= 2.0  # the kick was by half a step
        if self.ledger is not None:
            ahead = 2.0 * self.ledger.loss[:, DAMPING_AHEAD].copy()
            self.ledger.loss[:] = 0.0
            self.ledger.loss[:, DAMPING_AHEAD] = ahead
        self._started = True

    def advance(self, steps: int) -> None:
        """Take `steps` leapfrog steps, making new contact lists where needed; 0 only loads the compiled code."""
        self.start()
        if not steps:  # nothing has passed yet
            deepest_passage(self.grains, self._arrays(), self.list, self.time_step, self.passage)
        self.impulse[:] = 0.0
        if self.facets is not None:
            self.facets.arrays.impulse[:] = 0.0
        threaded = self.threads > 1 and len(self.blocks) > 3  # one block of free grains leaves nothing to share
        step = stepping.advance_threaded if threaded else stepping.advance
        if threaded:
            numba.set_num_threads(self.threads)  # global: another system may have set its own
        laws, damping, drifted, left = self.contact.numbers(), self._damping(), False, int(steps)
        while True:
            arrays, listed = self._arrays(), self.list
            done, drifted = step(
                arrays, listed.pairs, listed.walls, self._shaken, self._facets(), self.gravity, *laws, damping,
                self._lead(), self.ledger, self.steps_done, bool(drifted), listed.reach2, left, self.time_step,
                self.threads if threaded else 1,
            )  # fmt: skip
            left -= done
            self.steps_done += done
            if not drifted:
                return
            self._rebuild()
            self.passage = deepest_passage(self.grains, self._arrays(), self.list, self.time_step, self.passage)

    def _rebuild(self) -> None:
        self.list.rebuild(self.grains, self.time_step, sort=self.rebuilds % LISTS_PER_SORT == 0)
        self.rebuilds += 1

    def _arrays(self) -> GrainArrays:
        g = self.grains
        return GrainArrays(
            g.x, g.y, g.theta, g.vx, g.vy, g.omega, g.fx, g.fy, g.torque, g.radius, g.mass, g.inertia,
            g.inverse_mass, g.inverse_inertia, g.roll_compliance, g.material, g.x_listed, g.y_listed, self.impulse, self.blocks,
            *self.period,
        )  # fmt: skip

    def _facets(self) -> FacetArrays | None:
        return None if self.facets is None else self.facets.arrays

    def _lead(self) -> LeadArrays | None:
        g = self.grains
        return None if self.scheme == "leapfrog" else LeadArrays(g.lead_x, g.lead_y, g.lead_spin)

    def _damping(self) -> Any:
        return None if self.damping is None else self.damping.numbers()

    # -- prescribed bodies --------------------------------------------------------------------

    def steer(self, places: slice, target: ArrayLike, interval: float, velocity: ArrayLike | None = None) -> None:
        """Send the prescribed grains at `places` to `target` (k, 2) [m] within `interval` [s].

        Their velocity is what takes them there, or `velocity` (k, 2) [m/s] if one is given: then
        they start from where that velocity ends at the target. Their spin stays.
        """
        goal = np.asarray(target, float)
        g = self.grains
        if velocity is None:
            g.vx[places] = (goal[:, 0] - g.x[places]) / interval
            g.vy[places] = (goal[:, 1] - g.y[places]) / interval
        else:
            self.set_velocity(places, velocity)
            g.x[places] = goal[:, 0] - interval * g.vx[places]
            g.y[places] = goal[:, 1] - interval * g.vy[places]

    def set_velocity(self, places: slice, velocity: ArrayLike) -> None:
        """Give prescribed grains a velocity (k, 2) or (2,) [m/s]."""
        speed = np.asarray(velocity, float)
        self.grains.vx[places], self.grains.vy[places] = speed[..., 0], speed[..., 1]

    def force_on(self, places: slice) -> NDArray[np.float64]:
        """Contact force (k, 2) [N/m] on the grains at `places`, at the present time."""
        return np.column_stack([self.grains.fx[places], self.grains.fy[places]]).astype(float, copy=False)

    def impulse_on(self, places: slice) -> NDArray[np.float64]:
        """Contact impulse (k, 2) [N s/m] on prescribed grains during the last `advance`."""
        first = self.grains.n_free
        return self.impulse[places.start - first : places.stop - first, :2]

    def angular_impulse_on(self, places: slice) -> NDArray[np.float64]:
        """Angular impulse (k,) [N m s/m] on prescribed grains about their centres during the last `advance`."""
        first = self.grains.n_free
        return self.impulse[places.start - first : places.stop - first, 2]

    # -- looking ------------------------------------------------------------------------------

    def look(self) -> ContactLook:
        """The contacts as they stand. Changes nothing."""
        self.start()
        n = len(self.grains)
        overlap, contacts = np.zeros(n), np.zeros(n, np.int64)
        numbers = looking.look_at_contacts(
            self._arrays(), self.list.pairs, self.list.walls, self._facets(), self.contact.numbers(), overlap, contacts
        )
        return ContactLook(*numbers, overlap, contacts)

    def energies(self, look: ContactLook | None = None) -> dict[str, float]:
        """Stored energies, summed losses and works [J/m] since the start, by name.

        ``kinetic + rotational + gravity + springs + losses - works`` is constant up to the error of
        the integrator. Kinetic energy is ``m v(n-1/2) v(n+1/2) / 2``.
        """
        look = look or self.look()
        kinetic, rotational, potential = looking.kinetic_energy(
            self._arrays(),
            self.grains.n_free,
            *self.gravity,
            self.contact.spins,
            self._damping(),
            self._lead(),
            self.time_step,
        )
        energies = {
            "kinetic": kinetic, "rotational": rotational, "gravity": potential,
            "normal_springs": look.normal_energy, "tangential_springs": look.tangential_energy,
            "rolling_springs": look.rolling_energy,
        }  # fmt: skip
        if self.ledger is not None:
            total = self.ledger.loss.sum(axis=0)
            energies |= {f"loss_{name}": total[k] for k, name in enumerate(LOSSES)}
            energies |= {"work_prescribed": self.ledger.prescribed_work.sum(), "work_walls": total[WALL_WORK]}
            if self.facets is not None:
                energies["work_facets"] = self.facets.work
        return {name: float(value) for name, value in energies.items()}

    @property
    def wall_force(self) -> NDArray[np.float64]:
        """Force (n_walls, 2) [N/m] of the grains on each wall."""
        return self.list.walls.force.sum(axis=0)

    def momentum(self) -> NDArray[np.float64]:
        """Momentum (2,) [kg/s] of the free grains at the half step."""
        free = slice(self.grains.n_free)
        mass = self.grains.mass[free]
        return np.array([mass @ self.grains.vx[free], mass @ self.grains.vy[free]])

    def work_by(self, places: slice) -> float:
        """Work [J/m] that prescribed grains did on the others since the start."""
        if self.ledger is None:
            raise ParticleError("ledger = False keeps no works: build the system with ledger=True")
        first = self.grains.n_free
        return float(self.ledger.prescribed_work[places.start - first : places.stop - first].sum())

    def force_residual(self) -> float:
        """Sum of all contact forces on grains, walls and facets over the sum of their magnitudes: round-off."""
        g = self.grains
        others = self.wall_force if self.facets is None else np.concatenate([self.wall_force, self.facets.force])
        total = np.array([g.fx.sum(dtype=float), g.fy.sum(dtype=float)]) + others.sum(axis=0)
        scale = np.hypot(g.fx, g.fy).sum(dtype=float) + np.hypot(*others.T).sum()
        return float(np.hypot(*total) / scale) if scale > 0.0 else 0.0

    # -- going back -----------------------------------------------------------------------------

    def snapshot(self, into: Snapshot | None = None) -> Snapshot:
        """The present state in memory, for `Snapshot.rewind`; `into` is a former one of this system, to be replaced."""
        kept = Snapshot(self) if into is None else into
        kept.take()
        return kept

    # -- checkpoint ---------------------------------------------------------------------------

    def state(self) -> dict[str, NDArray[Any]]:
        """Everything that is needed to go on with the same bits."""
        saved = {f"grains.{name}": array.copy() for name, array in self.grains.arrays().items()}
        saved["grains.n_free"] = np.array(self.grains.n_free)
        for group in ("pairs", "walls"):
            arrays = getattr(self.list, group)._asdict()
            saved |= {f"{group}.{name}": array.copy() for name, array in arrays.items()}
        if self.facets is not None:
            saved |= {f"facets.{name}": array for name, array in self.facets.state().items()}
        saved["skin"] = np.array(self.list.skin)
        saved["counters"] = np.array([self.steps_done, self.rebuilds, int(self._started)])
        if self.ledger is not None:
            saved["losses"] = self.ledger.loss.copy()
            saved["prescribed_work"] = self.ledger.prescribed_work.copy()
        return saved

    def restore(self, saved: Mapping[str, NDArray[Any]]) -> None:
        """Go back to a state made by `state` of a system with the same grains and features."""
        missing = self.state().keys() - saved.keys()
        if missing:
            raise ParticleError(
                f"saved state lacks {sorted(missing)[0]}: it was made with other features or by another "
                "version; start anew"
            )
        if len(saved["grains.x"]) != len(self.grains) or int(saved["grains.n_free"]) != self.grains.n_free:
            raise ParticleError(
                f"saved state has {len(saved['grains.x'])} grains, this system has {len(self.grains)}: "
                "use the scene the state was saved from"
            )
        for name, array in self.grains.arrays().items():
            array[:] = saved[f"grains.{name}"]
        for group in ("pairs", "walls"):
            names = getattr(self.list, group)._fields
            own = getattr(self.list, group)
            arrays = type(own)(*(np.array(saved[f"{group}.{name}"], getattr(own, name).dtype) for name in names))
            setattr(self.list, group, arrays)
        if self.facets is not None:
            own = {name: saved[f"facets.{name}"] for name in FacetArrays._fields}
            self.facets.restore(own)
        self.list.skin = float(saved["skin"])
        self.steps_done, self.rebuilds, started = (int(c) for c in saved["counters"])
        self._started, self.passage = bool(started), Passage()
        if self.ledger is not None:
            self.ledger.loss[:] = saved["losses"]
            self.ledger.prescribed_work[:] = saved["prescribed_work"]


def continued(saved: Mapping[str, NDArray[Any]], grains: Grains, contact: Contact, **options: Any) -> ParticleSystem:
    """A system that takes the free grains and contacts of a saved one and has prescribed grains of its own.

    Parameters
    ----------
    saved : mapping
        State of a system without prescribed grains, from `ParticleSystem.state`.
    grains : Grains
        The same free grains in the same order (`Grains.from_saved`), and the prescribed ones.
    contact, options
        As for `ParticleSystem`. Contacts keep their springs if both have the same features.
    """
    system = ParticleSystem(grains, contact, **options)
    system.list.take_over(saved, len(grains))
    system._started = True
    system._rebuild()
    return system
