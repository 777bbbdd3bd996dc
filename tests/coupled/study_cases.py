"""Settings that never ran, with values and times that a test chooses."""

from __future__ import annotations

from collections.abc import Sequence

from coupled.study.judging.reference import EXACT, Reference
from coupled.study.settings.setting import Ran, Role, Setting

QUANTITY = "drop"


def ran(
    name: str, wall: float, values: Sequence[float], *, role: Role = "knob", knob: tuple[str, str] | None = None
) -> Ran:
    """A setting that is done."""
    setting = Setting(name=name, role=role, knobs=() if knob is None else (knob,))
    return Ran(
        setting=setting, status="done", values={QUANTITY: tuple(values)}, wall_seconds=wall, cpu_seconds=wall,
        steps_per_second=1.0 / wall,
    )  # fmt: skip


def exactly(value: float, *, scale: float = 1.0) -> Reference:
    """A reference without error."""
    return Reference(samples=(value,), error=0.0, source=EXACT, scale=scale)
