"""The one exception of this room."""

import math


class ParticleError(ValueError):
    """A parameter or a state that the discrete element model refuses."""


def require(name: str, value: float, *, above: float | None = None, at_least: float | None = None) -> None:
    """Refuse a number that is not finite or out of range, in one sentence."""
    if not math.isfinite(value):
        raise ParticleError(f"{name} = {value} must be a finite number")
    if above is not None and not value > above:
        raise ParticleError(f"{name} = {value:g} must be greater than {above:g}")
    if at_least is not None and not value >= at_least:
        raise ParticleError(f"{name} = {value:g} must be at least {at_least:g}")
