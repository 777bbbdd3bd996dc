"""Constant stress and rigid motion are reproduced exactly, on straight and distorted meshes."""

import meshes
import numpy as np
import pytest
from formulations import FORMULATIONS, NAMES, rough_square
from structure import BoundaryLoad, ElasticStructure, PlaneStrain, StructureError

ELEMENTS = [("quadrilateral", 1), ("triangle", 1), ("quadrilateral", 2), ("triangle", 2)]


def uniform_tractions(stress: np.ndarray) -> list[BoundaryLoad]:
    normals = {"bottom": (0, -1), "right": (1, 0), "top": (0, 1), "left": (-1, 0)}
    return [
        BoundaryLoad(boundary=side, total_force=tuple(stress @ np.array(normal, dtype=float)))
        for side, normal in normals.items()
    ]


@pytest.mark.parametrize(("cell", "order", "element", "_"), FORMULATIONS, ids=NAMES)
@pytest.mark.parametrize("shape", ["straight", "curved", "rough"])
def test_patch(cell: str, order: int, element: str, _: int, shape: str, distort) -> None:
    square = meshes.beam(length=1.0, height=1.0, along=4, across=4, cell=cell, order=order)
    if shape == "curved":
        square = distort(square)
    elif shape == "rough":
        square = rough_square(cell, order, 0)
    e, nu = 5.0, 0.3
    material = PlaneStrain(youngs_modulus=e, poissons_ratio=nu, density=1.0)
    xx, yy, xy = 0.3, -0.2, 0.1
    loads = uniform_tractions(np.array([[xx, xy], [xy, yy]]))
    body = ElasticStructure(square, material=material, time_step=1.0, loads=loads, element=element)
    body.set_initial(displacement=body.static_displacement())
    data = body.fields().point_data
    # Plane strain by Hooke's law in three dimensions: eps_zz = 0.
    zz = nu * (xx + yy)
    expected = {
        "sigma_xx": xx,
        "sigma_yy": yy,
        "sigma_xy": xy,
        "sigma_zz": zz,
        "strain_xx": (xx - nu * (yy + zz)) / e,
        "strain_yy": (yy - nu * (xx + zz)) / e,
        "strain_xy": xy * (1 + nu) / e,
        "von_mises": np.sqrt((xx**2 + yy**2 + zz**2) - xx * yy - yy * zz - zz * xx + 3 * xy**2),
    }
    for name, value in expected.items():
        # Direct solve of a system with a condition number of a few hundred, iterated to 1e-13.
        np.testing.assert_allclose(data[name], value, atol=1e-11, err_msg=name)
    peaks = body.peaks()
    assert peaks.von_mises == pytest.approx(expected["von_mises"], rel=1e-10)
    strain = [[expected["strain_xx"], expected["strain_xy"]]]
    strain.append([expected["strain_xy"], expected["strain_yy"]])
    assert peaks.strain == pytest.approx(np.abs(np.linalg.eigvalsh(strain)).max(), rel=1e-10)
    # At rest under its tractions: strain energy is half the work of the tractions, no acceleration.
    density = (xx * strain[0][0] + yy * strain[1][1] + 2 * xy * strain[0][1]) / 2
    assert body.energies().strain == pytest.approx(density, rel=1e-10)
    assert np.abs(body.boundary_acceleration).max() < 1e-9


@pytest.mark.parametrize(("cell", "order", "element", "_"), FORMULATIONS, ids=NAMES)
def test_rigid_motion_makes_no_stress(cell: str, order: int, element: str, _: int, aluminium: PlaneStrain) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, cell=cell, order=order)
    body = ElasticStructure(tube, material=aluminium, time_step=1e-5, element=element)
    x, y = tube.points.T
    moved = np.column_stack([0.1 - 1e-3 * y, -0.2 + 1e-3 * x])
    body.set_initial(displacement=moved)
    # Strains are differences of displacements of 0.2 m over nodes 2 mm apart.
    round_off = 100 * np.finfo(float).eps * 0.2 / 2e-3
    assert body.peaks().strain < round_off
    assert body.peaks().von_mises < 2 * round_off * aluminium.youngs_modulus
    np.testing.assert_allclose(body.centroid(), [0.1, -0.2], atol=1e-12)
    assert body.mean_rotation() == pytest.approx(1e-3, rel=1e-6)  # atan of the linear rotation


def test_mean_rotation_is_exact_for_a_large_turn(aluminium: PlaneStrain) -> None:
    beam = meshes.beam(length=1.0, height=0.1, along=8, origin=(3.0, -1.0))
    body = ElasticStructure(beam, material=aluminium, time_step=1e-5)
    angle = 2.5
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    body.set_initial(displacement=beam.points @ turn.T - beam.points)
    assert body.mean_rotation() == pytest.approx(angle, abs=1e-10)


@pytest.mark.parametrize(("cell", "order"), ELEMENTS)
def test_mass_and_its_centre(cell: str, order: int, aluminium: PlaneStrain) -> None:
    beam = meshes.beam(length=0.5, height=0.025, origin=(1.0, 2.0), cell=cell, order=order)
    body = ElasticStructure(beam, material=aluminium, time_step=1e-5)
    assert body.mass == pytest.approx(2700 * 0.5 * 0.025, rel=1e-12)
    np.testing.assert_allclose(body.centroid(), [1.25, 2.0125], rtol=1e-12)
    # a rigid acceleration needs the force M a, on all nodes; of the boundary's share alone the virtual
    # work is symmetric and positive
    rng = np.random.default_rng(3)
    one, two = rng.normal(size=(2, *body.polyline.points.shape))
    left, right = np.vdot(one, body.acceleration_by(two)), np.vdot(two, body.acceleration_by(one))
    assert left == pytest.approx(right, rel=1e-9)
    assert np.vdot(one, body.acceleration_by(one)) > 0.0


def test_first_acceleration_is_that_of_the_first_step(aluminium: PlaneStrain) -> None:
    """Within a step far below the wave's way through a cell only the mass answers."""
    beam = meshes.beam(length=0.5, height=0.025)
    body = ElasticStructure(beam, material=aluminium, time_step=1e-10)
    force = np.random.default_rng(3).normal(size=body.polyline.points.shape)
    expected = body.acceleration_by(force)
    body.begin_under(force)
    np.testing.assert_allclose(body.boundary_acceleration, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
    body.advance(force)
    np.testing.assert_allclose(body.boundary_velocity, 1e-10 * expected, rtol=1e-5, atol=1e-15 * np.abs(expected).max())


def test_statics_without_balance_is_refused(aluminium: PlaneStrain) -> None:
    beam = meshes.beam(length=1.0, height=0.1, along=4)
    top = BoundaryLoad(boundary="top", total_force=(0.0, -1.0))
    body = ElasticStructure(beam, material=aluminium, time_step=1e-5, loads=[top])
    with pytest.raises(StructureError, match="balance"):
        body.static_displacement()
