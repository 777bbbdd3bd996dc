"""Large strain and large deflection against closed forms and the elastica; the other theories beside them."""

import numpy as np
import pytest
from moving import quarter, turned
from scipy.integrate import solve_bvp

import meshes
from structure import ElasticStructure, PlaneStrain, PointLoad, Ramp, Rayleigh


def square(order: int, cell: str) -> meshes.StructureMesh:
    return meshes.beam(length=1.0, height=1.0, along=2, across=2, order=order, cell=cell, origin=(-0.5, -0.5))


def edge_forces(mesh: meshes.StructureMesh, nominal: np.ndarray) -> np.ndarray:
    """Nodal forces (n_b, 2) [N/m] on the outer nodes of the unit square for the traction P N, by exact rules."""
    points = mesh.outer_polyline.points
    force = np.zeros_like(points)
    per_side = 2 * mesh.order  # intervals between nodes of a side
    simpson = {1: np.array([1, 1]) / 2, 2: np.array([1, 4, 1]) / 6}[mesh.order]
    weights = np.zeros(per_side + 1)
    for begin in range(0, per_side, mesh.order):
        weights[begin : begin + mesh.order + 1] += simpson * mesh.order / per_side
    for normal in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)):
        on = np.flatnonzero(np.abs(points @ normal - 0.5) < 1e-9)
        along = np.argsort(points[on] @ quarter(np.array([normal]))[0])
        force[on[along]] += np.outer(weights, nominal @ normal)
    return force


@pytest.mark.parametrize(("cell", "order"), [("quadrilateral", 1), ("quadrilateral", 2), ("triangle", 2)])
@pytest.mark.parametrize(("stretch", "angle"), [(1.5, 0.0), (0.7, 0.0), (1.3, 2.5)])
def test_homogeneous_stretch_in_closed_form(
    cell: str, order: int, stretch: float, angle: float, soft: PlaneStrain
) -> None:
    """Stretched along x and then turned, under its own tractions a square is at rest.

    Uniaxial stretch s: ``S_xx = (lam + 2 mu)(s^2 - 1)/2``, ``S_yy = lam (s^2 - 1)/2``, hence the stress
    ``s S_xx`` along the stretched axis, ``S_yy/s`` across, and energy ``(lam + 2 mu)(s^2 - 1)^2/8`` per area.
    """
    mesh = square(order, cell)
    lam, mu = soft.lame
    half = (stretch**2 - 1) / 2
    second = np.diag([lam + 2 * mu, lam]) * half
    rotation = turned(np.eye(2), angle).T  # columns are the turned axes
    nominal = rotation @ np.diag([stretch, 1.0]) @ second
    body = ElasticStructure(mesh, material=soft, time_step=1e-4, theory="large_strain")
    displacement = turned(mesh.points * [stretch, 1.0], angle) - mesh.points
    body.set_initial(displacement=displacement, boundary_force=edge_forces(mesh, nominal))
    # At rest: what is left of forces of 1e7 N/m on a mass of 2700 kg/m.
    assert np.abs(body.boundary_acceleration).max() < 1e-9 * np.abs(nominal).max() / 2700.0
    cauchy = rotation @ np.diag([stretch * second[0, 0], second[1, 1] / stretch]) @ rotation.T
    logarithm = rotation @ np.diag([np.log(stretch), 0.0]) @ rotation.T
    data = body.fields().point_data
    for i, j, name in ((0, 0, "xx"), (1, 1, "yy"), (0, 1, "xy")):
        np.testing.assert_allclose(data[f"sigma_{name}"], cauchy[i, j], atol=1e-9 * np.abs(cauchy).max())
        np.testing.assert_allclose(data[f"strain_{name}"], logarithm[i, j], atol=1e-12)
    np.testing.assert_allclose(data["sigma_zz"], lam * half / stretch, rtol=1e-9)
    assert body.energies().strain == pytest.approx((lam + 2 * mu) * (stretch**2 - 1) ** 2 / 8, rel=1e-12)
    assert body.peaks().strain == pytest.approx(abs(np.log(stretch)), rel=1e-12)
    assert body.peaks().compression == pytest.approx(max(0.0, 1.0 - stretch), abs=1e-12)


HALF, THICKNESS = 1.0, 0.04  # length [m] of each arm, thickness [m]


def elastica_tip(load: float) -> tuple[float, float]:
    """Tip (x, y) over the length of a clamped elastica under a dead tip load ``P L^2/(E I)`` across it.

    ``t'' = -p cos t``, t(0) = 0, t'(1) = 0, integrated by scipy; p = 1 gives y = 0.3017, p = 5 0.7138
    (Bisshopp and Drucker 1945).
    """
    s = np.linspace(0.0, 1.0, 101)
    found = solve_bvp(
        lambda s, y: [y[1], -load * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])],
        lambda a, b: np.array([a[0], b[1], a[2], a[3]]),
        s,
        np.array([load * (s - s**2 / 2) / (1 + load / 2), load * (1 - s) / (1 + load / 2), s, 0 * s]),
        tol=1e-9,
    )
    assert found.success
    return float(found.y[2, -1]), float(found.y[3, -1])


def bent_tip(theory: str, load: float) -> tuple[float, float]:
    """Tip over the arm's length of a free beam pulled up at its ends and down in its middle, come to rest."""
    material = PlaneStrain(youngs_modulus=1e7, poissons_ratio=0.0, density=1000.0)
    mesh = meshes.beam(length=2 * HALF, height=THICKNESS, along=40, across=1, order=2, origin=(-HALF, -THICKNESS / 2))
    tip = load * material.youngs_modulus * THICKNESS**3 / 12 / HALF**2
    loads = [
        PointLoad(point=(x, 0.0), force=(0.0, force), schedule=Ramp(over=0.5))
        for x, force in ((-HALF, tip), (0.0, -2 * tip), (HALF, tip))
    ]
    slowest = 2 * np.pi * ElasticStructure(mesh, material=material, time_step=1.0).frequencies(1)[0]
    damping = Rayleigh(mass_factor=2 * slowest)
    body = ElasticStructure(
        mesh, material=material, time_step=0.02, theory=theory, damping=damping, loads=loads, element="standard"
    )
    silent = np.zeros_like(body.polyline.points)
    for _ in range(150):
        body.advance(silent)
    e = body.energies()
    assert e.kinetic < 1e-8 * e.strain  # at rest
    places = mesh.points + body.fields().point_data["displacement"]
    at = [int(np.argmin(np.hypot(*(mesh.points - [x, 0.0]).T))) for x in (0.0, HALF)]
    middle, end = places[at]
    return tuple((end - middle) / HALF)


@pytest.mark.parametrize("load", [1.0, 3.0])
def test_beam_bends_into_the_elastica(load: float) -> None:
    expected = elastica_tip(load)
    # Shear and stretch of the elastica's own neglect: (thickness/length)^2 and the load's strain, 0.1 %;
    # 20 cells of order 2 per arm and what the load's cell gives way: 0.3 %.
    np.testing.assert_allclose(bent_tip("large_strain", load), expected, atol=0.005)


def test_one_frame_does_not_follow_large_bending() -> None:
    """The corotational theory's limit: its frame does not turn here, and the arms grow as in the linear one."""
    expected = elastica_tip(3.0)
    tips = {theory: bent_tip(theory, 3.0) for theory in ("linear", "corotational")}
    # p/3 and no way inwards: the closed form of the linear cantilever.
    np.testing.assert_allclose(tips["linear"], (1.0, 1.0), atol=0.01)
    np.testing.assert_allclose(tips["corotational"], tips["linear"], atol=1e-6)
    assert tips["corotational"][1] > 1.5 * expected[1]
