"""The time step of the theories that are not linear: it keeps energy and momentum of any motion."""

from __future__ import annotations

import cmath
from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from structure.discrete import DiscreteBody
from structure.errors import StepError
from structure.material import Rayleigh
from structure.solvers.solver import Solve, factorise
from structure.theories.frame import MeanFrame, Pose, unwrapped

LARGEST_TURN = 0.35  # [rad] of the body within a step: the turn then lags behind by its square/12, 1 %


class ConservingStepper(ABC):
    """Average acceleration with an internal force that is a discrete gradient of the strain energy.

    ``d = dt (v0 + v1)/2``, ``M (v1 - v0)/dt + c_a M d/dt + f_int = (f0 + f1)/2``, where f_int depends on both
    ends of the step such that ``f_int . d`` is the change of strain energy plus the loss of the step,
    and f_int has neither resultant nor moment about the mean positions. Hence energy, momentum and
    angular momentum are kept to the accuracy of the solution, for a step of any length (Simo and
    Tarnow 1992). A rigid spin omega turns by ``2 atan(omega dt/2)`` a step, less than it should by
    ``(omega dt)^2/12`` of it: beyond `LARGEST_TURN` the step is refused. For small motion this is
    Newmark's (1/4, 1/2). The acceleration, which only `predict` uses, is that of equilibrium at the end
    of the step, as it is there: the recurrence ``a1 = 2 (v1 - v0)/dt - a0``, the same for small motion,
    keeps every error with alternating sign.

    The unknown is ``e = d - dt v0``, so that ``v1 = v0 + 2 e/dt``. The arrays are those of `Stepper`;
    `turn` is the rotation [rad] of the best-fitting rigid motion, whole turns counted.
    """

    def __init__(self, body: DiscreteBody, *, damping: Rayleigh | None, time_step: float) -> None:
        self._body, self._mass, self._dt = body, body.mass_matrix, time_step
        self._mass_factor = 0.0 if damping is None else damping.mass_factor
        self._stiffness_factor = 0.0 if damping is None else damping.stiffness_factor
        unknowns = body.unknowns
        self.displacement, self.velocity, self.acceleration = (np.zeros(unknowns) for _ in range(3))
        self.force, self.increment = np.zeros(unknowns), np.zeros(unknowns)
        self._carried = np.zeros(2)
        self._force_before, self._load = np.zeros(unknowns), np.zeros(unknowns)
        self.turn, self._frame = 0.0, MeanFrame(body)
        self._divide_by_mass = factorise(body.mass_matrix, body.mass_matrix)
        self._left, self._left_vector = self._with_vector()
        self._right, self._right_vector = self._with_vector()

    @abstractmethod
    def _internal_now(self) -> NDArray[np.float64]:
        """Internal force [N/m] of the present displacement and velocity, damping by stiffness included."""

    @abstractmethod
    def _solve_step(self, now: Pose, excess: NDArray[np.float64]) -> None:
        """Improve e [m], given as a guess, until the step that begins at a pose is in balance.

        Raises
        ------
        StepError
            No balance is found.
        """

    @abstractmethod
    def _loss_by_stiffness(self) -> float:
        """This rank's share of the loss [J/m] of the last step to the stiffness part of the damping."""

    @abstractmethod
    def strain(self) -> float:
        """This rank's share of the strain energy [J/m]."""

    def require_resolved(self) -> None:  # noqa: B027  nothing to refuse
        """See `Stepper`: residuals weigh mass and stiffness apart, so that no step is refused."""

    def carry(self, translation: NDArray[np.float64], turn: float) -> None:
        """See `Stepper`; strains of a turned body are no product with K."""
        self._carried = translation

    def start(self) -> None:
        """See `Stepper`."""
        self._balance_acceleration()
        self.resume(0.0)

    def resume(self, turn: float) -> None:
        """Go on from the present arrays, force included; `turn` [rad] tells the whole turns so far."""
        self.turn = unwrapped(self._body.mean_rotation(self.displacement), turn)
        self._force_before[:] = self.force

    def step(self) -> None:
        """See `Stepper`."""
        dt, v = self._dt, self.velocity
        np.add(self._force_before, self.force, out=self._load)
        self._load *= 0.5
        now = self._frame.pose(self._relative(self.displacement))
        excess = self._rigid_guess(now)
        self._solve_step(now, excess)
        np.multiply(v, dt, out=self.increment)
        self.increment += excess
        self.displacement += self.increment
        v += (2.0 / dt) * excess
        self._balance_acceleration()
        before = self.turn
        self.resume(before)
        turned = abs(self.turn - before)
        if turned > LARGEST_TURN:
            share = LARGEST_TURN / turned
            raise StepError(
                f"the body turns by {turned:.3g} rad within a step of {dt:g} s, above {LARGEST_TURN:g}, where its turn "
                f"lags behind by {100 * turned**2 / 12:.2g} %: take a step of at most {share * dt:.2g} s",
                share,
            )

    def loss_of_step(self) -> float:
        """See `Stepper`."""
        loss = 0.0
        if self._mass_factor:
            loss += self._mass_factor * float(self.increment @ self._weighed(self.increment)) / self._dt
        if self._stiffness_factor:
            loss += self._loss_by_stiffness()
        return loss

    def kinetic(self) -> float:
        """See `Stepper`: ``v . M v/2``."""
        return float(self.velocity @ self._weighed(self.velocity)) / 2

    def snapshot(self) -> tuple[Any, ...]:
        """See `Stepper`."""
        arrays = (self.displacement, self.velocity, self.acceleration, self.force, self._force_before)
        return *(array.copy() for array in arrays), self.turn

    def rewind(self, snapshot: tuple[Any, ...]) -> None:
        """See `Stepper`."""
        arrays = (self.displacement, self.velocity, self.acceleration, self.force, self._force_before)
        *kept, self.turn = snapshot
        for array, values in zip(arrays, kept, strict=True):
            array[:] = values

    def _balance_acceleration(self) -> None:
        """``M a = f - c_a M v - f_int`` at the present time."""
        right = self.force - self._internal_now()
        if self._mass_factor:
            right -= self._mass_factor * self._weighed(self.velocity)
        self.acceleration[:] = self._solved(self._divide_by_mass, right)

    def _rigid_guess(self, now: Pose) -> NDArray[np.float64]:
        """e of the present shape moved on as a rigid body.

        Velocity and acceleration of modes that are fast for the step would strain it beyond measure.
        """
        frame, dt, v = self._frame, self._dt, self.velocity
        swept = cmath.exp(1j * frame.spin(now, v) * dt) - 1.0
        return (swept * now.arms - dt * frame.relative_velocity(v)).view(np.float64)

    def _unbalanced(self, excess: NDArray[np.float64]) -> NDArray[np.float64]:
        """Force [N/m] that is left over at e, internal force not yet counted."""
        dt = self._dt
        rate = (2.0 / dt**2) * excess
        if self._mass_factor:
            rate += self._mass_factor * (excess / dt + self.velocity)
        return self._load - self._weighed(rate)

    def _weighed(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """``M values``; the array is overwritten by the next product."""
        self._right[:] = values
        self._mass.mult(self._right_vector, self._left_vector)
        return self._left

    def _solved(self, solve: Solve, right: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solution for a right-hand side, from the first guess zero; overwritten by the next product."""
        self._right[:] = right
        self._left[:] = 0.0
        solve(self._right_vector, self._left_vector)
        return self._left

    def _with_vector(self) -> tuple[NDArray[np.float64], PETSc.Vec]:
        """An array of this rank's unknowns and the vector of the same memory."""
        array = np.zeros(self._mass.getLocalSize()[0])
        return array, PETSc.Vec().createWithArray(array, comm=self._mass.comm)

    def _relative(self, displacement: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacement [m] less the translation of `carry`."""
        return (displacement.reshape(-1, 2) - self._carried).ravel()

    def _refuse(self, why: str) -> StepError:
        return StepError(f"no balance is found at the end of a step of {self._dt:g} s: {why}")
