"""Newmark's scheme for ``M a + C v + K u = f``, solved for the acceleration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc

from structure.checks import positive
from structure.errors import StructureError
from structure.solver import factorise


@dataclass(frozen=True, kw_only=True)
class Newmark:
    """Newmark's parameters (G's alpha is `beta`, G's delta is `gamma`).

    ``u1 = u + dt v + dt^2 ((1/2 - beta) a + beta a1)``, ``v1 = v + dt ((1 - gamma) a + gamma a1)``.
    Stable for every step if ``gamma >= 1/2`` and ``beta >= (1/2 + gamma)^2/4`` (G 2.141
    corrected). (1/4, 1/2), average acceleration, is; (1/6, 1/2), linear acceleration, is stable
    for omega dt < 3.46 only and needs ``allow_conditional=True``. beta > 0: the step is implicit.
    """

    beta: float = 0.25
    gamma: float = 0.5
    allow_conditional: bool = False

    def __post_init__(self) -> None:
        positive("beta", self.beta, "Newmark")
        if not np.isfinite(self.gamma) or self.gamma < 0.5:
            raise StructureError(f"gamma = {self.gamma!r} feeds energy at every step: use gamma of at least 0.5")
        least = (0.5 + self.gamma) ** 2 / 4
        if self.beta < least * (1 - 1e-12) and not self.allow_conditional:
            raise StructureError(
                f"beta = {self.beta!r} with gamma = {self.gamma!r} is stable for small steps only: "
                f"use beta of at least {least:g} or allow_conditional=True"
            )


class NewmarkStepper:
    """State and step of the semi-discrete system on this rank's share of the unknowns.

    The arrays `displacement` [m], `velocity` [m/s], `acceleration` [m/s^2], `force` [N/m] and
    `increment` [m] (of the last step) have shape (owned unknowns,) and are the memory of PETSc
    vectors: write into them, never replace them. ``M + gamma dt C + beta dt^2 K`` is factorised
    once. `carried` (2,) [m] is a translation near that of the body: K times a translation is zero,
    so it is taken off before the product, whose round-off would otherwise grow with the path.
    """

    def __init__(
        self,
        *,
        mass: PETSc.Mat,
        stiffness: PETSc.Mat,
        damping: PETSc.Mat | None,
        scheme: Newmark,
        time_step: float,
    ) -> None:
        self._mass, self._stiffness, self._damping = mass, stiffness, damping
        dt = time_step
        self._dt, self._beta, self._gamma = dt, scheme.beta, scheme.gamma
        names = ("displacement", "velocity", "acceleration", "force", "increment", "product")
        arrays = {name: np.zeros(mass.getLocalSize()[0]) for name in names}
        vectors = {name: PETSc.Vec().createWithArray(array, comm=mass.comm) for name, array in arrays.items()}
        self.displacement, self._u = arrays["displacement"], vectors["displacement"]
        self.velocity, self._v = arrays["velocity"], vectors["velocity"]
        self.acceleration, self._a = arrays["acceleration"], vectors["acceleration"]
        self.force, self._f = arrays["force"], vectors["force"]
        self.increment, self._d = arrays["increment"], vectors["increment"]
        self._product_array, self._product = arrays["product"], vectors["product"]
        self.carried = np.zeros(2)
        relative = np.zeros_like(self.displacement)
        self._relative_array, self._relative_pairs = relative, relative.reshape(-1, 2)
        self._relative = PETSc.Vec().createWithArray(relative, comm=mass.comm)
        self._rhs = self._u.duplicate()
        effective = mass.copy()
        same = PETSc.Mat.Structure.SAME_NONZERO_PATTERN
        if damping is not None:
            effective.axpy(self._gamma * dt, damping, structure=same)
        effective.axpy(self._beta * dt**2, stiffness, structure=same)
        self._solve = factorise(effective)

    def start(self) -> None:
        """Acceleration that is in equilibrium with displacement, velocity and force."""
        self._u.copy(self._relative)
        self._residual()
        if self._rhs.norm() == 0.0:
            self._a.set(0.0)
        else:
            factorise(self._mass)(self._rhs, self._a)

    def step(self) -> None:
        """One step to the time at which `force` acts."""
        dt, u, v, a, d = self._dt, self._u, self._v, self._a, self._d
        d.axpby(dt, 0.0, v)
        d.axpy((0.5 - self._beta) * dt**2, a)
        self._relative.waxpy(1.0, d, u)
        v.axpy((1.0 - self._gamma) * dt, a)
        self._residual()
        self._solve(self._rhs, a)
        d.axpy(self._beta * dt**2, a)
        u.axpy(1.0, d)
        v.axpy(self._gamma * dt, a)

    def loss_of_step(self) -> float:
        """This rank's share of the damping loss [J/m] of the last step, ``d . C d/dt``.

        d/dt is the velocity in the middle of the step; with (1/4, 1/2) the loss closes the
        energy balance exactly.
        """
        if self._damping is None:
            return 0.0
        self._damping.mult(self._d, self._product)
        return float(self.increment.dot(self._product_array)) / self._dt

    def kinetic(self) -> float:
        """This rank's share of ``v . M v/2`` [J/m]."""
        self._mass.mult(self._v, self._product)
        return float(self.velocity.dot(self._product_array)) / 2

    def strain(self) -> float:
        """This rank's share of ``u . K u/2`` [J/m]."""
        self._u.copy(self._relative)
        self._relative_pairs -= self.carried
        self._stiffness.mult(self._relative, self._product)
        return float(self._relative_array.dot(self._product_array)) / 2

    def _residual(self) -> None:
        """``rhs = f - K u - C v`` with u in `_relative`, of which `carried` is taken off."""
        rhs = self._rhs
        self._relative_pairs -= self.carried
        self._stiffness.mult(self._relative, rhs)
        if self._damping is not None:
            self._damping.multAdd(self._v, rhs, rhs)
        rhs.aypx(-1.0, self._f)
