"""Discs fall on a free elastic beam: momentum to round-off, energy with the order of the schemes."""

from typing import Any

import numpy as np
import pytest
from small_models import discs_on_free_beam

from coupled.model import Model

SPEED, GAP = 1.0, 1e-3
EXCHANGES = {"predicted": {}, "substeps": {"substeps": 4}, "lagged": {"exchange": "lagged"}}
# The structure's momentum at a full step lags the grains' at the half step by these multiples of
# the last force and of the one before, times H: half a step of the trapezoidal rule; 3/16 of the
# last difference, which the extrapolated mean of four has still to give back; one step more if lagged.
UNDERWAY = {"predicted": (0.5, 0.0), "substeps": (0.3125, -0.1875), "lagged": (1.0, 0.5)}


def falling(step: float, *, phase: float = 0.0, **options: Any) -> Model:
    """One disc, turning, that meets the beam at right angles to within 0.1; `phase` in steps."""
    height = 0.01 + GAP + 0.01 / 3 + phase * step * SPEED
    return discs_on_free_beam([[0.013, height, 0.1, -SPEED, 40.0]], step=step, **options).model


def total_energy(model: Model) -> float:
    """Stored and lost [J/m] on both sides, without the works across the interface."""
    grains, body = model.particles.energies(), model.structure.energies()
    own = sum(value for name, value in grains.items() if not name.startswith("work"))
    return own + body.kinetic + body.strain + body.rayleigh_loss - body.external_work


def interface_residual(model: Model) -> float:
    """Work [J/m] that the glued grains did on the discs, and the nodal forces on the beam."""
    return model.interface.work(model.particles) + model.structure.energies().boundary_work


@pytest.mark.parametrize("exchange", list(EXCHANGES))
def test_momentum_of_discs_and_beam_is_kept(exchange: str) -> None:
    """Four discs, friction, no walls, no gravity; each step and summed over the whole impact."""
    discs = [[x, 0.0145, vx, -1.0, 20.0] for x, vx in zip((-0.07, -0.02, 0.03, 0.08), (0.3, -0.1, 0.0, 0.2))]
    step = 5e-6
    model = discs_on_free_beam(discs, step=step, friction=0.5, interface=EXCHANGES[exchange]).model
    now, before = UNDERWAY[exchange]
    start = model.particles.momentum()
    drift, touched, last = 0.0, False, np.zeros(2)
    for _ in range(round(4e-3 / model.window)):
        model.advance(1)
        force = model.reaction
        touched |= bool(np.abs(force).max() > 100.0)
        assert np.abs(model.nodal_force.sum(axis=0) - force).max() <= 1e-14 * np.abs(model.nodal_force).sum()
        assert model.particles.force_residual() <= 1e-14
        underway = model.window * (now * force + before * last)
        kept = model.particles.momentum() + model.structure.momentum() + underway
        drift, last = max(drift, np.abs(kept - start).max()), force
    assert touched
    # Round-off of the structure's equation: its internal forces, E u, are 1e4 times the contact forces.
    assert drift <= 1e-11 * np.abs(start).max()


def test_falling_discs_gain_the_momentum_of_their_weight() -> None:
    """With gravity on the discs alone: m g t, whoever carries it."""
    step, weight = 1e-5, 2 * np.pi * 0.01**2 * 1000.0 * 9.81
    discs = [[-0.05, 0.0135, 0.0, -0.5], [0.05, 0.0135, 0.0, -0.5]]
    model = discs_on_free_beam(discs, step=step, gravity=(0.0, -9.81)).model
    start = model.particles.momentum()[1]
    model.advance(500)
    momentum = model.particles.momentum() + model.structure.momentum() + 0.5 * step * model.reaction
    assert model.structure.momentum()[1] < -0.1
    # The discs' velocity is half a step ahead, at the start as at the end.
    assert momentum[1] - start == pytest.approx(-weight * model.time, rel=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_energy_error_and_interface_residual_fall_with_order_two(friction: float) -> None:
    """Greatest error over the impact, mean of three phases of the first touch within a step."""
    errors = []
    for step in (2e-5, 1e-5, 5e-6, 2.5e-6):
        seen = []
        for phase in (0.0, 1 / 3, 2 / 3):
            model = falling(step, phase=phase, friction=friction)
            model.particles.start()
            start = total_energy(model)
            errs = []
            for _ in range(30):
                model.advance(round(1e-4 / step))
                errs.append((abs(total_energy(model) - start), abs(interface_residual(model))))
            seen.append(np.max(errs, axis=0) / start)
        errors.append(np.mean(seen, axis=0))
    energy, residual = np.array(errors).T
    halvings = np.arange(4)
    assert -np.polyfit(halvings, np.log2(energy), 1)[0] == pytest.approx(2.0, abs=0.1)
    assert energy[0] < 3e-4
    # The two works differ by the error of the prediction, (H omega)^3 of the fast elastic modes.
    assert -np.polyfit(halvings, np.log2(residual), 1)[0] > 1.9
    assert residual[0] < 2e-5


@pytest.mark.parametrize(
    ("options", "largest", "order"),
    [
        ({"interface": {"substeps": 4}}, 1e-3, 0.8),  # linear path against a curved one, extrapolated mean
        ({"interface": {"exchange": "lagged"}}, 3e-4, 0.8),
        ({"interface": {"velocity": "mean"}}, 1e-2, None),  # the facet's mean velocity does other work, at any step
    ],
    ids=["substeps", "lagged", "mean velocity"],
)
def test_interface_residual_of_the_other_exchanges(
    options: dict[str, Any], largest: float, order: float | None
) -> None:
    residuals = []
    for step in (1e-5, 5e-6, 2.5e-6):
        model = falling(step, **options)
        model.advance(round(3e-3 / model.window))
        residuals.append(abs(interface_residual(model)) / (0.5 * np.pi * 1e-4 * 1000.0 * SPEED**2))
    assert residuals[0] < largest
    rate = np.log2(residuals[0] / residuals[2]) / 2
    if order is None:
        assert abs(rate) < 0.1
    else:
        assert rate > order
