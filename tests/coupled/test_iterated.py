"""The iterated exchange: stable at any stiffness ratio, exact in momentum and work, the same bits after going back."""

from typing import Any

import numpy as np
import pytest
from small_models import discs_on_free_beam, rigid_beam_on_springs

from coupled.balance import take_balance
from coupled.build import build
from coupled.errors import ExchangeError
from coupled.model import Model
from coupled.scene import load_scene

MASS, STIFFNESS, LOAD = 135.0, 121 * 1.97e7, 1.2e5  # of `rigid_beam_on_springs`
ITERATED: dict[str, Any] = {"exchange": "iterated", "largest_stiffness_ratio": 1e6}
INTERFACES = {"glued": {}, "facets": {"kind": "facets"}}
SURFACE = {"glued": 5e-3 / 3, "facets": 0.0}  # above the beam [m]


def two_discs(kind: str, *, step: float, **interface: Any) -> Model:
    """Turning, rubbing discs about to hit a free beam."""
    height = 0.0105 + SURFACE[kind]
    discs = [[-0.05, height, 0.3, -1.0, 90.0], [0.03, height, -0.1, -1.0, -60.0]]
    return discs_on_free_beam(discs, step=step, friction=0.5, interface=INTERFACES[kind] | ITERATED | interface).model


@pytest.mark.parametrize("substeps", [1, 5])
@pytest.mark.parametrize("ratio", [0.3, 10.0, 300.0])
def test_a_beam_on_springs_swings_as_the_trapezoidal_rule_says(ratio: float, substeps: int) -> None:
    """``z = exp(i phi)``, ``tan(phi/2) = omega H/2``: neither growth nor decay at any r, closed form in phase.

    With ``y = x - x_rest`` and v, ``y + i v/omega`` turns by phi each window.
    """
    omega, window = np.sqrt(STIFFNESS / MASS), np.sqrt(ratio * MASS / STIFFNESS)
    interface = ITERATED | {"substeps": substeps, "tolerance": 1e-9}
    step = window / substeps
    model = rigid_beam_on_springs(step=step, load=LOAD, ramp_over=10.5 * window, interface=interface).model
    model.advance(15)
    phases = []
    for _ in range(200):
        height = model.structure.centroid()[1] - 0.025 + LOAD / STIFFNESS
        phases.append(height + 1j * model.structure.momentum()[1] / MASS / omega)
        model.advance(1)
    seen = np.array(phases)
    # 200 windows, each solved to 1e-9 of its motion
    np.testing.assert_allclose(np.abs(seen), np.abs(seen[0]), rtol=1e-6)
    turned = np.unwrap(np.angle(seen[1:] / seen[:-1]))
    np.testing.assert_allclose(np.abs(turned), 2 * np.arctan(omega * window / 2), rtol=1e-6)
    assert model.iterated.trials <= 4 * model.steps_done  # a single mode: the second try is right but for round-off


@pytest.mark.parametrize("kind", INTERFACES)
@pytest.mark.parametrize("substeps", [1, 4])
def test_momentum_and_work_pass_as_they_are(kind: str, substeps: int) -> None:
    """Nothing but the contacts acts on discs and beam."""
    step = 5e-6
    model = two_discs(kind, step=step, substeps=substeps, tolerance=1e-9)
    start, drift = model.particles.momentum() + model.structure.momentum(), 0.0
    entries = take_balance(model, model.particles.look(), None).entries
    for _ in range(round(2e-3 / model.window)):
        model.advance(1)
        force = model.interface.forces(model.particles).resultant
        # velocities of grains are those half a grain step later
        kept = model.particles.momentum() + 0.5 * step * force + model.structure.momentum()
        drift = max(drift, np.abs(kept - start).max())
    # Round-off of the structure's equation: its internal forces, E u, are 1e4 times the contact forces.
    assert drift <= 1e-11 * np.abs(model.particles.momentum()).max()
    balance = take_balance(model, model.particles.look(), entries)
    received = abs(model.structure.energies().boundary_work)
    assert received > 0.1 * entries["grains_kinetic"]
    assert abs(balance.interface_residual) < 1e-8 * received  # each window's work to 1e-9


@pytest.mark.parametrize("kind", INTERFACES)
def test_a_state_goes_on_with_the_same_bits_and_counts_windows_once(kind: str) -> None:
    straight, resumed = (two_discs(kind, step=1e-5, substeps=3) for _ in range(2))
    straight.advance(30)
    saved, moment = {name: array.copy() for name, array in straight.state().items()}, straight.snapshot()
    resumed.restore(saved)
    straight.advance(30)
    resumed.advance(30)
    assert straight.iterated.trials > 60 + 10
    assert straight.particles.steps_done == 60 * 3 and straight.structure.time == pytest.approx(60 * straight.window)
    wanted = {name: array.copy() for name, array in straight.state().items()}
    straight.rewind(moment)
    assert straight.steps_done == 30
    straight.advance(30)
    for model in (resumed, straight):
        for name, array in model.state().items():
            np.testing.assert_array_equal(array, wanted[name], err_msg=name)


def test_a_driven_body_needs_no_second_run() -> None:
    tables = load_scene("winkler_beam").model_dump(exclude_none=True)
    tables["structure"] = {
        "kind": "rigid", "beam": tables["structure"]["beam"], "placement": tables["structure"]["placement"],
        "path": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, -0.01]]},
    }  # fmt: skip
    tables["interface"] |= {"exchange": "iterated"}
    model = build(type(load_scene("winkler_beam")).model_validate(tables)).model
    model.advance(50)
    assert model.iterated.trials == 50


def test_what_does_not_converge_is_said_with_its_number() -> None:
    options = ["interface.exchange=iterated", "interface.iterations=3", "contact.normal_damping=0.0"]
    built = build(load_scene("winkler_beam", ["time.step=4e-4", *options]))
    assert 10.0 < built.stiffness_ratio < 100.0
    with pytest.raises(ExchangeError, match=r"has not converged in 3 iterations, .* by \S+ of its motion"):
        built.model.advance(20)
    enough = build(load_scene("winkler_beam", ["time.step=4e-4", options[0], options[2]])).model
    enough.advance(20)
    assert enough.iterated.unsettled == 0
