"""Refusals shared by the parameter classes: one sentence with name, value, allowed and remedy."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from structure.errors import StructureError


def positive(name: str, value: float, unit: str) -> None:
    """Refuse what is not a finite number above 0."""
    if not np.isfinite(value) or value <= 0:
        raise StructureError(f"{name} = {value!r} must be finite and above 0 ({unit})")


def not_negative(name: str, value: float, unit: str) -> None:
    """Refuse what is not a finite number of at least 0."""
    if not np.isfinite(value) or value < 0:
        raise StructureError(f"{name} = {value!r} must be finite and at least 0 ({unit})")


def plane_vector(name: str, value: Sequence[float], unit: str) -> None:
    """Refuse what is not two finite numbers."""
    if np.shape(value) != (2,) or not np.all(np.isfinite(value)):
        raise StructureError(f"{name} = {value!r} must be two finite numbers, x and y ({unit})")


def finite(name: str, value: float, unit: str) -> None:
    """Refuse what is not a finite number."""
    if not np.isfinite(value):
        raise StructureError(f"{name} = {value!r} must be finite ({unit})")


def schedule(value: object) -> None:
    """Refuse what does not say how strong a load is at a time."""
    if not all(hasattr(value, name) for name in ("factor", "constant_from", "largest")):
        raise StructureError(
            f"schedule = {value!r} is not known: use a Constant, a Ramp, a Sine, a Table, or what has factor(time), "
            "constant_from and largest"
        )


def state_of_this_kind(given: Collection[str], own: Collection[str]) -> None:
    """Refuse the arrays, by name, of a state that a body of another kind, theory or scheme has saved."""
    for problem, names in (("lacks", set(own) - set(given)), ("has", set(given) - set(own))):
        if names:
            raise StructureError(
                f"state {problem} {sorted(names)[0]!r}: it is that of another theory, scheme or kind of structure; restore "
                "it into the kind that has saved it"
            )
