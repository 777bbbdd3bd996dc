"""Velocity Verlet: the leapfrog where nothing depends on velocity, of order 2 where dashpots do."""

import numpy as np
import pytest
from discs import by_number, full_law, normal_only, packing

from particles import Grains, ParticleError, ParticleSystem
from particles.contact.recipe import damping_ratio

K_N, RADIUS, DENSITY, SPEED = 1e5, 1e-3, 1000.0, 0.1
MASS = np.pi * RADIUS**2 * DENSITY
OMEGA = np.sqrt(2 * K_N / MASS)  # of a pair


def pair(scheme: str, dt: float, zeta: float, overlap: float = 0.0) -> ParticleSystem:
    """Two discs that approach each other; the contact may pull."""
    half = RADIUS - 0.5 * overlap
    grains = Grains.discs([[-half, 0.0], [half, 0.0]], RADIUS, DENSITY, velocity=[[SPEED / 2, 0.0], [-SPEED / 2, 0.0]])
    c_n = 2 * zeta * np.sqrt(K_N * MASS / 2)
    return normal_only(grains, k_n=K_N, c_n=c_n, may_pull=True, time_step=dt, scheme=scheme)


def overlap_error(scheme: str, steps: int, zeta: float = 0.2) -> float:
    """Of the overlap after a third of a period, against the damped oscillator, over its amplitude.

    It begins inside the contact: at the moment of touching the dashpot's force jumps, which costs any
    scheme of fixed steps its second order.
    """
    end, overlap = 2.0 / OMEGA, 0.5 * SPEED / OMEGA
    system = pair(scheme, end / steps, zeta, overlap)
    system.advance(steps)
    damped = OMEGA * np.sqrt(1 - zeta**2)
    sine = (SPEED + zeta * OMEGA * overlap) / damped * np.sin(damped * end)
    exact = np.exp(-zeta * OMEGA * end) * (overlap * np.cos(damped * end) + sine)
    x = by_number(system, "x")[0]
    return abs(2 * RADIUS - (x[1] - x[0]) - exact) / (SPEED / OMEGA)


def test_order_two_with_dashpots() -> None:
    """The leapfrog's dashpots lag by half a step: order 1; shown the present velocity: order 2."""
    steps = np.array([50, 100, 200, 400])
    for scheme, order in (("leapfrog", 1.0), ("velocity_verlet", 2.0)):
        errors = np.array([overlap_error(scheme, n) for n in steps])
        slopes = np.log(errors[:-1] / errors[1:]) / np.log(2.0)
        np.testing.assert_allclose(slopes, order, atol=0.15)


def test_same_bits_as_leapfrog_without_dashpots() -> None:
    moved = []
    for scheme in ("leapfrog", "velocity_verlet"):
        grains, _, _ = packing(300, seed=4)
        system = full_law(grains, k_n=2e5, k_t=1e4, mu=0.5, mu_r=0.1, time_step=2e-6, scheme=scheme)
        system.advance(200)
        moved.append(by_number(system, "x", "y", "theta", "vx", "vy", "omega"))
    np.testing.assert_array_equal(moved[0], moved[1])


def test_ledger_closes_with_every_dashpot_and_drag() -> None:
    """Trapezoidal works of forces that see the present velocity, over the path of the half steps."""
    for scheme in ("leapfrog", "velocity_verlet"):
        errors = []
        for steps in (400, 800):
            grains, width, _ = packing(64, seed=4)
            system = full_law(
                grains, k_n=2e5, k_t=1e4, c_n=2.0, c_t=1.0, mu=0.5, mu_r=0.1, eta_r=0.3, alpha_t=50.0, alpha_r=50.0,
                time_step=8e-4 / steps, scheme=scheme, period=(width, None), gravity=(0.0, -9.81),
            )  # fmt: skip
            before = balance(system)
            system.advance(steps)
            turned = before - system.energies()["kinetic"]
            errors.append(abs(balance(system) - before) / abs(turned))
        # the turn of the normals and the births inside a step: falls with the step
        assert errors[1] < 0.7 * errors[0] < 0.7 * 0.01


def balance(system: ParticleSystem) -> float:
    return sum(-v if name.startswith("work") else v for name, v in system.energies().items())


def test_restitution_is_reached_at_a_coarser_step() -> None:
    """20 steps in a collision: the rebound speed is off by 2 % with lagging dashpots, by far less without."""
    e = 0.5
    zeta = damping_ratio(e, may_pull=True)
    dt = np.pi / (OMEGA * np.sqrt(1 - zeta**2)) / 20
    miss = {}
    for scheme in ("leapfrog", "velocity_verlet"):
        system = pair(scheme, dt, zeta)
        while True:
            system.advance(1)
            if system.look().count == 0:
                break
        vx = by_number(system, "vx")[0]
        miss[scheme] = abs((vx[1] - vx[0]) / SPEED - e)
    assert miss["velocity_verlet"] < 0.3 * miss["leapfrog"]


def test_state_goes_on_with_the_same_bits() -> None:
    def system() -> ParticleSystem:
        return full_law(
            packing(100, seed=2)[0], k_n=2e5, k_t=1e4, c_n=2.0, mu=0.5, time_step=2e-6, scheme="velocity_verlet"
        )

    whole, first, second = system(), system(), system()
    whole.advance(100)
    first.advance(40)
    second.restore(first.state())
    second.advance(60)
    for name, array in whole.state().items():
        np.testing.assert_array_equal(array, second.state()[name], err_msg=name)


def test_unknown_scheme_is_refused() -> None:
    with pytest.raises(ParticleError, match="'euler' must be one of leapfrog, velocity_verlet"):
        pair("euler", 1e-6, 0.0)
