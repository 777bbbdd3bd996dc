"""Load vectors against statics, stress of the tube against equilibrium of its halves."""

import meshes
import numpy as np
import pytest
from scipy.integrate import simpson
from structure import BodyForce, BoundaryLoad, ElasticStructure, PlaneStrain, PointLoad, Ramp


def test_loads_ramp_and_add_up(soft: PlaneStrain) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04)
    loads = [
        BoundaryLoad(boundary="loaded_arc", total_force=(0.0, -1000.0), schedule=Ramp(over=0.5)),
        PointLoad(point=(0.05, 0.0), force=(7.0, 0.0), schedule=Ramp(over=0.25)),
    ]
    body = ElasticStructure(tube, material=soft, time_step=0.1, loads=loads)
    seen = [body.external_force()]
    for _ in range(8):
        body.advance(np.zeros_like(body.polyline.points))
        seen.append(body.external_force())
    times = 0.1 * np.arange(9)
    np.testing.assert_allclose(np.array(seen)[:, 1], -1000 * np.minimum(times / 0.5, 1), atol=1e-9)
    np.testing.assert_allclose(np.array(seen)[:, 0], 7 * np.minimum(times / 0.25, 1), atol=1e-12)


@pytest.mark.parametrize(("cell", "order"), [("quadrilateral", 1), ("triangle", 2)])
def test_boundary_load_acts_in_the_middle_of_its_arc(cell: str, order: int) -> None:
    """A short stiff body starts as a rigid one: the push turns it as the moment demands."""
    beam = meshes.beam(length=1.0, height=1.0, along=4, across=4, cell=cell, order=order)
    material = PlaneStrain(youngs_modulus=1e12, poissons_ratio=0.3, density=1.0)
    right = BoundaryLoad(boundary="right", total_force=(0.0, 3.0))
    dt = 1e-3
    body = ElasticStructure(beam, material=material, time_step=dt, loads=[right])
    for _ in range(20):
        body.advance(np.zeros_like(body.polyline.points))
    # Inertia of a square of side 1 and mass 1: 1/6; moment 3 x 1/2; half a t^2. The swing of the
    # elastic modes about it, of the size of the static strain 1e-12, is far below.
    time = body.time
    assert body.mean_rotation() == pytest.approx(3 * 0.5 / (1 / 6) * time**2 / 2, rel=1e-4)
    assert body.centroid()[1] - 0.5 == pytest.approx(3 * time**2 / 2, rel=1e-4)


def crushed_tube(cell: str, refinement: int, material: PlaneStrain) -> ElasticStructure:
    """Tube pushed down on its arc by 1000 N/m and lifted as much by a body force, at rest."""
    tube = meshes.tube(
        outer_radius=0.05,
        inner_radius=0.04,
        around=120 * refinement,
        layers=4 * refinement,
        cell=cell,
        order=2,
    )
    push = BoundaryLoad(boundary="loaded_arc", total_force=(0.0, -1000.0))
    mass = ElasticStructure(tube, material=material, time_step=1.0).mass
    lift = BodyForce(acceleration=(0.0, 1000.0 / mass))
    body = ElasticStructure(tube, material=material, time_step=1.0, loads=[push, lift])
    body.set_initial(displacement=body.static_displacement())
    return body


@pytest.mark.parametrize("cell", ["quadrilateral", "triangle"])
def test_tube_walls_carry_the_upper_half(cell: str, aluminium: PlaneStrain) -> None:
    carried = []
    for refinement in (1, 2):
        body = crushed_tube(cell, refinement, aluminium)
        fields = body.fields()
        x, y = fields.points.T
        wall = np.flatnonzero((np.abs(y) < 1e-12) & (x > 0))
        wall = wall[np.argsort(x[wall])]
        yy = fields.point_data["sigma_yy"][wall]
        xx = fields.point_data["sigma_xx"][wall]
        carried.append(-2 * simpson(yy, x=x[wall]))
    # On the upper half: the push, half of the lift, and the two walls, which carry the rest. The
    # nodal averages are of order 2.
    assert carried[1] == pytest.approx(500.0, rel=0.02)
    assert (4 * carried[1] - carried[0]) / 3 == pytest.approx(500.0, rel=2e-3)
    # The free surfaces carry no radial stress: little against the bending stress beside it.
    assert np.abs(xx[[0, -1]]).max() < 0.01 * np.abs(yy).max()
    # Peaks at Gauss points lie inside the cells, below those at the surface and near them.
    highest = fields.point_data["von_mises"].max()
    assert 0.9 * highest < body.peaks().von_mises < 1.01 * highest
    assert abs(body.mean_rotation()) < 1e-12  # symmetric about the vertical
    np.testing.assert_allclose(body.external_force(), 0, atol=1e-9)


def test_fields_name_their_cells() -> None:
    material = PlaneStrain(youngs_modulus=1e6, poissons_ratio=0.3, density=1.0)
    kinds = {
        ("quadrilateral", 1): ("quadrilateral", 4),
        ("quadrilateral", 2): ("quadrilateral9", 9),
        ("triangle", 1): ("triangle", 3),
        ("triangle", 2): ("triangle6", 6),
    }
    for (cell, order), (kind, nodes) in kinds.items():
        beam = meshes.beam(length=1.0, height=0.1, along=2, across=1, cell=cell, order=order)
        fields = ElasticStructure(beam, material=material, time_step=1.0).fields()
        assert (fields.cell_kind, fields.cells.shape[1]) == (kind, nodes)
        assert all(len(array) == len(fields.points) for array in fields.point_data.values())
