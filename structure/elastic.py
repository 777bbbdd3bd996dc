"""The elastic structure: a free plane-strain body, its strain by the theory that is asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from meshes import StructureMesh
from structure import checks, modes
from structure.boundary import agreed_force, boundary_exchange, require_finite
from structure.discrete import DiscreteBody
from structure.elements import ElementName
from structure.errors import StepError, StructureError
from structure.loads.load import Load
from structure.loads.vectors import LoadVectors
from structure.material import PlaneStrain, Rayleigh
from structure.overturned import first_overturned
from structure.results import StructureEnergies, StructureFields, StructurePeaks, cell_kind
from structure.rewinding import Rewinding, Snapshot
from structure.schemes import Newmark, Scheme
from structure.solvers.solver import factorise
from structure.theories.choice import theory_of
from structure.theories.follower_limit import require_followers_fit
from structure.theories.theory import TheoryName

STATE_FIELDS = ("displacement", "velocity", "acceleration")


class ElasticStructure(Rewinding):
    """Elastic body without supports, ``M a + C v + f_int(u) = loads + boundary forces``; see `Structure`.

    What f_int is, and how far the body may turn and stretch, is said by its theory.

    Parameters
    ----------
    mesh
        Shape, boundaries, order of the elements.
    material, damping, scheme, loads
        What it is made of, Rayleigh damping or None, scheme of time integration, external loads.
    time_step : float
        Length [s] of every step.
    element : {"standard", "enhanced"}, optional
        Displacements alone, or, for quadrilaterals of order 1, strains enhanced so that a coarse mesh
        bends as it should, also near nu = 0.5. Absent: enhanced where cells and theory allow it.
    theory : {"linear", "corotational", "large_strain"}
        Small strain and rotation about the reference shape, ``f_int = K u`` (`LinearTheory`); small strain in a
        frame that turns with the body (`CorotationalTheory`); St Venant-Kirchhoff (`LargeStrainTheory`).
        The last two have a step of their own, which keeps energy and angular momentum.
    ledger : bool
        Keep the sums of work and loss that `energies` reports.

    Attributes
    ----------
    comm, polyline, mass, time_step
        Communicator, reference outer boundary, mass [kg/m], step [s].
    boundary_displacement, boundary_velocity, boundary_acceleration : (n_b, 2)
        [m], [m/s], [m/s^2], in the order of ``polyline.points``, on every rank; new arrays at
        each step.
    """

    REPLACED = (
        "_steps", "_loss", "_scheme_loss", "_external_work", "_boundary_work", "_external", "_force",
        "boundary_displacement", "boundary_velocity", "boundary_acceleration",
    )  # fmt: skip

    def __init__(
        self,
        mesh: StructureMesh,
        *,
        material: PlaneStrain,
        time_step: float,
        damping: Rayleigh | None = None,
        scheme: Scheme = Newmark(),
        loads: Sequence[Load] = (),
        element: ElementName | None = None,
        theory: TheoryName = "linear",
        ledger: bool = True,
    ) -> None:
        checks.positive("time_step", time_step, "s")
        self.mesh, self.comm, self.polyline = mesh, mesh.domain.comm, mesh.outer_polyline
        self.material, self.damping, self.scheme, self.time_step = material, damping, scheme, float(time_step)
        self._body = DiscreteBody(mesh, material.density)
        self.mass = self._body.mass
        self._theory = theory_of(
            theory, self._body, material, element=element, damping=damping, scheme=scheme, time_step=self.time_step
        )
        self._stepper = self._theory.stepper
        self._exchange = boundary_exchange(self._body.nodes, mesh.outer_nodes, self.comm)
        self._loads, self._beta = LoadVectors(self._body, loads), scheme.beta
        if self._loads.followers:
            require_followers_fit(self._body, self._loads.followers, theory, self._beta * self.time_step**2)
        lines = self.polyline.points - self.polyline.points[0]
        farthest = int(np.argmax(np.hypot(*lines.T)))
        self._line = (farthest, *(lines[farthest] / (lines[farthest] @ lines[farthest])).tolist())
        self._mass_solve: Callable[[PETSc.Vec, PETSc.Vec], None] | None = None
        self._ledger = ledger
        self.set_initial()

    @property
    def time(self) -> float:
        """Time [s] since the start."""
        return self._steps * self.time_step

    def set_initial(
        self,
        displacement: NDArray[np.float64] | None = None,
        velocity: NDArray[np.float64] | None = None,
        boundary_force: NDArray[np.float64] | None = None,
    ) -> None:
        """Start anew at t = 0; the acceleration follows from equilibrium.

        Parameters
        ----------
        displacement, velocity : (n, 2)
            [m], [m/s], in the order of ``mesh.points``; zero if absent.
        boundary_force : (n_b, 2)
            Nodal forces [N/m] at t = 0; zero if absent.
        """
        stepper = self._stepper
        for name, own, given in (
            ("displacement", stepper.displacement, displacement),
            ("velocity", stepper.velocity, velocity),
        ):
            own[:] = 0.0 if given is None else self._body.nodes.share(self._nodal(name, given))
        if boundary_force is None:
            boundary_force = np.zeros_like(self.polyline.points)
        self._steps = 0
        self._loss = self._external_work = self._boundary_work = self._scheme_loss = 0.0
        self._external = self._loads.at(0.0, stepper.displacement)
        stepper.force[:] = self._external
        self._force = agreed_force(boundary_force, self.polyline.points.shape, self.comm)
        require_finite(float(self._force.sum()), self._force, 0.0, self.time_step)
        self._exchange.add(self._force, stepper.force)
        stepper.start()
        self._read_boundary()

    def require_resolved(self) -> None:
        """Refuse a time step whose round-off moves the body as a whole (`round_off`).

        `advance` does not ask: who looks at stiff modes alone may take such a step.

        Raises
        ------
        StructureError
        """
        self._stepper.require_resolved()

    def begin_under(self, boundary_force: NDArray[np.float64]) -> None:
        """Start anew at t = 0 from the present shape and motion, under nodal forces (n_b, 2) [N/m]."""
        gather, stepper = self._body.nodes.gather, self._stepper
        self.set_initial(
            displacement=gather(stepper.displacement),
            velocity=gather(stepper.velocity),
            boundary_force=boundary_force,
        )

    def acceleration_by(self, boundary_force: NDArray[np.float64]) -> NDArray[np.float64]:
        """Boundary acceleration (n_b, 2) [m/s^2] that nodal forces (n_b, 2) [N/m] alone cause.

        ``(M^-1)_bb f`` with the consistent mass: what a step feels first, whatever the stiffness.
        """
        if self._mass_solve is None:
            self._mass_solve = factorise(self._body.mass_matrix, self._body.mass_matrix)
        right, left = self._body.mass_matrix.createVecs()
        right.set(0.0)
        self._exchange.add(agreed_force(boundary_force, self.polyline.points.shape, self.comm), right.array)
        self._mass_solve(right, left)
        return self._exchange.read((left.array,), ())[0][0]

    def advance(self, boundary_force: NDArray[np.float64]) -> None:
        """One step with nodal forces (n_b, 2) [N/m] that act at its end; rank 0's count."""
        stepper, before, old_force = self._stepper, self._external, self._force
        self._steps += 1
        if self._loads.followers:
            self._external = self._loads.at(self.time, self._predictor())
        elif self.time - self.time_step < self._loads.constant_from:
            self._external = self._loads.at(self.time, stepper.displacement)
        stepper.force[:] = self._external
        self._force = agreed_force(boundary_force, self.polyline.points.shape, self.comm)
        self._exchange.add(self._force, stepper.force)
        try:
            stepper.step()
        except StepError as failed:
            require_finite(float(self._force.sum()), self._force, self.time, self.time_step)
            raise StepError(f"t = {self.time:g} s: {failed}", failed.largest_step) from None
        if not self._ledger:
            self._read_boundary()
            require_finite(float(self.boundary_displacement[0, 0]), self._force, self.time, self.time_step)
            return
        mean = before if self._external is before else (before + self._external) / 2
        shares = (stepper.loss_of_step(), float(mean.dot(stepper.increment)))
        if not self.scheme.conserves:
            shares += (stepper.scheme_loss_of_step(),)
        (loss, work, *by_scheme), moved = self._read_boundary(stepper.increment, shares)
        self._loss += loss
        self._scheme_loss += sum(by_scheme)
        self._external_work += work
        self._boundary_work += 0.5 * float(np.vdot(old_force + self._force, moved))
        require_finite(self._external_work + self._boundary_work, self._force, self.time, self.time_step)

    def predict(self, interval: float, order: int = 2) -> NDArray[np.float64]:
        """Boundary displacement (n_b, 2) [m] after `interval` [s]: ``u + dt v (+ dt^2 a/2)``."""
        ahead = self.boundary_displacement + interval * self.boundary_velocity
        if order == 2:
            ahead += (0.5 * interval**2) * self.boundary_acceleration
        return ahead

    def energies(self) -> StructureEnergies:
        """Energies [J/m] at the present time and sums since the start."""
        if not self._ledger:
            raise StructureError("ledger = False keeps no sums of work: build with ledger=True")
        return StructureEnergies(
            kinetic=self._body.total(self._stepper.kinetic()),
            strain=self._body.total(self._stepper.strain()),
            rayleigh_loss=self._loss,
            external_work=self._external_work,
            boundary_work=self._boundary_work,
            scheme_loss=self._scheme_loss,
        )

    @property
    def boundary_work(self) -> float:
        """Work [J/m] of the nodal forces since the start, as in `energies`."""
        return self._boundary_work

    def centroid(self) -> NDArray[np.float64]:
        """Present centroid (2,) [m]."""
        return self._body.centroid_now(self._stepper.displacement)

    def mean_rotation(self) -> float:
        """Rotation [rad] of the best-fitting rigid motion, counter-clockwise positive."""
        return self._theory.rotation()

    def momentum(self) -> NDArray[np.float64]:
        """Linear momentum (2,) [kg/s]."""
        return self._body.momentum(self._stepper.velocity)

    def external_force(self) -> NDArray[np.float64]:
        """Resultant (2,) [N/m] of the external loads at the present time."""
        return self._loads.resultant(self.time, self._stepper.displacement)

    def peaks(self) -> StructurePeaks:
        """Largest von Mises stress and principal strain over the Gauss points of all cells."""
        return self._theory.peaks()

    def overturned_cell(self) -> int | None:
        """See `Structure`."""
        places = self.mesh.points + self._body.nodes.gather(self._stepper.displacement)
        return first_overturned(places, self.mesh.cells, self.mesh.cell)

    def fields(self) -> StructureFields:
        """Nodal fields in original order, on every rank."""
        gather, stepper = self._body.nodes.gather, self._stepper
        motion = {
            "displacement": gather(stepper.displacement),
            "velocity": gather(stepper.velocity),
        }
        return StructureFields(
            points=self.mesh.points,
            cells=self.mesh.cells,
            cell_kind=cell_kind(self.mesh.cell, self.mesh.order),
            point_data=motion | self._theory.nodal_stress(),
        )

    def frequencies(self, count: int) -> NDArray[np.float64]:
        """The lowest `count` elastic frequencies [Hz] of small motion about the reference shape, ascending."""
        return modes.elastic_modes(self._body, self._theory.stiffness, self.material, count)[0]

    def release_from_mode(self, number: int, amplitude: float) -> None:
        """Start anew from elastic mode `number` (1 is the lowest) at rest, loads kept.

        The largest nodal displacement is `amplitude` [m]; its sign is that of the largest
        component, made positive.
        """
        checks.positive("amplitude", abs(amplitude), "m, sign free")
        shape = modes.elastic_modes(self._body, self._theory.stiffness, self.material, number)[1][-1]
        self.set_initial(displacement=amplitude * shape)

    def static_displacement(self) -> NDArray[np.float64]:
        """Displacement (n, 2) [m] at rest under the full loads, free of rigid motion.

        The loads must be in balance, as nothing else holds the body.
        """
        return self._theory.static_displacement(self._loads)

    def state(self) -> dict[str, NDArray[np.float64]]:
        """All that is needed to go on with the same bits, in original node order, on every rank."""
        arrays = {name: getattr(self._stepper, name) for name in STATE_FIELDS}
        sums = [self._loss, self._external_work, self._boundary_work]
        if not self.scheme.conserves:
            sums.append(self._scheme_loss)
        return {
            **{name: self._body.nodes.gather(array) for name, array in arrays.items()},
            **self._theory.memory(),
            **({"external_force": self._body.nodes.gather(self._external)} if self._loads.followers else {}),
            "boundary_force": self._force.copy(),
            "sums": np.array(sums),
            "steps": np.array(self._steps),
        }

    def restore(self, state: dict[str, NDArray[np.float64]]) -> None:
        """Take up a `state` of the same mesh, time step and loads; rank 0's counts."""
        state = self.comm.bcast(state, root=0)
        checks.state_of_this_kind(state, self.state())
        for name in STATE_FIELDS:
            given = self._nodal(name, state[name])
            getattr(self._stepper, name)[:] = self._body.nodes.share(given)
        self._force = agreed_force(state["boundary_force"], self.polyline.points.shape, self.comm)
        self._loss, self._external_work, self._boundary_work, *by_scheme = map(float, state["sums"])
        self._scheme_loss = sum(by_scheme)
        self._steps = int(state["steps"])
        if self._loads.followers:
            self._external = self._body.nodes.share(self._nodal("external_force", state["external_force"]))
        else:
            self._external = self._loads.at(self.time, self._stepper.displacement)
        self._stepper.force[:] = self._external
        self._exchange.add(self._force, self._stepper.force)
        self._theory.recall(state)
        self._read_boundary()

    def snapshot(self) -> Snapshot:
        """See `Rewinding`."""
        return super().snapshot() | {"stepper": self._stepper.snapshot()}

    def rewind(self, snapshot: Snapshot) -> None:
        """See `Rewinding`."""
        super().rewind(snapshot)
        self._stepper.rewind(snapshot["stepper"])
        self._carry()

    def _carry(self) -> None:
        """Tell the stepper how the body has moved as a whole: the turn is that of the line to the farthest node."""
        node, x, y = self._line
        u = self.boundary_displacement
        part = u.item  # numbers one by one: of so few an array is dearer
        self._stepper.carry(u[0], x * (part(node, 1) - part(0, 1)) - y * (part(node, 0) - part(0, 0)))

    def _predictor(self) -> NDArray[np.float64]:
        """Newmark's ``u + dt v + (1/2 - beta) dt^2 a`` [m], the shape that a pressure follows.

        It differs from the shape at the end of the step by ``beta dt^2 a``: to the equation of motion
        that is a change of the mass matrix, which feeds no energy (`follower_limit`).
        """
        stepper, dt = self._stepper, self.time_step
        return stepper.displacement + dt * stepper.velocity + (0.5 - self._beta) * dt**2 * stepper.acceleration

    def _read_boundary(
        self,
        increment: NDArray[np.float64] | None = None,
        shares: tuple[float, ...] = (),
    ) -> tuple[tuple[float, ...], NDArray[np.float64] | None]:
        """Refresh the boundary arrays; returns the sums over ranks and the boundary's increment."""
        stepper = self._stepper
        arrays = (stepper.displacement, stepper.velocity, stepper.acceleration)
        if increment is not None:
            arrays += (increment,)
        values, sums = self._exchange.read(arrays, shares)
        self.boundary_displacement, self.boundary_velocity, self.boundary_acceleration = values[:3]
        self._carry()
        return sums, values[3] if increment is not None else None

    def _nodal(self, name: str, values: NDArray[np.float64]) -> NDArray[np.float64]:
        values = np.asarray(values, dtype=float)
        if values.shape != self.mesh.points.shape or not np.all(np.isfinite(values)):
            raise StructureError(
                f"{name} must be finite and of the shape of the mesh's points, "
                f"{self.mesh.points.shape}; got shape {values.shape}"
            )
        return values
