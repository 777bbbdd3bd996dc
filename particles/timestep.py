"""How far a time step is from the limits of the contact network."""

import math

import numpy as np

from particles.contact import Contact
from particles.errors import ParticleError
from particles.state import Grains

SOURCE_FACTOR = 0.5
ALLOWED_OVERLAP = 0.05  # over the smallest radius
# Share of the dashpots in the limit, `particles.stability`: they see a velocity that is late or guessed ahead.
DASHPOT_SHARE = {"leapfrog": 1.0, "velocity_verlet": 2.0}


def source_bound(grains: Grains, contact: Contact, *, factor: float = SOURCE_FACTOR) -> float:
    """Critical step of the source [s]: the smaller of ``C sqrt(m/k_n)`` and ``C sqrt(I/(k_t r^2))``.

    The smallest mass, the smallest ``I/r^2`` of the free grains. Conservative by design with
    C = 0.5: the limit of one undamped contact with a wall is 2 sqrt(m/k_n); a grain with z
    contacts has less. Hertz's spring is taken at an overlap of 5 % of the smallest radius. Infinite
    without free grains. Source: model 1.4; Gomes 2014, section 2.1.4.
    """
    if grains.n_free == 0:
        return math.inf
    free = slice(grains.n_free)
    radius = float(grains.radius[free].min())
    rotational = float(np.min(grains.inertia[free] / grains.radius[free] ** 2))
    bound = math.inf
    for model in contact.models_of(np.unique(grains.material[free])):
        k_n = model.normal.stiffness_at(ALLOWED_OVERLAP * radius, 0.5 * radius)
        bound = min(bound, math.sqrt(float(grains.mass[free].min()) / k_n))
        if model.tangential is not None:
            bound = min(bound, math.sqrt(rotational / model.tangential.stiffness_at(k_n)))
    return factor * bound


def require_stable(grains: Grains, contact: Contact, time_step: float) -> None:
    """Refuse a step above ``2 sqrt(m/k_n)``, the limit of a single contact, which no grain survives."""
    limit = source_bound(grains, contact, factor=2.0)
    if time_step > limit:
        raise ParticleError(
            f"time step {time_step:g} s is above the limit {limit:g} s of a single contact: "
            f"take at most {source_bound(grains, contact):g} s"
        )
