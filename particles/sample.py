"""A settled sample of grains, and the limit of the time step in it."""

import math
from collections.abc import Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from particles.beds import lattice
from particles.contact import ContactModel, GlobalDamping, LinearSpringDashpot
from particles.stability import StepLimit, sharp_limit
from particles.state import Grains
from particles.system import ParticleSystem
from particles.walls import box

COUNT = 1000
NARROWEST = 6.0  # periodic sides, in the largest radii
SOLID = 0.8  # share of the discs in a bed
HIGH = 1e3  # times the width: more than any lattice needs
OVERLAP = 0.01  # of the smallest radius, at the floor, on the average
CHUNK, MOST = 3000, 40  # steps between looks, and looks
STILL = 0.005  # change of the number of contacts from look to look in a sample at rest
STEP = 0.15  # over sqrt(m/k) of the smallest
DRAG = 0.01  # times sqrt(k/m)
Sizes = tuple[tuple[float, int], ...]


def sample_limit(
    sizes: Sequence[tuple[float, int]],
    density: float,
    contact: ContactModel,
    *,
    damping: GlobalDamping | None = None,
    scheme: str = "leapfrog",
) -> StepLimit:
    """Sharp limit of the time step on a settled sample of grains, before any of them has come to rest.

    It has settled without friction, and so has more contacts (close to four to a grain that bears) than a bed with
    friction. Its overlaps are those of its own weight: a spring that stiffens with overlap has a smaller limit where it
    is pressed harder, for which `packing_limit` is made. For the soil of G 4, whose 15 000 grains at rest have
    4.6e-5 s, it gives 4.55e-5 s, with other seeds 4.50e-5 s.

    Parameters
    ----------
    sizes : sequence of (radius [m], count)
        Of the whole bed; the sample has as large a share of each.
    density : float
        [kg/m3].
    contact, damping, scheme
        As of a `ParticleSystem`.
    """
    largest = max(radius for radius, _ in sizes)
    total = sum(count for _, count in sizes)
    places, radius, width = _settled(tuple((r / largest, max(1, round(n * COUNT / total))) for r, n in sizes))
    grains = Grains.discs(places * largest, radius * largest, density)
    system = ParticleSystem(
        grains,
        contact,
        time_step=1.0,  # not taken
        walls=box(width * largest, HIGH * width * largest, ("floor",)),
        damping=damping,
        ledger=False,
        period=(width * largest, None),
        scheme=scheme,
    )
    return sharp_limit(system)


@cache
def _settled(sizes: Sizes) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Places (n, 2), radii (n,) and width of discs at rest between periodic sides, the largest of radius 1."""
    area = sum(number * math.pi * radius**2 for radius, number in sizes)
    width = max(NARROWEST, math.sqrt(area / SOLID))  # about as wide as high
    grains = lattice(sizes, 1.0, width=width, spacing=1.02, jitter=0.9)
    mass, stiffness = float(grains.mass.min()), 1.0
    frequency = math.sqrt(stiffness / mass)
    weight = OVERLAP * min(radius for radius, _ in sizes) * stiffness / (width / 2)
    system = ParticleSystem(
        grains,
        ContactModel(normal=LinearSpringDashpot(stiffness=stiffness, restitution=0.3)),
        time_step=STEP / frequency,
        walls=box(width, HIGH * width, ("floor",)),
        gravity=(0.0, -weight / mass),
        damping=GlobalDamping(translational=DRAG * frequency),
        ledger=False,
        period=(width, None),
    )
    before = 0
    for _ in range(MOST):
        system.advance(CHUNK)
        now = system.look().count
        if now > len(grains) and abs(now - before) <= STILL * now:
            break
        before = now
    return np.column_stack([grains.x, grains.y]), grains.radius.copy(), width
