"""What a knob is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from coupled.scene import Scene
from coupled.study.settings.turns import Changes, Value


def _always(scene: Scene) -> bool:
    return True


@dataclass(frozen=True, kw_only=True)
class Knob:
    """Something that can be turned without changing the case that a scene describes.

    Parameters
    ----------
    name, meaning : str
    values : tuple
        What is tried unless others are asked for, from cheap to accurate.
    own : function
        The value that a scene has; None if the scene does not have the knob.
    turn : function
        Overrides that turn it.
    refine : function, optional
        Overrides of a level of refinement, 1 for twice as fine, and what to take instead where the scene refuses them;
        for knobs that the reference refines.
    falls : bool
        Whether the error falls with a power of the value, so that an order can be read off.
    usual : function
        Whether it is turned where nobody names it.
    sets_step : bool
        Whether the step itself is what is turned. A setting of any other knob that the exchange would not bear takes
        the longest step that it does.
    threads : bool
        Whether it is the number of threads, which is no key.
    speed_only : bool
        Whether results must not change by a bit.
    """

    name: str
    meaning: str
    values: tuple[Value, ...]
    own: Callable[[Scene], Value | None]
    turn: Callable[[Scene, Value], Changes]
    refine: Callable[[Scene, int], tuple[Changes, ...]] | None = None
    falls: bool = False
    usual: Callable[[Scene], bool] = _always
    sets_step: bool = False
    threads: bool = False
    speed_only: bool = False

    def label(self, value: Value) -> str:
        """A value as tables show it."""
        return f"{value:g}" if isinstance(value, float) else str(value)
