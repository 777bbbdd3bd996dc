"""Settings that the exchange would not bear take a shorter step."""

from __future__ import annotations

from coupled.limits_before import coupling_limit_of
from coupled.step import with_step
from coupled.study.settings import turns
from coupled.study.settings.setting import Load
from coupled.study.settings.turns import Changes

INSIDE = 0.95  # of the coupling's limit


def borne(load: Load, changes: Changes) -> tuple[Changes, float]:
    """Add the step that the exchange bears to changes whose own step is too long for it.

    Finer cells have lighter nodes: the stiffness ratio of the coupling grows with them.

    Returns
    -------
    The changes, and the factor on the step (1: none).

    Raises
    ------
    LeitoError and the errors of the rooms
        If there is no such scene.
    """
    scene = load(changes)
    step = with_step(scene).time.step
    longest = INSIDE * coupling_limit_of(with_step(scene), step)
    if step <= longest:
        return changes, 1.0
    return changes + turns.step(scene, longest / step), longest / step
