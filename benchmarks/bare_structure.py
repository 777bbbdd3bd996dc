"""The step of a structure in a few lines of dolfinx and petsc4py, as somebody competent writes it for one problem.

Same forms, same scheme (Newmark's (1/4, 1/2)), the very same solver, vectors reused; nodal forces on a boundary come
in and its motion goes out. No ledger, no gathering of the boundary from all ranks, no schedules, no checkpoints.
"""

from collections.abc import Callable

import dolfinx
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc as fem_petsc
from petsc4py import PETSc

Solve = Callable[[PETSc.Vec, PETSc.Vec], None]


class BareBeam:
    """A plane-strain body that falls, damped, one step a call."""

    def __init__(
        self, domain: dolfinx.mesh.Mesh, space: fem.FunctionSpace, *, young: float, poisson: float, density: float,
        mass_factor: float, stiffness_factor: float, acceleration: tuple[float, float], step: float,
        boundary: np.ndarray, solve: Solve,
    ) -> None:  # fmt: skip
        trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
        lam, mu = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))

        def strain(u: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
            return ufl.sym(ufl.grad(u))

        stress = lam * ufl.div(trial) * ufl.Identity(2) + 2 * mu * strain(trial)
        mass = fem_petsc.assemble_matrix(fem.form(density * ufl.inner(trial, test) * ufl.dx))
        stiff = fem_petsc.assemble_matrix(fem.form(ufl.inner(stress, strain(test)) * ufl.dx))
        mass.assemble()
        stiff.assemble()
        same = PETSc.Mat.Structure.SAME_NONZERO_PATTERN
        damp = stiff.copy()
        damp.scale(stiffness_factor)
        damp.axpy(mass_factor, mass, structure=same)
        self.u, self.v, self.a, self.ahead, self.rhs, self.force = (mass.createVecRight() for _ in range(6))
        self.a.array[:] = np.tile(acceleration, self.a.getLocalSize() // 2)
        mass.mult(self.a, self.force)
        self.stiff, self.damp, self.step, self.solve, self.boundary = stiff, damp, step, solve, boundary

    def advance(self, force: np.ndarray) -> None:
        """One step with forces on the unknowns of this rank's boundary."""
        u, v, a, dt = self.u, self.v, self.a, self.step
        u.axpy(dt, v)
        u.axpy(0.25 * dt**2, a)
        v.axpy(0.5 * dt, a)
        self.stiff.mult(u, self.rhs)
        self.damp.multAdd(v, self.rhs, self.rhs)
        self.rhs.aypx(-1.0, self.force)
        self.rhs.array[self.boundary] += force
        self.solve(self.rhs, a)
        u.axpy(0.25 * dt**2, a)
        v.axpy(0.5 * dt, a)
        self.moved = [vector.array_r[self.boundary] for vector in (u, v, a)]
