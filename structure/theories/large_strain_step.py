"""The conserving step of a St Venant-Kirchhoff solid, solved by Newton's method."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc as fem_petsc
from numpy.typing import NDArray
from petsc4py import PETSc

from structure import compat
from structure.discrete import DiscreteBody
from structure.material import PlaneStrain, Rayleigh
from structure.nodes import fill
from structure.solvers.solver import PREFIX, configure, set_up_told
from structure.theories.conserving import ConservingStepper
from structure.theories.frame import Pose

STEPS = 30
NEAR = 1e-8  # a Newton correction so small beside the solution leaves an error of its square
NOISE = 1e-14  # of the displacement: round-off


class LargeStrainStepper(ConservingStepper):
    """``S = lam tr(E) 1 + 2 mu E`` of the Green-Lagrange strain E, kept in balance at mid-step.

    ``f_int = int (F_m S_m) : grad(w)``, ``F_m = (F0 + F1)/2``, ``S_m = C : ((E0 + E1)/2 + c_b (E1 - E0)/dt)``.
    As ``E1 - E0 = sym(F_m^T grad d)``, ``f_int . d`` is the change of ``int E : C : E/2`` plus the loss
    ``c_b (E1 - E0) : C : (E1 - E0)/dt``; as S_m is symmetric, f_int has no moment about the mean
    positions. The stiffness part of the damping is a Kelvin-Voigt solid's, seen in the material.
    The mesh's own quadrature (that of the linear stiffness) is used for all.

    Newton's method by PETSc's SNES with full steps and the exact tangent; options with the prefix
    ``leito_`` replace its solvers. It ends with the first correction whose square is round-off, which
    counts on a tangent that is not older than the iterate.

    Source: Simo and Tarnow (1992).
    """

    def __init__(
        self, body: DiscreteBody, material: PlaneStrain, *, damping: Rayleigh | None, time_step: float
    ) -> None:
        super().__init__(body, damping=damping, time_step=time_step)
        self._start, self._moved = fem.Function(body.space), fem.Function(body.space)
        self._ahead, self._lost = np.zeros(body.unknowns), 0.0
        self._share, self._rate = (fem.Constant(body.space.mesh, PETSc.ScalarType(0.0)) for _ in range(2))
        self._size = math.sqrt(body.inertia / body.mass * len(body.mesh.points))
        self._make_forms(material)
        self._make_solver()

    def _make_forms(self, material: PlaneStrain) -> None:
        body, u, d = self._body, self._start, self._moved
        lam, mu = (fem.Constant(body.space.mesh, PETSc.ScalarType(value)) for value in material.lame)
        dx = ufl.dx(metadata={"quadrature_degree": 2 * body.mesh.order})
        test, trial = ufl.TestFunction(body.space), ufl.TrialFunction(body.space)

        def stress(strain: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
            return lam * ufl.tr(strain) * ufl.Identity(2) + 2 * mu * strain

        start = ufl.sym(ufl.grad(u)) + ufl.grad(u).T * ufl.grad(u) / 2
        middle = ufl.Identity(2) + ufl.grad(u) + self._share * ufl.grad(d)
        made = ufl.sym(middle.T * ufl.grad(d))
        internal = ufl.inner(middle * stress(start + (self._share + self._rate) * made), ufl.grad(test)) * dx
        self._internal = compat.compiled(internal)
        self._tangent = compat.compiled(ufl.derivative(internal, d, trial))
        self._energy = compat.compiled(ufl.inner(stress(start), start) / 2 * dx)
        self._loss = compat.compiled(self._rate * ufl.inner(stress(made), made) * dx)

    def _make_solver(self) -> None:
        self._assembled = compat.empty_vector(self._internal)
        self._jacobian = fem_petsc.create_matrix(self._tangent)
        solver = PETSc.SNES().create(self._body.comm)
        self._excess, self._excess_vector = self._with_vector()
        solver.setFunction(self._residual, self._mass.createVecLeft())
        solver.setJacobian(self._fill_tangent, self._jacobian)
        solver.setTolerances(max_it=STEPS)
        solver.setConvergenceTest(self._converged)
        configure(solver.getKSP(), self._mass)
        solver.setOptionsPrefix(PREFIX)
        with _full_steps(), set_up_told(self._mass.getSize()[0], PREFIX):
            solver.setFromOptions()
        self._solver = solver

    def strain(self) -> float:
        """See `Stepper`: ``int E : C : E/2``."""
        fill(self._start, self._relative(self.displacement))
        return float(fem.assemble_scalar(self._energy))

    def _internal_now(self) -> NDArray[np.float64]:
        fill(self._start, self._relative(self.displacement))
        fill(self._moved, self.velocity)
        self._share.value, self._rate.value = 0.0, self._stiffness_factor
        return self._internal_force().copy()

    def _solve_step(self, now: Pose, excess: NDArray[np.float64]) -> None:
        fill(self._start, self._relative(self.displacement))
        self._share.value, self._rate.value = 0.5, self._stiffness_factor / self._dt
        np.multiply(self.velocity, self._dt, out=self._ahead)
        self._excess[:] = excess
        self._solver.solve(None, self._excess_vector)
        if self._solver.getConvergedReason() <= 0:
            raise self._refuse(
                "Newton's method fails, the body turns or deforms too much within it; take a smaller step"
            )
        excess[:] = self._excess
        if self._stiffness_factor:
            fill(self._moved, self._ahead + excess)
            self._lost = float(fem.assemble_scalar(self._loss))

    def _loss_by_stiffness(self) -> float:
        return self._lost

    def _residual(self, solver: PETSc.SNES, excess: PETSc.Vec, into: PETSc.Vec) -> None:
        """Internal less all other forces [N/m] at e."""
        fill(self._moved, self._ahead + excess.array_r)
        into.array[:] = self._internal_force() - self._unbalanced(excess.array_r)

    def _internal_force(self) -> NDArray[np.float64]:
        vector = self._assembled
        with vector.localForm() as local:
            local.set(0.0)
        fem_petsc.assemble_vector(vector, self._internal)
        vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        return vector.array_r

    def _fill_tangent(self, solver: PETSc.SNES, excess: PETSc.Vec, into: PETSc.Mat, same: PETSc.Mat) -> None:
        """Derivative of the residual; the functions hold e already, from the residual there."""
        into.zeroEntries()
        fem_petsc.assemble_matrix(into, self._tangent)
        into.assemble()
        inertia = 2.0 / self._dt**2 + self._mass_factor / self._dt
        into.axpy(inertia, self._mass, structure=PETSc.Mat.Structure.SAME_NONZERO_PATTERN)

    def _converged(
        self, solver: PETSc.SNES, iteration: int, norms: tuple[float, float, float]
    ) -> PETSc.SNES.ConvergedReason:
        solution, correction, residual = norms
        reasons = PETSc.SNES.ConvergedReason
        if not math.isfinite(residual):
            return reasons.DIVERGED_FNORM_NAN
        if residual == 0.0:
            return reasons.CONVERGED_FNORM_ABS
        if iteration > 0 and correction <= max(NEAR * solution, NOISE * self._size):
            return reasons.CONVERGED_SNORM_RELATIVE
        return reasons.DIVERGED_MAX_IT if iteration >= STEPS else reasons.CONVERGED_ITERATING


@contextmanager
def _full_steps() -> Iterator[None]:
    """Newton steps are not shortened, unless the options ask for it: petsc4py can say so by an option only."""
    options, name = PETSc.Options(PREFIX), "snes_linesearch_type"
    if options.hasName(name):
        yield
        return
    options[name] = "basic"
    try:
        yield
    finally:
        options.delValue(name)
