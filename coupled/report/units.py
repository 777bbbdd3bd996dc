"""Units beside numbers that are shown; a dimensionless scene has none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

PARTS = {"mm": 1e3, "um": 1e6, "MPa": 1e-6}  # of the SI unit in the files


@dataclass(frozen=True)
class Shown:
    """How numbers of a scene are shown whose key `units` is given."""

    units: str

    @property
    def dimensionless(self) -> bool:
        """Whether numbers stand alone, as they are in the files."""
        return self.units != "SI"

    def number(self, value: Any, unit: str) -> Any:
        """A number or array of the files in a unit."""
        return value if self.dimensionless else PARTS.get(unit, 1.0) * value

    def after(self, unit: str) -> str:
        """What is written after a number."""
        return "" if self.dimensionless else f" {unit}"

    def label(self, text: str, unit: str) -> str:
        """Of an axis."""
        return text if self.dimensionless else f"{text} [{unit}]"
