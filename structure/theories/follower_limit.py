"""Which bodies and steps a pressure that follows is for."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from structure.discrete import DiscreteBody
from structure.errors import StructureError
from structure.loads.pressure import PressedBoundary
from structure.solvers.solver import factorise
from structure.theories.theory import TheoryName

SWEEPS = 40
ALLOWED = 0.9  # of the limit; the largest eigenvalue is found to about 2 %, from below


def require_followers_fit(
    body: DiscreteBody, followers: Sequence[PressedBoundary], theory: TheoryName, beta_dt2: float
) -> None:
    """Refuse what a follower pressure makes unstable.

    The force ``p S u`` is taken at Newmark's predictor ``u1 - beta dt^2 a1``, so that the step is one with
    the mass matrix ``M - beta dt^2 p S``: that must stay positive. The linear theory is in balance
    about the places that the nodes had at first, where a pressure that has turned with the body has a
    moment: a body at rest would turn of itself, as ``exp(sqrt(2 p A/I) t)`` under the pressure p in a hole A.

    Parameters
    ----------
    beta_dt2 : float
        ``beta dt^2`` [s^2].

    Raises
    ------
    StructureError
        The theory is linear, or the step too long.
    """
    if theory == "linear":
        raise StructureError(
            "follows = True needs a theory that follows the body: use theory = 'corotational' or 'large_strain', "
            "or follows = False"
        )
    largest = beta_dt2 * _largest_rate(body, followers)
    if largest > ALLOWED:
        raise StructureError(
            f"time_step is {math.sqrt(largest / ALLOWED):.3g} times what a pressure that follows bears on this mesh: "
            "use a shorter step, larger cells or follows = False"
        )


def _largest_rate(body: DiscreteBody, followers: Sequence[PressedBoundary]) -> float:
    """Largest magnitude [1/s^2] of the eigenvalues of ``M^-1 p S``, by repeated products."""
    solve = factorise(body.mass_matrix)
    now, pushed = body.mass_matrix.createVecs()
    now.array[:] = body.nodes.share(np.random.default_rng(1).normal(size=body.mesh.points.shape))
    growth = [1.0, 1.0]
    for _ in range(SWEEPS):
        pushed.set(0.0)
        for follower in followers:
            change = follower.force(follower.displacement_of(now.array)) - follower.force()
            follower.add(follower.schedule.largest * change, pushed.array)
        solve(pushed, now)
        growth.append(now.norm())
        now.scale(1.0 / growth[-1] if growth[-1] else 0.0)
    return math.sqrt(growth[-1] * growth[-2])  # of two sweeps: eigenvalues of both signs come in pairs
