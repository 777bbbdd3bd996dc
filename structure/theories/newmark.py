"""Newmark's scheme and its dissipative kin for ``M a + C v + K u = f``, solved for the acceleration."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from structure.schemes import Scheme
from structure.solvers.solver import factorise, stiffness_over_mass
from structure.theories.round_off import require_rigid_motion


class NewmarkStepper:
    """State and step of the semi-discrete system on this rank's share of the unknowns.

    With ``x_f = (1 - alpha_f) x1 + alpha_f x`` and ``a_m = (1 - alpha_m) a1 + alpha_m a`` a step solves
    ``M a_m + C v_f + K u_f = f_f`` for a_m, and ``M + (1 - alpha_f)/(1 - alpha_m) (gamma dt C + beta dt^2 K)`` is
    factorised once; Newmark has alpha_m = alpha_f = 0.

    The arrays `displacement` [m], `velocity` [m/s], `acceleration` [m/s^2], `force` [N/m] and
    `increment` [m] (of the last step) have shape (owned unknowns,) and are the memory of PETSc
    vectors: write into them, never replace them. `carry` tells a translation and a small turn near those of the
    body: K times a rigid motion is zero, so it is taken off before the product, whose round-off would otherwise
    grow with the path, and hold a turn as a spring does.
    `looks_back` tells whether the force at the beginning of a step enters it.
    """

    def __init__(
        self,
        *,
        mass: PETSc.Mat,
        stiffness: PETSc.Mat,
        damping: PETSc.Mat | None,
        scheme: Scheme,
        time_step: float,
        arms: NDArray[np.complex128],
    ) -> None:
        self._mass, self._stiffness, self._damping = mass, stiffness, damping
        self._dt, self._beta, self._gamma = time_step, scheme.beta, scheme.gamma
        self._alpha_m, self._alpha_f = scheme.alpha_m, scheme.alpha_f
        names = ("displacement", "velocity", "acceleration", "force", "increment", "product")
        arrays = {name: np.zeros(mass.getLocalSize()[0]) for name in names}
        vectors = {name: PETSc.Vec().createWithArray(array, comm=mass.comm) for name, array in arrays.items()}
        self.displacement, self._u = arrays["displacement"], vectors["displacement"]
        self.velocity, self._v = arrays["velocity"], vectors["velocity"]
        self.acceleration, self._a = arrays["acceleration"], vectors["acceleration"]
        self.force, self._f = arrays["force"], vectors["force"]
        self.increment, self._d = arrays["increment"], vectors["increment"]
        self._product_array, self._product = arrays["product"], vectors["product"]
        self._arms, self._swept = arms, np.zeros_like(arms)
        self._carried, self._turned = 0j, 0.0
        relative = np.zeros_like(self.displacement)
        self._relative_array, self._relative_pairs = relative, relative.view(complex)  # x + iy: one pass over both
        self._relative = PETSc.Vec().createWithArray(relative, comm=mass.comm)
        self._rhs = self._u.duplicate()
        self._mean = self._u.duplicate() if scheme.alpha_m else self._a
        self._loses, self.looks_back = not scheme.conserves, not scheme.conserves or scheme.alpha_f > 0.0
        if self.looks_back:
            self._a_before, self._f_before, self._f_change = (self._u.duplicate() for _ in range(3))
        # With the mean acceleration the velocity of a step is (v~0 + 2 v~1 + v~2)/4 of three predicted ones, whose
        # products with C are needed anyway.
        self._three_terms = damping is not None and scheme.conserves and not self._alpha_f
        if self._three_terms:
            self._damped_before, self._damped, self._ahead = (self._u.duplicate() for _ in range(3))
            self._damped_ahead = self._u.duplicate()
        self._weights()
        effective = self._effective_matrix()
        self._contrast = stiffness_over_mass(effective, mass)
        if not math.isfinite(self._contrast):
            self.require_resolved()
        self._solve = factorise(effective, mass)

    def _weights(self) -> None:
        """Weights of the accelerations in the increments of u and v, old a and mean a_m."""
        dt, beta, gamma, alpha_m = self._dt, self._beta, self._gamma, self._alpha_m
        self._u_new, self._v_new = beta * dt**2 / (1.0 - alpha_m), gamma * dt / (1.0 - alpha_m)
        self._u_old = (0.5 - beta) * dt**2 - alpha_m * self._u_new
        self._v_old = (1.0 - gamma) * dt - alpha_m * self._v_new

    def _effective_matrix(self) -> PETSc.Mat:
        effective, same = self._mass.copy(), PETSc.Mat.Structure.SAME_NONZERO_PATTERN
        late = 1.0 - self._alpha_f
        if self._damping is not None:
            effective.axpy(late * self._v_new, self._damping, structure=same)
        effective.axpy(late * self._u_new, self._stiffness, structure=same)
        return effective

    def carry(self, translation: NDArray[np.float64], turn: float) -> None:
        """See `Stepper`: of the point from which `arms` are taken."""
        self._carried, self._turned = complex(translation.item(0), translation.item(1)), turn

    def _take_off(self) -> None:
        """Rigid motion out of `_relative`."""
        np.multiply(self._arms, 1j * self._turned, out=self._swept)
        self._swept += self._carried
        self._relative_pairs -= self._swept

    def require_resolved(self) -> None:
        """See `Stepper`."""
        require_rigid_motion(self._contrast, self._dt)

    def start(self) -> None:
        """Acceleration that is in equilibrium with displacement, velocity and force."""
        self._damped_known = False
        self._u.copy(self._relative)
        self._residual(self._f)
        self._a.set(0.0)
        if self._rhs.norm() > 0.0:
            factorise(self._mass, self._mass)(self._rhs, self._a)
        self.remember_force()
        if self._three_terms:
            self._product_with_damping(-self._v_old, self._damped_before)
            self.look_ahead()

    def remember_force(self) -> None:
        """Take `force` for that at the beginning of the next step."""
        if self.looks_back:
            self._f.copy(self._f_before)

    def look_ahead(self) -> None:
        """Have C times the predicted velocity of the next step."""
        self._product_with_damping(self._v_old, self._damped)
        self._damped_known = True

    def _product_with_damping(self, interval: float, into: PETSc.Vec) -> None:
        """``C (v + interval a)``."""
        self._v.copy(self._ahead)
        self._ahead.axpy(interval, self._a)
        self._damping.mult(self._ahead, into)

    @property
    def damped_before(self) -> NDArray[np.float64] | None:
        """C times the predicted velocity of the last step [N/m], where the loss of the next one needs it."""
        return self._damped_before.array if self._three_terms else None

    def snapshot(self) -> tuple[Any, ...]:
        """See `Stepper`."""
        return *(array.copy() for array in self._kept()), self._damped_known

    def rewind(self, snapshot: tuple[Any, ...]) -> None:
        """See `Stepper`."""
        *kept, self._damped_known = snapshot
        for array, values in zip(self._kept(), kept, strict=True):
            array[:] = values

    def _kept(self) -> list[NDArray[np.float64]]:
        arrays = [self.displacement, self.velocity, self.acceleration, self.force]
        if self.looks_back:
            arrays.append(self._f_before.array)
        if self._three_terms:
            arrays += [self._damped_before.array, self._damped.array]
        return arrays

    def step(self) -> None:
        """One step; `force` acts at its end."""
        u, v, a, d, mean = self._u, self._v, self._a, self._d, self._mean
        alpha_m, alpha_f = self._alpha_m, self._alpha_f
        if self._loses:
            a.copy(self._a_before)
        d.axpby(self._dt, 0.0, v)
        d.axpy(self._u_old, a)
        self._relative.waxpy(1.0 - alpha_f, d, u)
        v.axpy((1.0 - alpha_f) * self._v_old, a)
        self._residual(self._force_between())
        if alpha_f:
            v.axpy(alpha_f * self._v_old, a)
        self._solve(self._rhs, mean)
        d.axpy(self._u_new, mean)
        u.axpy(1.0, d)
        v.axpy(self._v_new, mean)
        if alpha_m:
            a.axpby(1.0 / (1.0 - alpha_m), -alpha_m / (1.0 - alpha_m), mean)

    def _force_between(self) -> PETSc.Vec:
        """``(1 - alpha_f) f1 + alpha_f f``; the force is remembered for the next step."""
        if not self.looks_back:
            return self._f
        self._f_change.waxpy(-1.0, self._f_before, self._f)
        self._f.copy(self._f_before)
        self._product.waxpy(-self._alpha_f, self._f_change, self._f)
        return self._product

    def loss_of_step(self) -> float:
        """This rank's share of the damping loss [J/m] of the last step, ``d . C d/dt``.

        d/dt is the velocity in the middle of the step; with (1/4, 1/2) the loss closes the
        energy balance exactly.
        """
        if self._damping is None:
            return 0.0
        if not self._three_terms:
            self._damping.mult(self._d, self._product)
            return float(self.increment.dot(self._product_array)) / self._dt
        self._product_with_damping(self._v_old, self._damped_ahead)
        mean = self._damped_before
        mean.axpy(2.0, self._damped)
        mean.axpy(1.0, self._damped_ahead)
        loss = float(self.increment.dot(mean.array_r)) / 4
        self._damped_before, self._damped, self._damped_ahead = self._damped, self._damped_ahead, mean
        self._damped_known = True
        return loss

    def scheme_loss_of_step(self) -> float:
        """This rank's share of what the scheme itself took [J/m] in the last step.

        With x' = x1 - x the equations of one step, taken times u' and written for the mean of both ends,
        leave beside works by mean forces and the damping loss ``u' . C u'/dt``

            (1/2 - alpha_f) u' . (K u' + C v' - f') + (1 - alpha_m - gamma) u' . M a'
            + (beta - gamma/2) dt (dt (mean(a) + (gamma - 1/2) a') . M a' - u' . C a')

        which therefore closes the balance of kinetic and strain energy to the accuracy of the solver. Part of it is
        kept by the scheme and given back, part is lost: a single step may show a gain. It is zero without
        any product if the scheme conserves.
        """
        if not self._loses:
            return 0.0
        dt, d, change = self._dt, self._d, self._rhs
        alpha_m, alpha_f, beta, gamma = self._alpha_m, self._alpha_f, self._beta, self._gamma
        change.waxpy(-1.0, self._a_before, self._a)
        new, old, jump = self.acceleration, self._a_before.array_r, change.array_r
        self._mass.mult(change, self._product)
        inertia, lag = self._product_array, beta - 0.5 * gamma
        kept = (new + old) / 2 + (gamma - 0.5) * jump
        loss = (1.0 - alpha_m - gamma) * self.increment.dot(inertia) + lag * dt**2 * kept.dot(inertia)
        velocity_change = dt * ((1.0 - gamma) * old + gamma * new)
        self._stiffness.mult(d, self._product)
        stretch = self._product_array - self._f_change.array_r
        loss += (0.5 - alpha_f) * self.increment.dot(stretch)
        if self._damping is not None:
            self._damping.mult(d, self._product)
            loss += self._product_array.dot((0.5 - alpha_f) * velocity_change - lag * dt * jump)
        return float(loss)

    def kinetic(self) -> float:
        """This rank's share of ``v . M v/2`` [J/m]."""
        self._mass.mult(self._v, self._product)
        return float(self.velocity.dot(self._product_array)) / 2

    def strain(self) -> float:
        """This rank's share of ``u . K u/2`` [J/m]."""
        self._u.copy(self._relative)
        self._take_off()
        self._stiffness.mult(self._relative, self._product)
        return float(self._relative_array.dot(self._product_array)) / 2

    def _residual(self, force: PETSc.Vec) -> None:
        """``rhs = f - K u - C v`` with u in `_relative`, of which the rigid motion of `carry` is taken off."""
        rhs = self._rhs
        self._take_off()
        self._stiffness.mult(self._relative, rhs)
        if self._three_terms:
            if not self._damped_known:
                self._damping.mult(self._v, self._damped)
            self._damped_known = False
            rhs.axpy(1.0, self._damped)
        elif self._damping is not None:
            self._damping.multAdd(self._v, rhs, rhs)
        rhs.aypx(-1.0, force)
