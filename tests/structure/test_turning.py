"""Bodies that turn: a turn strains nothing, a free tube rolls once around, momenta and energy stay."""

import numpy as np
import pytest
from held import HeldBody
from moving import Scales, balance, cross, quarter, turned

import meshes
from structure import ElasticStructure, PlaneStrain, Rayleigh

NONLINEAR = ("corotational", "large_strain")
CENTRE = np.array([0.3, 0.2])


@pytest.fixture(scope="module")
def tube() -> meshes.StructureMesh:
    return meshes.tube(outer_radius=0.05, inner_radius=0.04, centre=tuple(CENTRE))


@pytest.mark.parametrize("theory", NONLINEAR)
@pytest.mark.parametrize("angle", [0.1, 1.5, 3.1, -2.0])
def test_a_turn_strains_nothing(theory: str, angle: float, soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    arms = tube.points - CENTRE
    displacement = turned(arms, angle) - arms + [0.02, -0.01]
    bodies = {t: ElasticStructure(tube, material=soft, time_step=1e-4, theory=t) for t in ("linear", theory)}
    for body in bodies.values():
        body.set_initial(displacement=displacement)
        assert body.mean_rotation() == pytest.approx(angle, rel=1e-12)
    # The linear theory takes the turn for a strain of cos(angle) - 1 in all directions.
    assert bodies["linear"].peaks().strain == pytest.approx(1 - np.cos(angle), rel=1e-9)
    body = bodies[theory]
    # Round-off of positions of 0.3 m over cells of 5 mm.
    assert body.peaks().strain < 1e-13
    data = body.fields().point_data
    for name in ("sigma_xx", "sigma_yy", "sigma_xy", "von_mises"):
        assert np.abs(data[name]).max() < 1e-13 * soft.youngs_modulus
    # The same round-off, a few 1e-16 m, in the fastest mode, 5e4 rad/s; the linear theory sees forces.
    assert np.abs(body.boundary_acceleration).max() < 1e-6
    assert np.abs(bodies["linear"].boundary_acceleration).max() > 1e2


@pytest.mark.parametrize("theory", NONLINEAR)
def test_stress_is_told_in_the_axes_of_space(theory: str, soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    """A small stretch along the body's own x, the body turned by a quarter: the stress is along y."""
    arms, stretch = tube.points - CENTRE, 1e-6
    body = ElasticStructure(tube, material=soft, time_step=1e-4, theory=theory)
    body.set_initial(displacement=turned(arms * [1 + stretch, 1.0], np.pi / 2) - arms)
    lam, mu = soft.lame
    data = body.fields().point_data
    # Beside it: squares of the stretch, and round-off of 1e-13 over the stretch.
    np.testing.assert_allclose(data["sigma_yy"], (lam + 2 * mu) * stretch, rtol=1e-5)
    np.testing.assert_allclose(data["sigma_xx"], lam * stretch, rtol=1e-5)
    np.testing.assert_allclose(data["strain_yy"], stretch, rtol=1e-5)
    np.testing.assert_allclose(data["sigma_xy"], 0.0, atol=1e-5 * lam * stretch)


SPEED_UP, COAST = 0.1, 0.1  # [s]
SPIN = 2 * np.pi / (SPEED_UP + COAST)  # [rad/s]: speeding up and braking make half a SPEED_UP each


def nominal_spin_rate(time: float) -> float:
    """Angular acceleration [rad/s^2]: sin^2 up, nothing, sin^2 down; 2 pi in all."""
    late = time - SPEED_UP - COAST
    for begin, sign in ((time, 1.0), (late, -1.0)):
        if 0.0 < begin < SPEED_UP:
            return sign * 2 * SPIN / SPEED_UP * np.sin(np.pi * begin / SPEED_UP) ** 2
    return 0.0


def roll(body: ElasticStructure, dt: float, rest: float) -> dict[str, list[float]]:
    """Tangential forces on the outer nodes speed the tube up and brake it; what is seen at each step."""
    scales, outer = Scales(body), body.polyline.points
    inertia = body._body.inertia
    seen = {name: [] for name in ("impulse", "angular_momentum", "strain", "rotation", "radius", "kinetic")}
    force, impulse = np.zeros_like(outer), 0.0
    places = outer.copy()
    for step in range(round((2 * SPEED_UP + COAST + rest) / dt)):
        arms = places - places.mean(axis=0)
        radius = np.hypot(*arms.T).mean()
        rate = nominal_spin_rate((step + 1) * dt)
        after = rate * inertia / (len(arms) * radius**2) * quarter(arms)
        body.advance(after)
        now = outer + body.boundary_displacement
        impulse += dt * cross((places + now) / 2, (force + after) / 2)
        force, places = after, now
        seen["impulse"].append(impulse)
        seen["angular_momentum"].append(scales.angular_momentum())
        seen["strain"].append(body.peaks().strain)
        seen["rotation"].append(body.mean_rotation())
        seen["kinetic"].append(body.energies().kinetic)
        seen["radius"].append(np.hypot(*(now - now.mean(axis=0)).T).mean())
    return seen


@pytest.mark.parametrize("theory", NONLINEAR)
def test_tube_rolls_once_around(theory: str, soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    dt = 1e-3
    # Over-damps breathing (1100 rad/s), as its static answer to the spin is to be seen; the spin must not feel it.
    damping = Rayleigh(stiffness_factor=2e-3)
    body = ElasticStructure(tube, material=soft, time_step=dt, damping=damping, theory=theory, element="standard")
    seen = roll(body, dt, rest=0.2)
    most = np.abs(seen["angular_momentum"]).max()
    # 500 steps of sums over some hundred terms, of positions of 0.3 m on a tube of 0.05 m.
    np.testing.assert_allclose(seen["angular_momentum"], seen["impulse"], rtol=0, atol=1e-11 * most)
    # Coasting: the radius is that under the centrifugal force, which scipy finds at small strain.
    held = HeldBody(tube, soft, "standard")
    coasting = round((SPEED_UP + 0.9 * COAST) / dt)
    spin = (seen["rotation"][coasting] - seen["rotation"][coasting - 10]) / (10 * dt)
    arms = tube.points - CENTRE
    u = held.unheld_displacement(spin**2 * (held.mass @ arms.ravel()).reshape(-1, 2))
    u -= u.mean(axis=0)
    grown = np.hypot(*(arms + u)[tube.outer_nodes].T).mean() - 0.05
    assert grown / 0.05 > 5e-4
    # Beside it: the square of the strain, 1e-3 of it.
    assert seen["radius"][coasting] - 0.05 == pytest.approx(grown, rel=5e-3)
    # The inertia has grown by twice the strain: the spin is that much lower.
    assert seen["rotation"][-1] == pytest.approx(2 * np.pi, rel=3e-3)
    # At rest again: no strain is left of a whole turn.
    assert max(seen["strain"]) < 4e-3
    assert seen["strain"][-1] < 1e-12
    # 500 steps of sums over some hundred terms.
    assert abs(balance(body.energies())) < 1e4 * np.finfo(float).eps * max(seen["kinetic"])


def test_linear_tube_does_not_roll(soft: PlaneStrain, tube: meshes.StructureMesh) -> None:
    """The same forces on the linear theory: the tube swells without strain, never gets beyond a quarter turn,
    and its angular momentum is not what the forces gave it."""
    dt = 1e-3
    body = ElasticStructure(tube, material=soft, time_step=dt, damping=Rayleigh(stiffness_factor=2e-3))
    seen = roll(body, dt, rest=0.0)
    assert max(seen["rotation"]) < np.pi / 2
    assert seen["radius"][-1] > 5 * 0.05
    assert max(seen["strain"]) < 1e-3
    wrong = np.abs(np.subtract(seen["angular_momentum"], seen["impulse"])).max()
    assert wrong > 0.1 * max(seen["impulse"])
