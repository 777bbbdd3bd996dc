"""Rules of the shaken walls and of the rows that move with them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from coupled.scene.refusal import missing, nearest, refusal
from coupled.scene.shaking import Shaking

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

FEWEST_STEPS = 20  # in a period: a step then turns the phase by less than a third of a radian


def check_shaking(scene: Scene) -> None:
    """Check that the motion is said once, and that there are walls to move."""
    shaking = scene.shaking
    _check_rows(scene)
    if shaking is None:
        return
    if scene.grains is None:
        raise refusal("shaking", {}, "moves walls, which meet free grains alone; add [grains] or remove it")
    names = () if scene.box is None else scene.box.walls
    if not names and not scene.shaken_rows:
        raise missing("box.walls", "there is no wall or row for [shaking] to move; add [box] with walls, or [[rows]]")
    for index, wall in enumerate(shaking.walls or ()):
        if wall not in names:
            raise refusal(f"shaking.walls.{index}", wall, f"is no wall of the box; {nearest(wall, names)}")
    if len(set(shaking.walls or ())) < len(shaking.walls or ()):
        raise refusal("shaking.walls", list(shaking.walls), "names a wall twice; name each once")
    _check_one(shaking, "amplitude", "gamma", "A in m, or Gamma = A omega^2/g")
    _check_one(shaking, "period", "period_steps", "the period in s, or in steps of the grains")
    if shaking.gamma is not None and not any(scene.gravity):
        raise refusal("shaking.gamma", shaking.gamma, "is measured by gravity, which is zero; give shaking.amplitude")
    if shaking.stop is not None and not shaking.stop > shaking.start:
        raise refusal("shaking.stop", shaking.stop, f"must be later than shaking.start = {shaking.start:g} s")
    _check_period(scene, shaking)


def _check_rows(scene: Scene) -> None:
    """Check that no row moves in two ways, or in one that nothing says."""
    for index, row in enumerate(scene.rows):
        if row.shaken and scene.shaking is None:
            raise refusal(f"rows.{index}.shaken", True, "asks for [shaking], which says how; add it or remove the key")
        if index in scene.shaken_rows and any(getattr(row, "velocity", ())):
            raise refusal(
                f"rows.{index}.velocity",
                list(row.velocity),
                "is given to a row that moves with [shaking]; remove it, or give the row shaken = false",
            )


def _check_one(shaking: Shaking, first: str, second: str, meaning: str) -> None:
    given = [name for name in (first, second) if getattr(shaking, name) is not None]
    if len(given) == 2:
        raise refusal(
            f"shaking.{second}", getattr(shaking, second), f"is given together with shaking.{first}; keep one"
        )
    if not given:
        raise missing(f"shaking.{first}", f"say how the walls move: {meaning}")


def _check_period(scene: Scene, shaking: Shaking) -> None:
    steps = math.inf
    if shaking.period_steps is not None:
        steps = shaking.period_steps
    elif scene.time.least_step > 0.0:
        steps = shaking.period / scene.time.least_step
    if steps < FEWEST_STEPS:
        key = "period" if shaking.period_steps is None else "period_steps"
        raise refusal(
            f"shaking.{key}",
            getattr(shaking, key),
            f"has {steps:.3g} steps of the grains; give at least {FEWEST_STEPS}, or a smaller time.step",
        )
