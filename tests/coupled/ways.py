"""Every way in which a structure can meet grains: interface and exchange, as the keys of a scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

INTERFACES = ("glued",)
EXCHANGES: dict[str, dict[str, Any]] = {
    "predicted": {},
    "substeps": {"substeps": 4},
    "lagged": {"exchange": "lagged"},
}


@dataclass(frozen=True)
class Way:
    """An interface and an exchange."""

    interface: str
    exchange: str

    def __str__(self) -> str:
        return f"{self.interface}-{self.exchange}"

    def table(self, *, boundary: str, per_facet: int, radius: float) -> dict[str, Any]:
        """The table [interface] on one boundary; number and radius [m] are those of glued grains."""
        own = {"boundaries": [boundary], "largest_stiffness_ratio": 100.0} | EXCHANGES[self.exchange]
        return own | {"per_facet": per_facet, "diameter": 2 * radius}

    def standoff(self, radius: float) -> float:
        """How far the surface that meets grains stands off the boundary [m]."""
        return radius


WAYS = [Way(interface, exchange) for interface in INTERFACES for exchange in EXCHANGES]
GLUED = Way("glued", "predicted")
