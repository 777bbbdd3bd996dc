"""Glued grains: one operator carries motion to the grains, its transpose carries forces back."""

import numpy as np
import pytest

import meshes
from coupled.errors import LeitoError
from coupled.interface.glued import GluedGrains
from coupled.scene import load_scene
from meshes import StructureMesh

EPS = np.finfo(float).eps
SHAPES = {
    "beam": lambda: meshes.beam(length=1.0, height=0.1, along=10, across=2),
    "tube": lambda: meshes.tube(outer_radius=0.05, inner_radius=0.04),
    "quadratic": lambda: meshes.beam(length=1.0, height=0.1, along=5, across=1, order=2),
    "triangles": lambda: meshes.tube(outer_radius=0.05, inner_radius=0.04, cell="triangle"),
}


@pytest.fixture(scope="module", params=list(SHAPES))
def mesh(request: pytest.FixtureRequest) -> StructureMesh:
    return SHAPES[request.param]()


@pytest.fixture(params=[1, 3, 6])
def glued(mesh: StructureMesh, request: pytest.FixtureRequest) -> GluedGrains:
    return GluedGrains(mesh.outer_polyline, per_facet=request.param)


def test_weights_are_shares_of_one(glued: GluedGrains) -> None:
    weights = glued.operator.toarray()
    assert np.all(weights >= 0.0) and np.all((weights > 0).sum(axis=1) <= 2)
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, rtol=4 * EPS)


def test_virtual_work_of_forces_and_motion_agrees(glued: GluedGrains) -> None:
    random = np.random.default_rng(1)
    force, motion = random.normal(size=(len(glued), 2)), random.normal(size=(glued.operator.shape[1], 2))
    received = np.vdot(glued.nodal_forces(force), motion)
    terms = force * (glued.places(motion) - glued.reference)
    # The two sums run over the same products in another order.
    assert abs(received - terms.sum()) <= 4 * len(glued) * EPS * np.abs(terms).sum()


def test_resultant_force_and_moment_pass_to_the_nodes(glued: GluedGrains) -> None:
    """A force at a point of a straight facet, split by its lever, keeps its moment as well."""
    force = np.random.default_rng(2).normal(size=(len(glued), 2))
    nodal, nodes, places = glued.nodal_forces(force), glued.polyline.points, glued.reference
    round_off = 8 * len(glued) * EPS * np.abs(force).sum()
    assert np.abs(nodal.sum(axis=0) - force.sum(axis=0)).max() <= round_off
    moment = np.sum(places[:, 0] * force[:, 1] - places[:, 1] * force[:, 0])
    assert abs(np.sum(nodes[:, 0] * nodal[:, 1] - nodes[:, 1] * nodal[:, 0]) - moment) <= round_off


def test_grains_follow_a_turn_of_the_body(glued: GluedGrains) -> None:
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    moved = glued.polyline.points @ turn.T + [0.3, -0.2]
    expected = glued.reference @ turn.T + [0.3, -0.2]
    np.testing.assert_allclose(glued.places(moved - glued.polyline.points), expected, atol=8 * EPS)


def test_neighbours_are_equally_spaced_on_a_facet_and_just_touch(glued: GluedGrains) -> None:
    start, end = glued.polyline.points[glued.polyline.facets].transpose(1, 0, 2)
    per_facet = len(glued) // len(start)
    fractions = np.arange(per_facet) / per_facet
    expected = start[:, None] + fractions[None, :, None] * (end - start)[:, None]
    np.testing.assert_allclose(glued.reference, expected.reshape(-1, 2), atol=8 * EPS)
    gaps = np.hypot(*(np.roll(glued.reference, -1, axis=0) - glued.reference).T) - 2 * glued.radius
    assert abs(gaps.min()) <= 8 * EPS


def test_open_boundary_has_a_grain_at_both_ends_and_a_closed_one_no_double() -> None:
    line = SHAPES["beam"]().outer_polyline
    assert len(GluedGrains(line, per_facet=3)) == 3 * 24
    bottom = GluedGrains(line, per_facet=3, boundaries=("bottom",))
    assert len(bottom) == 3 * 10 + 1
    np.testing.assert_allclose(np.sort(bottom.reference[:, 0]), np.linspace(0, 1, 31), atol=4 * EPS)
    assert np.all(bottom.reference[:, 1] == 0.0)
    corner = GluedGrains(line, per_facet=3, boundaries=("bottom", "right"))
    assert len(corner) == 3 * 12 + 1


@pytest.mark.parametrize(("scene", "count"), [("elastic_tube", 180), ("elastic_beam", 588), ("winkler_beam", 121)])
def test_scenes_of_the_source_carry_its_number_of_glued_grains(scene: str, count: int) -> None:
    table = load_scene(scene)
    shape = table.structure.shape
    mesh = (
        meshes.tube(outer_radius=shape.outer_radius, inner_radius=shape.inner_radius, around=shape.around)
        if scene == "elastic_tube"
        else meshes.beam(length=shape.length, height=shape.height, along=shape.along, across=shape.across)
    )
    glued = GluedGrains(
        mesh.outer_polyline,
        per_facet=table.interface.grains_per_facet(shape),
        boundaries=table.interface.boundaries,
        diameter=table.interface.diameter,
    )
    assert len(glued) == count


def test_mean_velocity_is_that_of_the_two_nodes_of_the_facet() -> None:
    line = SHAPES["beam"]().outer_polyline
    glued = GluedGrains(line, per_facet=2, mean_velocity=True)
    velocity = np.random.default_rng(3).normal(size=line.points.shape)
    mean = velocity[line.facets].mean(axis=1)
    np.testing.assert_allclose(glued.velocities(velocity), np.repeat(mean, 2, axis=0), rtol=4 * EPS)
    assert GluedGrains(line, per_facet=2).velocities(velocity) is None


def test_grains_that_would_overlap_are_refused() -> None:
    line = SHAPES["beam"]().outer_polyline
    assert len(GluedGrains(line, per_facet=2, diameter=0.05 / 2)) == 48
    with pytest.raises(LeitoError, match="smallest spacing 0.025 m.*smaller diameter or fewer per facet"):
        GluedGrains(line, per_facet=2, diameter=0.03)
