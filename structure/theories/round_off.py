"""How far the stiffness of a step may stand above its mass before round-off moves the body as a whole."""

from __future__ import annotations

from structure.errors import StructureError

LARGEST_CONTRAST = 1e9  # a free body then turns wrong by 3e-5 in 500 steps; in proportion to both, below and above


def require_rigid_motion(contrast: float, time_step: float) -> None:
    """Refuse a matrix ``M + w K`` whose solutions are no longer those of M for rigid motion.

    K times a rigid motion is zero, so that M alone decides how a body moves as a whole. The solution of a step has the
    relative error of the round-off times the ratio of ``w K`` to M, in that motion too, which adds up over the steps
    (docs/decisions.md). Steps that weigh M by itself, as those of the theories that turn, do
    not have it.

    Parameters
    ----------
    contrast : float
        Largest ratio of ``w K`` to M on the diagonal (`stiffness_over_mass`).
    time_step : float
        [s].

    Raises
    ------
    StructureError
    """
    if contrast <= LARGEST_CONTRAST:
        return
    raise StructureError(
        f"stiffness and damping weigh {contrast:.2g} times as much as the mass in a step of {time_step:g} s, above "
        f"{LARGEST_CONTRAST:g}, where round-off moves the body as a whole: use theory = 'corotational' or a rigid "
        "body, a shorter step, or less stiffness or damping"
    )
