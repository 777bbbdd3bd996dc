"""How far a time step is from the limits of the contact network."""

import math

import numpy as np

from particles.contact import ContactModel
from particles.errors import ParticleError
from particles.state import Grains

SOURCE_FACTOR = 0.5


def source_bound(grains: Grains, contact: ContactModel, *, factor: float = SOURCE_FACTOR) -> float:
    """Critical step of the source [s]: the smaller of ``C sqrt(m/k_n)`` and ``C sqrt(I/(k_t r^2))``.

    The smallest mass, the smallest ``I/r^2`` of the free grains. Conservative by design with
    C = 0.5: the limit of one undamped contact with a wall is 2 sqrt(m/k_n); a grain with z
    contacts has less. Infinite without free grains. Source: model 1.4; Gomes 2014, section 2.1.4.
    """
    if grains.n_free == 0:
        return math.inf
    free = slice(grains.n_free)
    bound = math.sqrt(float(grains.mass[free].min()) / contact.normal.stiffness)
    if contact.tangential is not None:
        rotational = float(np.min(grains.inertia[free] / grains.radius[free] ** 2))
        bound = min(bound, math.sqrt(rotational / contact.tangential.stiffness))
    return factor * bound


def require_stable(grains: Grains, contact: ContactModel, time_step: float) -> None:
    """Refuse a step above ``2 sqrt(m/k_n)``, the limit of a single contact, which no grain survives."""
    limit = source_bound(grains, contact, factor=2.0)
    if time_step > limit:
        raise ParticleError(
            f"time step {time_step:g} s is above the limit {limit:g} s of a single contact: "
            f"take at most {source_bound(grains, contact):g} s"
        )
