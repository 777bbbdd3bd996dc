"""How far a time step is from the limits of the contact network."""

import math

import numpy as np

from particles.contact import Contact
from particles.errors import ParticleError
from particles.kernels.slopes import Touching, slopes
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


def braking_time(grains: Grains, contact: Contact) -> float:
    """Shortest time ``m_eff/c_n`` [s] in which the dashpot of a contact brakes; infinite without dashpots.

    Of the lightest grains of each material with each other, with walls and with prescribed grains. A step
    longer than this turns the motion about by the dashpot alone, up to a rebound faster than the impact, and
    the energy ledger books what comes from nothing as a negative loss.
    """
    masses = [
        np.sort(grains.mass[: grains.n_free][grains.material[: grains.n_free] == a]) for a in range(contact.materials)
    ]
    rows = []
    for a, own in enumerate(masses):
        for b, others in enumerate(masses):
            partners = own[1:] if a == b else others
            if len(own):
                rows += [(own[0], np.inf, a, b), *((own[0], partner, a, b) for partner in partners[:1])]
    if not rows:
        return math.inf
    mass, partner, i, j = np.array(rows).T
    radius = float(grains.radius[: grains.n_free].min())
    size = np.full(len(rows), radius)
    inverse_mass = 1.0 / mass + 1.0 / partner
    asked = Touching(
        ALLOWED_OVERLAP * size, size, inverse_mass, np.zeros(len(rows)), i.astype(np.int64), j.astype(np.int64)
    )
    k, c = np.empty((len(rows), 3)), np.empty((len(rows), 3))
    slopes(contact.numbers(), asked, k, c)
    fastest = float((c[:, 0] * inverse_mass).max())
    return 1.0 / fastest if fastest > 0.0 else math.inf


def require_stable(grains: Grains, contact: Contact, time_step: float) -> None:
    """Refuse a step above ``2 sqrt(m/k_n)``, which no grain in contact survives, or above `braking_time`."""
    limit = source_bound(grains, contact, factor=2.0)
    if time_step > limit:
        raise ParticleError(
            f"time step {time_step:g} s is above the limit {limit:g} s of a single contact: "
            f"take at most {source_bound(grains, contact):g} s"
        )
    brakes = braking_time(grains, contact)
    if time_step > brakes:
        raise ParticleError(
            f"time step {time_step:g} s is above m_eff/c_n = {brakes:g} s, in which the normal dashpot stops two "
            f"grains, and would throw them back; take at most {0.1 * brakes:g} s, or less normal damping"
        )
