"""What a theory of deformation is to the rest: a step in time, and the place where strain is read."""

from __future__ import annotations

from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from structure.loads.vectors import LoadVectors
from structure.results import StructurePeaks

TheoryName = Literal["linear", "corotational", "large_strain"]
Floats = NDArray[np.float64]


class Stepper(Protocol):
    """State and step of a body on this rank's share of the unknowns.

    The arrays `displacement` [m], `velocity` [m/s], `acceleration` [m/s^2], `force` [N/m] and
    `increment` [m] (of the last step) have shape (owned unknowns,): write into them, never replace
    them.
    """

    displacement: Floats
    velocity: Floats
    acceleration: Floats
    force: Floats
    increment: Floats

    def require_resolved(self) -> None:
        """Refuse a step whose round-off moves the body as a whole.

        Raises
        ------
        StructureError
        """
        ...

    def carry(self, translation: Floats, turn: float) -> None:
        """Tell the motion of the first boundary node, (2,) [m], and about how far the body has turned [rad] by the
        linear theory: free to be taken off before products whose round-off would otherwise grow with the path.
        """
        ...

    def start(self) -> None:
        """Take up displacement, velocity and force; the acceleration follows from equilibrium."""
        ...

    def step(self) -> None:
        """One step to the time at which `force` acts."""
        ...

    def loss_of_step(self) -> float:
        """This rank's share of the damping loss [J/m] of the last step."""
        ...

    def scheme_loss_of_step(self) -> float:
        """This rank's share of what the scheme took [J/m] in the last step; asked for where it does not conserve."""
        ...

    def snapshot(self) -> tuple[Any, ...]:
        """Copies of all that the next step starts from."""
        ...

    def rewind(self, snapshot: tuple[Any, ...]) -> None:
        """Go back to a `snapshot`."""
        ...

    def kinetic(self) -> float:
        """This rank's share of the kinetic energy [J/m]."""
        ...

    def strain(self) -> float:
        """This rank's share of the strain energy [J/m]."""
        ...


class Theory(Protocol):
    """How a body's strain follows from its displacement.

    Attributes
    ----------
    stepper
        Its state and its step.
    stiffness : PETSc.Mat
        Stiffness [Pa] of small motion about the reference shape.
    """

    stepper: Stepper
    stiffness: PETSc.Mat

    def rotation(self) -> float:
        """Rotation [rad] of the best-fitting rigid motion."""
        ...

    def nodal_stress(self) -> dict[str, Floats]:
        """Stress [Pa] and strain by name, (n,) in original order, in the axes of space."""
        ...

    def peaks(self) -> StructurePeaks:
        """Largest stress and strain over the Gauss points of all cells."""
        ...

    def static_displacement(self, loads: LoadVectors) -> Floats:
        """Displacement (n, 2) [m] at rest under the full loads."""
        ...

    def memory(self) -> dict[str, Floats]:
        """What the state needs beyond displacement, velocity and acceleration."""
        ...

    def recall(self, state: dict[str, Floats]) -> None:
        """Take up the `memory` in a state, after the arrays of the stepper."""
        ...
