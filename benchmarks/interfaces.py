"""What the two interfaces cost: a rigid ring pressed into a bed, with glued grains and with facets."""

import beds
import numpy as np
from timing import interleaved, seconds

from particles import Facets, Grains, ParticleSystem, box, continued
from particles.beds import drop_height_of_facets

SIDES, PER_FACET = 30, 6  # the tube of G 4.2.1
RADIUS, SPEED, DEPTH = 0.05, 0.1, 3e-3  # [m], [m/s], [m]


def pressed(saved: beds.State, kind: str, *, width: float = beds.WIDTH, radius: float = RADIUS) -> ParticleSystem:
    """A settled bed with a ring that has gone DEPTH down into its middle and stands there."""
    grains = Grains.from_saved(saved)
    highest = float((grains.y + grains.radius).max())
    turn = 2.0 * np.pi * (np.arange(SIDES) - 0.25) / SIDES
    corner = radius * np.column_stack([np.cos(turn), np.sin(turn)]) + [width / 2, highest + radius]
    index = np.arange(SIDES)
    chain = np.column_stack([index, np.roll(index, -1)])
    corner -= [0.0, drop_height_of_facets(grains, corner, chain)]
    following, facets = np.roll(corner, -1, axis=0), None
    if kind == "glued":
        share = (np.arange(PER_FACET) / PER_FACET)[:, None, None]
        place = ((1.0 - share) * corner + share * following).transpose(1, 0, 2).reshape(-1, 2)
        thick = float(np.hypot(*(following - corner)[0])) / PER_FACET / 2.0
        grains = grains.with_prescribed(place + [0.0, thick], thick, 0)
    else:
        facets = Facets(points=corner, facets=chain)
    system = continued(
        saved, grains, beds.FULL, time_step=beds.TIME_STEP, walls=box(width, beds.HEIGHT), gravity=beds.GRAVITY,
        facets=facets, ledger=False,
    )  # fmt: skip
    for velocity, steps in (([0.0, -SPEED], round(DEPTH / SPEED / beds.TIME_STEP)), ([0.0, 0.0], 0)):
        if kind == "glued":
            system.set_velocity(slice(grains.n_free, len(grains)), velocity)
        else:
            system.facets.set_velocity(velocity)
        system.advance(steps)
    return system


def costs(saved: beds.State, steps: int, rounds: int, **shape: float) -> dict[str, float]:
    """Time of a step [s] of the bed with each interface."""
    systems = {kind: pressed(saved, kind, **shape) for kind in ("glued", "facets")}
    return interleaved({kind: lambda s=system: seconds(s, steps) / steps for kind, system in systems.items()}, rounds)


def interfaces() -> dict[str, float]:
    """Cost of a step with facets over one with glued grains."""
    cost = costs(beds.reference(), 300, 7)
    return {"facets_over_glued": cost["facets"] / cost["glued"]}
