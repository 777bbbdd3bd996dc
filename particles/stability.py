"""The true limit of the time step: the fastest mode of the contacts as they stand."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import LinearOperator, eigsh

from particles.network import StiffnessNetwork, stiffness_network
from particles.state import Floats
from particles.system import ParticleSystem
from particles.timestep import DASHPOT_SHARE

RESIDUAL = 1e-3  # over an eigenvalue, which is itself far better known
GROWTH = 1e-4  # of mu, below which its iteration, of order 2, ends
DENSE = 60  # unknowns up to which the whole spectrum is as cheap


@dataclass(frozen=True, kw_only=True)
class StepLimit:
    """Largest stable time step on one contact network.

    Attributes
    ----------
    step : float
        Limit with springs, dashpots and global damping [s]; infinite without any.
    undamped : float
        ``2/omega_max`` [s], of the springs alone: dashpots lower it.
    contacts : int
        Touching pairs and walls.
    grain : int or None
        Place of the grain that moves most in the fastest mode.
    """

    step: float
    undamped: float
    contacts: int
    grain: int | None

    @property
    def omega_max(self) -> float:
        """Largest angular frequency of the undamped network [rad/s]."""
        return 2.0 / self.undamped


def sharp_limit(system: ParticleSystem) -> StepLimit:
    """Limit of the time step on the present contacts, all of them sticking (`StiffnessNetwork`).

    The leapfrog takes its forces at positions n and velocities n - 1/2:
    ``u(n+1) - 2 u(n) + u(n-1) = -dt^2 A u(n) - dt B (u(n) - u(n-1))``, with ``A = M^-1/2 K M^-1/2``
    and B likewise of C, u scaled by the root of M. A solution ``z^n w``, |w| = 1, has
    ``z^2 - (2 - a dt^2 - b dt) z + 1 - b dt = 0`` with ``a = w* A w``, ``b = w* B w``, both >= 0, so
    that ``|z| <= 1`` if ``a dt^2 + 2 b dt <= 4``. If ``A dt^2 + 2 B dt`` has an eigenvalue above 4, the
    symmetric matrix of the left side is indefinite at z = -1 and positive far below, so that it is
    singular at some real z < -1. The limit is therefore where its largest eigenvalue is 4: with
    ``mu = 2/dt`` the largest root of ``mu^2 = lambda_max(A + mu B)``, omega_max without dashpots and
    more with them. Velocity Verlet shows dashpots ``(3 v(n-1/2) - v(n-3/2))/2`` and has by the same
    steps, from a cubic, ``a dt^2 + 4 b dt <= 4``: they count twice.

    Lanczos (ARPACK) finds lambda_max, and a Newton-like iteration that rises to the limit mu from
    below, ``mu = (b + sqrt(b^2 + 4 a))/2`` at the last eigenvector. In a disordered bed the limit is
    exact to round-off; in a crystal, whose fastest modes lie close together, it comes out up to
    1e-4 too long (tested). Half a second for 15 000 grains at rest, some seconds for a crystal of
    as many. Source: model 1.4.
    """
    network, share = stiffness_network(system), DASHPOT_SHARE[system.scheme]
    if not len(network.stiffness):
        drag = share * float(network.drag.max(initial=0.0))
        return StepLimit(step=2.0 / drag if drag > 0.0 else math.inf, undamped=math.inf, contacts=0, grain=None)
    undamped, damped, mode = fastest(network, share)
    moves = np.sum((mode**2).reshape(-1, system.grains.n_free), axis=0)
    return StepLimit(step=2.0 / damped, undamped=2.0 / undamped, contacts=network.contacts, grain=int(np.argmax(moves)))


def fastest(network: StiffnessNetwork, share: float = 1.0) -> tuple[float, float, Floats]:
    """omega_max [rad/s], the mu of `sharp_limit` [1/s], and its mode (n_unknowns,) times the root of the inertia.

    `share` is the weight of dashpots and global damping, by the scheme (`DASHPOT_SHARE`).
    """
    stretch, damping, drag = network.by_inertia(), share * network.damping, share * network.drag
    start = np.random.default_rng(1).standard_normal(stretch.shape[1])
    omega2, mode = _largest(stretch, network.stiffness, np.zeros_like(drag), start)
    omega = math.sqrt(max(omega2, 0.0))
    if not (damping.any() or drag.any()):
        return omega, omega, mode

    def rate() -> float:
        """mu of the present mode."""
        stretched, size = (stretch @ mode) ** 2, float(mode @ mode)
        a = float(network.stiffness @ stretched) / size
        b = float(damping @ stretched + drag @ mode**2) / size
        return 0.5 * (b + math.sqrt(b * b + 4.0 * a))

    mu = rate()
    while True:
        _, mode = _largest(stretch, network.stiffness + mu * damping, mu * drag, mode)
        before, mu = mu, max(mu, rate())
        if mu - before <= GROWTH * mu:
            return omega, mu, mode


def _largest(stretch: csr_matrix, weight: Floats, diagonal: Floats, start: Floats) -> tuple[float, Floats]:
    """Largest eigenvalue of ``S^T weight S + diagonal`` and its vector."""
    if stretch.shape[1] <= DENSE:
        dense = stretch.toarray()
        values, vectors = np.linalg.eigh(dense.T @ (weight[:, None] * dense) + np.diag(diagonal))
        return float(values[-1]), vectors[:, -1]
    back = stretch.T.tocsr()

    def apply(vector: Floats) -> Floats:
        return back @ (weight * (stretch @ vector)) + diagonal * vector

    operator = LinearOperator((stretch.shape[1],) * 2, matvec=apply, dtype=float)
    value, vector = eigsh(operator, k=1, which="LA", v0=start, tol=RESIDUAL)
    return float(value[0]), vector[:, 0]
