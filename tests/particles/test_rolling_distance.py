"""A disc rolls to rest under rolling resistance (G table 3.3 with r = 5 mm).

The limit moment mu_r r N works through the angle phi: it takes the energy 3/4 m V0^2 of a rolling
disc, so phi = 3/4 m V0^2/(mu_r r m g), up to the elastic angle mu_r r m g/k_r.
"""

import numpy as np
import pytest
from discs import FLOOR, by_number, full_law, resting_disc

from particles import (
    ContactModel,
    ContactTable,
    CoulombFriction,
    ElasticPlasticRolling,
    Grains,
    LinearSpringDashpot,
    ParticleSystem,
    Wall,
)

RADIUS, DENSITY, G, DT = 0.005, 1056.0, 9.81, 2e-5
MASS = np.pi * RADIUS**2 * DENSITY
LAW = {"k_n": 6.5e4, "k_t": 3.3e3, "c_n": 36.5, "c_t": 5.7, "k_r": 8.1e-2, "mu": 0.8}


def thrown(v0: float, **law: float) -> ParticleSystem:
    """The disc rolling at `v0` on the floor."""
    arm = RADIUS - 0.5 * MASS * G / LAW["k_n"]
    grains = resting_disc(radius=RADIUS, mass=MASS, gravity=G, k_n=LAW["k_n"], vx=v0, spin=-v0 / arm)
    return full_law(grains, **(LAW | law), walls=[FLOOR], gravity=(0.0, -G), time_step=DT)


@pytest.mark.parametrize("mu_r", [0.1, 0.2, 0.4])
def test_distance_is_a_plateau_given_by_the_energy(mu_r: float) -> None:
    v0 = 0.5
    system = thrown(v0, mu_r=mu_r, eta_r=0.3)
    stop = 1.5 * v0 / (mu_r * G)  # constant deceleration mu_r g/1.5
    system.advance(int((stop + 0.3) / DT))
    distance, rigid = system.grains.x[0], 0.75 * v0**2 / (mu_r * G)
    # At rest the moment spring unwinds by M/k_r and the tangential one by m g mu_r/(1.5 k_t), which
    # is 2/3 as much here; the lever arm is shorter than r by 1.2e-3, a third of which enters.
    elastic = RADIUS * mu_r * RADIUS * MASS * G / LAW["k_r"]
    assert rigid * (1.0 - 5e-4) - 2.0 * elastic < distance < rigid + 0.5 * elastic
    system.advance(int(0.2 / DT))
    assert system.grains.x[0] == pytest.approx(distance, abs=1e-3 * elastic)


def test_deceleration_on_the_way() -> None:
    mu_r = 0.2
    system = thrown(1.0, mu_r=mu_r, eta_r=0.3)
    system.advance(int(0.1 / DT))
    earlier, start = system.grains.vx[0], system.time
    system.advance(int(0.4 / DT))
    slope = (system.grains.vx[0] - earlier) / (system.time - start)
    assert slope == pytest.approx(-mu_r * G / 1.5, rel=1e-3)  # lever arm, as above


def eigenvalues(eta_r: float) -> np.ndarray:
    """Of the disc on its tangential and rolling springs: independent small linear model."""
    arm, inertia = RADIUS, 0.5 * MASS * RADIUS**2
    c_r = eta_r * 2.0 * np.sqrt((inertia + MASS * RADIUS**2) * LAW["k_r"])
    slip = np.array([[1.0, arm], [arm, arm**2]])
    turn = np.diag([0.0, 1.0])
    mass = np.diag([MASS, inertia])
    stiffness = LAW["k_t"] * slip + LAW["k_r"] * turn
    damping = LAW["c_t"] * slip + c_r * turn
    companion = np.block(
        [[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)]]
    )
    values = np.linalg.eigvals(companion)
    return values[values.imag > 0.0]


def ringing(eta_r: float) -> tuple[float, float, float]:
    """Period, and the amplitude of the spin over two successive stretches of 0.1 s."""
    system = thrown(0.01, mu_r=0.5, eta_r=eta_r)  # too slow to reach the limit moment
    spin = []
    for _ in range(int(0.25 / DT)):
        system.advance(1)
        spin.append(system.grains.omega[0])
    omega = np.array(spin)
    late = omega[int(0.02 / DT) :]
    sign = np.nonzero(np.diff(np.sign(late)) != 0)[0][:4]
    crossing = sign + late[sign] / (late[sign] - late[sign + 1])
    half = int(0.1 / DT)
    return (
        2.0 * DT * float(np.diff(crossing).mean()),
        float(np.abs(omega[half // 2 : half * 3 // 2]).max()),
        float(np.abs(omega[half * 3 // 2 :]).max()),
    )


def test_moment_rings_without_and_dies_out_with_the_rolling_dashpot() -> None:
    for eta_r in (0.0, 0.3):
        slow = min(eigenvalues(eta_r), key=lambda value: abs(value.imag))
        period, early, late = ringing(eta_r)
        # 1 %: lever arm and the rest of the fast, damped mode.
        assert period == pytest.approx(2.0 * np.pi / slow.imag, rel=1e-2)
        assert late / early == pytest.approx(np.exp(0.1 * slow.real), abs=0.05)


def test_period_does_not_depend_on_the_dashpot() -> None:
    undamped, _, _ = ringing(0.0)
    damped, _, _ = ringing(0.1)
    # Linear oscillator: sqrt(1 - zeta^2) with zeta near 0.1 changes it by 0.5 %.
    assert damped == pytest.approx(undamped, rel=1e-2)


def test_pairs_with_and_without_dashpot_share_a_table() -> None:
    """Two discs far apart on one floor, one with the dashpot: each moves as it does alone."""

    def model(eta_r: float) -> ContactModel:
        return ContactModel(
            normal=LinearSpringDashpot(stiffness=LAW["k_n"], damping=LAW["c_n"]),
            tangential=CoulombFriction(stiffness=LAW["k_t"], damping=LAW["c_t"], friction=LAW["mu"]),
            rolling=ElasticPlasticRolling(friction=0.5, damping_ratio=eta_r, stiffness=LAW["k_r"]),
        )

    alone = [thrown(0.01, mu_r=0.5, eta_r=eta_r) for eta_r in (0.3, 0.0)]
    place = [[k, alone[0].grains.y[0]] for k in range(2)]
    arm = RADIUS - 0.5 * MASS * G / LAW["k_n"]
    both = Grains.discs(place, RADIUS, DENSITY, velocity=[[0.01, 0.0]] * 2, spin=-0.01 / arm, material=[0, 1])
    damped, undamped = model(0.3), model(0.0)
    floor = Wall(point=(0.0, 0.0), normal=(0.0, 1.0), material=1)
    table = ContactTable([[damped, damped], [damped, undamped]])
    system = ParticleSystem(both, table, walls=[floor], gravity=(0.0, -G), time_step=DT)
    for each in (*alone, system):
        each.advance(5000)
    turned = by_number(system, "theta")[0]
    assert abs(turned[0] - turned[1]) > 0.1 * abs(turned[1])
    # the same operations on both; only the sums of the two discs' places differ
    np.testing.assert_allclose(turned, [each.grains.theta[0] for each in alone], rtol=1e-9)
