"""Which tables need which others."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coupled.scene.refusal import missing, refusal

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

ROUND_OFF = 1e-9
MOST_STEPS = 1e15  # beyond it steps are less than four round-offs of the time apart


def check_whole(scene: Scene) -> None:
    """Check that there is something to compute and that no table hangs in the air."""
    if scene.accuracy is not None:
        raise refusal(
            "accuracy",
            scene.accuracy,
            "is read at the top of a scene file, and holds for the bed as well; remove it here, or give --accuracy",
        )
    if scene.grains is None and scene.structure is None:
        raise missing("grains", "a scene needs grains or a structure; add [grains] or [structure]")
    if scene.interface is not None and scene.structure is None:
        raise missing(
            "structure",
            "an interface needs a structure; add [structure] or remove [interface]",
        )
    if scene.structure is not None and scene.interface is None:
        for key, there in (("grains", scene.grains is not None), ("rows", bool(scene.rows))):
            if there:
                raise missing(
                    "interface",
                    f"a structure meets {key} only through an interface; add [interface] or remove [{key}]",
                )
    if scene.damping is not None and scene.grains is None:
        raise refusal("damping", {}, "acts on free grains alone; add [grains] or remove it")
    bodies = scene.grains is not None or scene.interface is not None
    if bodies and scene.contact is None:
        raise missing("contact", "grains need a contact law; add [contact] with normal_stiffness")
    if scene.contact is not None and not bodies:
        raise refusal("contact", {}, "has nothing to act on; add [grains] or remove it")


def check_output(scene: Scene) -> None:
    """Check times against each other."""
    time, output = scene.time, scene.output
    if time.least_step > time.duration:
        reason = f"is longer than time.duration = {time.duration:g} s; choose a smaller step"
        raise refusal("time.step", time.step, reason)
    if time.least_step * MOST_STEPS < time.duration and time.least_step > 0.0:
        reason = (
            f"is more than {MOST_STEPS:g} steps of {time.step:g} s, whose times are no longer told apart; shorten it"
        )
        raise refusal("time.duration", time.duration, reason)
    if time.stop_at_rest is not None and (scene.grains is None or not any(scene.gravity)):
        reason = "measures free grains under gravity; remove it, or add [grains] and gravity"
        raise refusal("time.stop_at_rest", time.stop_at_rest, reason)
    for name in ("history_interval", "checkpoint_interval"):
        value = getattr(output, name)
        if value is not None and value < time.least_step:
            reason = f"is shorter than time.step = {time.step:g} s; choose at least one step"
            raise refusal(f"output.{name}", value, reason)
    if output.frames_per_second * time.least_step > 1.0 + ROUND_OFF:
        reason = f"is more than one frame in a time.step of {time.step:g} s; choose at most {1.0 / time.step:.6g}"
        raise refusal("output.frames_per_second", output.frames_per_second, reason)
