"""An elastic beam that falls on two short rows of fixed discs: the coupled run, and an independent one."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from independent_beam import IndependentBeam
from independent_body import motion
from independent_contact import row_below
from small_models import on_row
from ways import Way

LENGTH, HEIGHT, DENSITY, MASS = 1.0, 0.05, 2700.0, 135.0
YOUNG, POISSON, K_N, RADIUS, SPEED = 70e9, 0.35, 1.97e7, 4.1e-3, 0.2
ROWS = [np.linspace(38, 42, 5) / 120, np.linspace(78, 82, 5) / 120]  # about the thirds of the length
DURATION, EVERY = 6.4e-3, 1.6e-4
FALL = 0.5 * MASS * SPEED**2


@dataclass(frozen=True)
class Fall:
    """Lower face (k, n) [m], mean speed (k,) and energies (k,), these over those of the fall, every so often."""

    face: np.ndarray
    speed: np.ndarray
    kinetic: np.ndarray
    strain: np.ndarray

    @property
    def rebound(self) -> float:
        """Mean speed of the rebound over that of the fall."""
        return float(self.speed[-1])

    @property
    def left(self) -> float:
        """Share of the energy that stays in the vibrations of the beam after the rebound."""
        return float(self.kinetic[-1] + self.strain[-1] - self.speed[-1] ** 2)


def coupled(way: Way, window: float, *, along: int, element: str) -> Fall:
    model = on_row(
        way,
        window=window,
        structure={
            "kind": "elastic",
            "youngs_modulus": YOUNG,
            "poissons_ratio": POISSON,
            "density": DENSITY,
            "element": element,
            "beam": {"length": LENGTH, "height": HEIGHT, "along": along, "across": 2},
        },
        contact={"normal_stiffness": K_N},
        rows=ROWS,
        radius=RADIUS,
        per_facet=120 // along,
    )
    body = model.structure
    body.set_initial(velocity=np.tile([0.0, -SPEED], (len(body.mesh.points), 1)))
    x, y = body.polyline.points.T
    below = np.nonzero(np.isclose(y, 0.0))[0]
    below = below[np.argsort(x[below])]
    seen = []
    for _ in range(round(DURATION / EVERY)):
        model.advance(round(EVERY / window))
        energies = body.energies()
        state = (body.momentum()[1] / MASS / SPEED, energies.kinetic / FALL, energies.strain / FALL)
        seen.append((body.boundary_displacement[below, 1], *state))
    assert not model.contact_force.any()  # it has left
    return Fall(*(np.array(column) for column in zip(*seen)))


@functools.cache
def independent(interface: str, *, along: int, across: int, step: float) -> Fall:
    beam = IndependentBeam(length=LENGTH, height=HEIGHT, along=along, across=across, young=YOUNG, poisson=POISSON)
    fall = np.tile([0.0, -SPEED], len(beam.points))
    moved = motion(
        beam,
        density=DENSITY,
        step=step,
        duration=DURATION,
        every=round(EVERY / step),
        contact=row_below(beam, interface, np.concatenate(ROWS), radius=RADIUS, stiffness=K_N),
        velocity=fall,
    )
    momentum = moved.velocity @ beam.mass(DENSITY)
    kinetic = 0.5 * np.sum(momentum * moved.velocity, axis=1) / FALL
    strain = 0.5 * np.sum((moved.displacement @ beam.stiffness) * moved.displacement, axis=1) / FALL
    assert not moved.contact[-1].any()
    face = moved.displacement[:, 1::2][:, : along + 1]
    return Fall(face, momentum[:, 1::2].sum(axis=1) / MASS / SPEED, kinetic, strain)
