"""Numbers of a contact law under a factor on its springs or on the size of its grains."""

from __future__ import annotations

import math
from typing import Any

Tables = dict[str, Any]
Factors = dict[str, float]


def by_stiffness(factor: float) -> Factors:
    """Factors by number: springs by f, dashpots by its root, so that ``c/sqrt(m k)`` stays, and with it restitution.

    An overlap allowed in a recipe, ``k = 2 m g h/delta^2``, by ``1/sqrt f``. Ratios stay.
    """
    root = math.sqrt(factor)
    springs = ("normal_stiffness", "hertz_stiffness", "youngs_modulus", "tangential_stiffness", "rolling_stiffness")
    return (
        dict.fromkeys(springs, factor)
        | dict.fromkeys(("normal_damping", "tangential_damping"), root)
        | {"max_overlap": 1.0 / root}
    )


def by_coarsening(factor: float) -> Factors:
    """Factors by number for radii times c: forces grow like overlaps and radii, and restitution stays.

    Linear springs stay, dashpots grow with the root of the mass, a rolling spring with ``r^2``. Hertz's force
    ``k_h delta^(3/2)`` must grow as c where the overlap does, with ``k_h ~ E sqrt r``.
    """
    return {
        "normal_damping": factor,
        "tangential_damping": factor,
        "rolling_stiffness": factor**2,
        "hertz_stiffness": factor**-0.5,
        "youngs_modulus": 1.0 / factor,
    }


def scaled(contact: Tables, factors: Factors) -> Tables:
    """The table of a contact law with its numbers times factors, in pairs, materials and recipe too."""
    own = _times(contact, factors)
    if "pairs" in own:
        own["pairs"] = [_times(pair, factors) for pair in own["pairs"]]
    if "materials" in own:
        own["materials"] = {name: _times(material, factors) for name, material in own["materials"].items()}
    if "recipe" in own:
        own["recipe"] = _times(own["recipe"], factors)
    return own


def _times(table: Tables, factors: Factors) -> Tables:
    return {name: value * factors[name] if name in factors else value for name, value in table.items()}
