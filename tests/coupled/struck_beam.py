"""A disc falls on the middle of a free elastic beam: what it gives, and what the first mode takes."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from independent_beam import IndependentBeam
from ways import Way

from coupled.build import build
from coupled.model import Model
from coupled.scene import Scene

LENGTH, HEIGHT, ALONG, ACROSS, DENSITY, YOUNG, POISSON = 0.2, 0.02, 20, 2, 1000.0, 1e9, 0.3
DISC_RADIUS, DISC_DENSITY, SPEED, GLUED_RADIUS, GAP = 0.005, 1000.0, 0.1, 1.5e-3, 1e-6
DISC_MASS = np.pi * DISC_RADIUS**2 * DISC_DENSITY
BEAM = IndependentBeam(length=LENGTH, height=HEIGHT, along=ALONG, across=ACROSS, young=YOUNG, poisson=POISSON)


@functools.cache
def first_mode() -> tuple[float, np.ndarray]:
    """Angular frequency [1/s] and shape (n, 2), of modal mass 1 kg/m, of the independent beam."""
    omega, shapes = BEAM.modes(DENSITY, 1)
    return float(omega[0]), shapes[:, 0].reshape(-1, 2)


@dataclass(frozen=True)
class Blow:
    """One impact.

    impulse [N s/m] that the disc gave; lasted [s] from first touch to last; amplitude [m sqrt(kg/m)] of the first
    mode after it; momentum and energy, after over before; pulse, the forces (n,) [N/m] at each window.
    """

    impulse: float
    lasted: float
    amplitude: float
    momentum: float
    energy: float
    pulse: np.ndarray
    window: float

    @property
    def predicted(self) -> float:
        """Amplitude of the first mode after a blow without duration: impulse, shape, modal mass 1, frequency."""
        omega, shape = first_mode()
        struck = (ALONG + 1) * ACROSS + ALONG // 2
        return self.impulse * abs(shape[struck, 1]) / omega

    @property
    def by_pulse(self) -> float:
        """The same for the forces as they came: Duhamel's integral, ``|int F exp(-i omega t) dt|`` for the impulse."""
        omega, _ = first_mode()
        turn = np.exp(-1j * omega * self.window * np.arange(len(self.pulse)))
        return self.predicted * abs(np.sum(self.pulse * turn)) / np.sum(self.pulse)


def strike(way: Way, window: float, *, stiffness: float) -> Blow:
    """Let a disc with normal stiffness [N/m] fall at `SPEED` on a beam at rest, until it has left."""
    interface = way.table(boundary="top", per_facet=3, radius=GLUED_RADIUS)
    height = HEIGHT / 2 + way.standoff(GLUED_RADIUS) + DISC_RADIUS + GAP
    tables = {
        "title": "A disc falls on a free beam",
        "time": {"duration": 1.0, "step": window / interface.get("substeps", 1)},
        "grains": {
            "sizes": [{"radius": DISC_RADIUS, "count": 1}],
            "density": DISC_DENSITY,
            "layout": "list",
            "positions": [[0.0, height, 0.0, -SPEED]],
        },
        "contact": {"normal_stiffness": stiffness},
        "structure": {
            "kind": "elastic",
            "density": DENSITY,
            "youngs_modulus": YOUNG,
            "poissons_ratio": POISSON,
            "element": "standard",
            "beam": {"length": LENGTH, "height": HEIGHT, "along": ALONG, "across": ACROSS},
        },
        "interface": interface,
    }
    model = build(Scene.model_validate(tables)).model
    body, omega = model.structure, first_mode()[0]
    pulse = []
    longest = 2 * np.pi * np.sqrt(DISC_MASS / stiffness) + 4 * GAP / SPEED + 2 * np.pi / omega
    for _ in range(round(longest / window)):
        model.advance(1)
        pulse.append(-model.reaction[1])
    touched = np.nonzero(pulse)[0]
    assert len(touched) and touched[-1] < len(pulse) - 10  # it has left
    momentum = model.particles.momentum()[1]
    energies, grains = body.energies(), model.particles.energies()
    return Blow(
        impulse=momentum + DISC_MASS * SPEED,
        lasted=window * (touched[-1] - touched[0]),
        amplitude=_amplitude(model),
        momentum=(momentum + body.momentum()[1]) / (-DISC_MASS * SPEED),
        energy=(energies.kinetic + energies.strain + grains["kinetic"]) / (0.5 * DISC_MASS * SPEED**2),
        pulse=np.array(pulse),
        window=window,
    )


def _amplitude(model: Model) -> float:
    """Of the first mode: ``sqrt(q^2 + (dq/dt/omega)^2)``, q by the product with the mass."""
    omega, shape = first_mode()
    fields = model.structure.fields()
    places = BEAM.points - [LENGTH / 2, HEIGHT / 2]
    own = np.argmin(np.linalg.norm(fields.points - places[:, None], axis=2), axis=1)
    weighed = BEAM.mass(DENSITY) @ shape.ravel()
    q, rate = (weighed @ fields.point_data[name][own].ravel() for name in ("displacement", "velocity"))
    return float(np.hypot(q, rate / omega))
