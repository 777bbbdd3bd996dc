"""Every way in which a structure can meet grains: interface and exchange, as the keys of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

INTERFACES = ("glued", "facets")
EXCHANGES: dict[str, dict[str, Any]] = {
    "predicted": {},
    "substeps": {"substeps": 4},
    "lagged": {"exchange": "lagged"},
    "iterated": {"exchange": "iterated"},
    "iterated-substeps": {"exchange": "iterated", "substeps": 4},
}


# Of the error of displacements in the step of the structure, without dashpots.
ORDERS = {"predicted": 2.0, "substeps": 2.0, "lagged": 1.0, "iterated": 2.0, "iterated-substeps": 2.0}


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
        if self.interface == "facets":
            return own | {"kind": "facets"}
        return own | {"per_facet": per_facet, "diameter": 2 * radius}

    def standoff(self, radius: float) -> float:
        """How far the surface that meets grains stands off the boundary [m]."""
        return radius if self.interface == "glued" else 0.0


# The iterated exchange knows no interface: without sub-cycling it is asked of glued grains alone.
WAYS = [
    Way(interface, exchange)
    for interface in INTERFACES
    for exchange in EXCHANGES
    if (interface, exchange) != ("facets", "iterated")
]
GLUED = Way("glued", "predicted")


def assert_order(way: Way, errors: Sequence[float], *, within: float = 0.1) -> None:
    """The errors at steps that are halved fall with the order of the exchange."""
    rate = np.log2(errors[-2] / errors[-1])
    # Errors of 1e-4 hardly show the next order, the per cent of the lagged exchange by a tenth.
    assert abs(rate - ORDERS[way.exchange]) < (0.15 if way.exchange == "lagged" else within)


def relative(seen: np.ndarray, expected: np.ndarray) -> float:
    """Root of the mean square of the error over that of what is expected."""
    return float(np.sqrt(np.mean((seen - expected) ** 2) / np.mean(expected**2)))
