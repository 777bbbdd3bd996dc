"""The conserving step of small strain in the frame that turns with the body."""

from __future__ import annotations

import cmath
import math
import sys
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from structure.discrete import DiscreteBody
from structure.material import Rayleigh
from structure.solvers.solver import factorise
from structure.theories.conserving import ConservingStepper
from structure.theories.frame import Complex, Pose, as_complex, wrapped
from structure.theories.mixing import Mixing

SWEEPS = 50
SLOW, DEPTH = 0.05, 2  # corrections that shrink more slowly are mixed with the last ones
EPSILON = sys.float_info.epsilon
NOISE = 1e5  # corrections of so many times the round-off that shrink no more are round-off of the stiffness


class Middle(NamedTuple):
    """Between two poses: angle [rad], cosine of half the turn, rho [kg m], positions (n,) [m]."""

    angle: float
    cosine: float
    hold: float
    arms: Complex


class CorotationalStepper(ConservingStepper):
    """Strain energy ``w . K w/2`` with ``w = R(t)^T x - X`` in the mean frame (`MeanFrame`).

    With t_m the mean angle of a step, D the turn within it, ``s = K (w_m + c_b (w1 - w0)/dt)`` and
    x_m the mean positions relative to the centroid,

        f_int = cos(D/2) R_m s + [2/(rho0 + rho1)] (s . R_m^T J^T x_m) R_m M J X.

    As ``w1 - w0 = cos(D/2) R_m^T d + 2 sin(D/2) R_m^T J^T x_m`` and
    ``sin(D/2) = d . R_m M J X/(rho0 + rho1)``, ``f_int . d = s . (w1 - w0)`` for a step of any length, and
    as ``x_m . R_m M X = cos(D/2) (rho0 + rho1)/2`` the moment of f_int about the centroid is zero.

    The step is solved by corrections with ``(1 + c_a dt/2) M + (dt^2/4 + c_b dt/2) K``, factorised
    once and turned into the frame: what this leaves out is of the size of half the turn of the step and
    of w over the size of the body; where that is not small the corrections are mixed (`Mixing`).
    """

    def __init__(
        self,
        body: DiscreteBody,
        stiffness: PETSc.Mat,
        *,
        damping: Rayleigh | None,
        time_step: float,
    ) -> None:
        super().__init__(body, damping=damping, time_step=time_step)
        self._stiffness = stiffness
        dt = time_step
        effective = body.mass_matrix.copy()
        effective.scale(1.0 + self._mass_factor * dt / 2)
        same = PETSc.Mat.Structure.SAME_NONZERO_PATTERN
        effective.axpy(dt**2 / 4 + self._stiffness_factor * dt / 2, stiffness, structure=same)
        self._correct = factorise(effective, body.mass_matrix)
        self._mixing = Mixing(DEPTH, body.totals)
        self._strained_by = np.zeros(body.unknowns // 2, dtype=np.complex128)

    def pose(self) -> Pose:
        """The present pose; collective."""
        return self._frame.pose(self._relative(self.displacement))

    def strain(self) -> float:
        """See `Stepper`: ``w . K w/2``."""
        local = self.pose().local
        return float(np.vdot(local, self._stressed(local)).real) / 2

    def _internal_now(self) -> NDArray[np.float64]:
        now = self.pose()
        local = now.local
        if self._stiffness_factor:
            swept = 1j * self._frame.spin(now, self.velocity) * now.arms
            rate = cmath.exp(-1j * now.angle) * (self._frame.relative_velocity(self.velocity) - swept)
            local = local + self._stiffness_factor * rate
        return self._internal(local, Middle(now.angle, 1.0, now.hold, now.arms))

    def _solve_step(self, now: Pose, excess: NDArray[np.float64]) -> None:
        ahead = self._dt * self.velocity
        turned = cmath.exp(1j * (now.angle + self._dt * self._frame.spin(now, self.velocity) / 2))
        last = 0.0
        self._mixing.forget()
        for _ in range(SWEEPS):
            after = self._pose_after(ahead + excess)
            left = self._unbalanced(excess) - self._internal_between(now, after)
            seen = (0.5 * self._dt**2 / turned) * as_complex(left)
            correction = (turned * as_complex(self._solved(self._correct, seen.view(np.float64)))).view(np.float64)
            size, round_off = self._sizes(correction, excess)
            if not math.isfinite(size):
                break
            shrinking = min(1.0, size / last) if last else 1.0
            excess += correction if shrinking < SLOW else self._mixing.step(excess, correction)
            if size * shrinking <= round_off or (last and shrinking > 0.5 and size <= NOISE * round_off):
                if self._stiffness_factor:
                    self._strained_by = self._pose_after(ahead + excess).local - now.local
                return
            last = size
        raise self._refuse("the body turns or deforms too much within it; take a smaller step")

    def _sizes(self, correction: NDArray[np.float64], excess: NDArray[np.float64]) -> tuple[float, float]:
        """Norm [m] of a correction over all ranks, and what is round-off beside it."""
        u = self.displacement
        squares = np.array([correction @ correction, excess @ excess, u @ u])
        size, own, whole = np.sqrt(self._body.totals(squares)).tolist()
        return size, EPSILON * (own + whole / 8)

    def _loss_by_stiffness(self) -> float:
        by = self._strained_by
        return self._stiffness_factor * float(np.vdot(by, self._stressed(by)).real) / self._dt

    def _pose_after(self, increment: NDArray[np.float64]) -> Pose:
        return self._frame.pose(self._relative(self.displacement + increment))

    def _internal_between(self, before: Pose, after: Pose) -> NDArray[np.float64]:
        half = wrapped(after.angle - before.angle) / 2
        local = (before.local + after.local) / 2
        if self._stiffness_factor:
            local += (self._stiffness_factor / self._dt) * (after.local - before.local)
        middle = Middle(
            before.angle + half,
            math.cos(half),
            (before.hold + after.hold) / 2,
            (before.arms + after.arms) / 2,
        )
        return self._internal(local, middle)

    def _internal(self, local: Complex, middle: Middle) -> NDArray[np.float64]:
        """f_int [N/m] of the class for the strain of `local`, (owned unknowns,)."""
        stressed = self._stressed(local)
        turned = cmath.exp(1j * middle.angle)
        moment = float(np.vdot(stressed, middle.arms / turned).imag)
        moment = self._body.total(moment)
        force = middle.cosine * stressed + (moment / middle.hold) * self._frame.turning
        return (turned * force).view(np.float64)

    def _stressed(self, local: Complex) -> Complex:
        """``K local`` [N/m]; the array is overwritten by the next product."""
        as_complex(self._right)[:] = local
        self._stiffness.mult(self._right_vector, self._left_vector)
        return as_complex(self._left)
