"""The lines that tell the quantities of interest of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from coupled.scene.history import unit_of
from coupled.scene.quantities import ColumnOverTime, Packing, Quantity, Surface


def unit_shown(quantity: Quantity, units: str) -> str:
    """The unit of a quantity: its own, or that of its column, of a scene whose key `units` is given."""
    if quantity.unit is not None:
        return quantity.unit
    if isinstance(quantity, Surface) and quantity.kind == "surface_angle":
        return "degrees"
    if units != "SI" or isinstance(quantity, Packing):
        return "-"
    if isinstance(quantity, Surface):
        return "m"
    if isinstance(quantity, ColumnOverTime) and quantity.kind == "frequency":
        return "Hz"
    return unit_of(quantity.column)


def quantity_lines(quantities: Sequence[Quantity], values: Mapping[str, float | None], units: str) -> list[str]:
    """A line per quantity: name, value, unit, and how far it is from a value that is known otherwise.

    `units` is that key of the scene.
    """
    lines = []
    for quantity in quantities:
        value, label = values.get(quantity.name), f"  {quantity.name:<24}"
        if value is None:
            lines.append(f"{label} {'not known':>12} (see log.txt)")
            continue
        unit = unit_shown(quantity, units)
        line = f"{label} {value:12.6g} {'' if unit == '-' else unit:<6}"
        if quantity.exact is not None:
            line += f" exact {quantity.exact:.6g}, off by {value - quantity.exact:.2g}"
            scale = quantity.scale or abs(quantity.exact)
            line += f" ({100.0 * (value - quantity.exact) / scale:.2g} %)" if scale else ""
        lines.append(line.rstrip())
    return lines
