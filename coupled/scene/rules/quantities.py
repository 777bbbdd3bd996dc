"""Rules of the quantities of interest: names of their own, columns that the scene writes, places in the box."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from coupled.scene.history import history_columns
from coupled.scene.quantities import ColumnOverTime, ColumnWhen, Packing, Quantity, Surface
from coupled.scene.refusal import missing, nearest, refusal

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def check_quantities(scene: Scene) -> None:
    """Check that a run of the scene can tell its quantities.

    A time after the end of the run is not refused, as a scene may be run shorter than it was written for: the
    quantity is then not known, and the run says so.
    """
    columns = history_columns(scene)
    seen: set[str] = set()
    for index, quantity in enumerate(scene.quantities):
        key = f"quantities.{index}"
        if not _NAME.fullmatch(quantity.name):
            raise refusal(
                f"{key}.name", quantity.name, "is no name; give letters, digits and underscores, a letter first"
            )
        if quantity.name in seen:
            raise refusal(f"{key}.name", quantity.name, "is given twice; name each quantity once")
        seen.add(quantity.name)
        if isinstance(quantity, (Surface, Packing)):
            _check_place(scene, quantity, key)
        else:
            _check_columns(quantity, key, columns)
            if isinstance(quantity, ColumnOverTime):
                _check_window(scene, quantity, key)


def _check_columns(quantity: Quantity, key: str, columns: tuple[str, ...]) -> None:
    for name in ("column", "other"):
        column = getattr(quantity, name, None)
        if column is not None and column not in columns:
            raise refusal(f"{key}.{name}", column, f"is no column that this scene writes; {nearest(column, columns)}")
    if isinstance(quantity, ColumnWhen):
        if quantity.reaches is None and quantity.changes_by is None:
            raise missing(f"{key}.reaches", f"say which value of {quantity.other}, or changes_by against its start")
        if quantity.reaches is not None and quantity.changes_by is not None:
            raise refusal(f"{key}.changes_by", quantity.changes_by, "is given together with reaches; keep one")


def _check_window(scene: Scene, quantity: ColumnOverTime, key: str) -> None:
    if quantity.end is not None and quantity.end <= quantity.start:
        raise refusal(f"{key}.end", quantity.end, f"is not after start = {quantity.start:g} s; give a later time")
    if quantity.over_periods is None:
        return
    if quantity.over is not None:
        raise refusal(f"{key}.over_periods", quantity.over_periods, "is given together with over; keep one")
    if scene.shaking is None:
        raise refusal(
            f"{key}.over_periods", quantity.over_periods, "counts periods of [shaking], which is not there; give over"
        )


def _check_place(scene: Scene, quantity: Surface | Packing, key: str) -> None:
    if scene.grains is None:
        raise refusal(f"{key}.kind", quantity.kind, "looks at free grains, which this scene has none of; add [grains]")
    ends = {"left": quantity.left, "right": quantity.right}
    if scene.box is None:
        for name, value in ends.items():
            if value is None:
                raise missing(f"{key}.{name}", "there is no box to take it from; give it in m")
    width = 0.0 if scene.box is None else scene.box.width
    left = 0.0 if quantity.left is None else quantity.left
    right = width if quantity.right is None else quantity.right
    if right <= left:
        raise refusal(f"{key}.right", right, f"is not right of left = {left:g} m; give a larger one")
    if scene.box is not None and "x" in scene.box.periodic and right - left > width:
        raise refusal(f"{key}.right", right, f"is more than a period of {width:g} m right of left; give a smaller one")
    if isinstance(quantity, Packing) and quantity.top <= quantity.bottom:
        raise refusal(f"{key}.top", quantity.top, f"is not above bottom = {quantity.bottom:g} m; give a larger one")
