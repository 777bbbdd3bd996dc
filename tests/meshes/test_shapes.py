"""Shapes: counts, lengths and areas against closed forms, and refusals."""

import signal

import meshes
import numpy as np
import pytest
from measures import shoelace, tagged_length

ELEMENTS = [("quadrilateral", 1), ("triangle", 1), ("quadrilateral", 2), ("triangle", 2)]
ROUND_OFF = 1e-12  # some hundred additions of lengths known to eps


@pytest.mark.parametrize(("cell", "order"), ELEMENTS)
def test_beam_counts_and_lengths(cell: str, order: int) -> None:
    beam = meshes.beam(length=1.0, height=0.05, origin=(-0.5, 2.0), cell=cell, order=order)
    assert len(beam.points) == (40 * order + 1) * (2 * order + 1)
    assert len(beam.cells) == (80 if cell == "quadrilateral" else 160)
    assert set(beam.boundaries) == {"outer", "bottom", "right", "top", "left"}
    expected = {"bottom": 1.0, "top": 1.0, "left": 0.05, "right": 0.05, "outer": 2.1}
    for name, length in expected.items():
        assert tagged_length(beam, name) == pytest.approx(length, rel=ROUND_OFF)
    np.testing.assert_array_equal(beam.outer_polyline.points[0], [-0.5, 2.0])
    assert shoelace(beam.outer_polyline.points) == pytest.approx(0.05, rel=ROUND_OFF)


@pytest.mark.parametrize("cell", ["quadrilateral", "triangle"])
def test_straight_tube_lengths_are_those_of_its_polygon(cell: str) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, cell=cell)
    assert len(tube.points) == 90
    chord = 2 * np.sin(np.pi / 30)
    expected = {"outer": 30 * 0.05, "inner": 30 * 0.04, "loaded_arc": 10 * 0.05}
    for name, factor in expected.items():
        assert tagged_length(tube, name) == pytest.approx(factor * chord, rel=ROUND_OFF)


@pytest.mark.parametrize("cell", ["quadrilateral", "triangle"])
def test_curved_tube_lengths_are_those_of_the_circle(cell: str) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, cell=cell, order=2)
    assert len(tube.points) == 300
    # A parabola through three points of an arc of 12 degrees misses its length by 2e-6.
    assert tagged_length(tube, "outer") == pytest.approx(2 * np.pi * 0.05, rel=1e-5)
    assert tagged_length(tube, "loaded_arc") == pytest.approx(2 * np.pi * 0.05 / 3, rel=1e-5)


@pytest.mark.parametrize(("cell", "order"), ELEMENTS)
@pytest.mark.parametrize("shape", ["beam", "tube"])
def test_polyline_is_one_closed_counter_clockwise_loop(shape: str, cell: str, order: int) -> None:
    if shape == "beam":
        mesh = meshes.beam(length=0.5, height=0.025, along=10, cell=cell, order=order)
    else:
        mesh = meshes.tube(outer_radius=0.05, inner_radius=0.04, centre=(0.6, 0.3), cell=cell, order=order)
        np.testing.assert_allclose(mesh.outer_polyline.points[0], [0.6, 0.25], atol=1e-16)
    polyline = mesh.outer_polyline
    count = len(polyline.points)
    assert polyline.closed and len(polyline.facets) == len(polyline.facet_names) == count
    assert count == order * (24 if shape == "beam" else 30)
    np.testing.assert_array_equal(polyline.facets[:, 0], np.arange(count))
    np.testing.assert_array_equal(polyline.facets[:-1, 1], polyline.facets[1:, 0])
    assert polyline.facets[-1, 1] == 0
    assert len(np.unique(polyline.points.round(12), axis=0)) == count
    assert shoelace(polyline.points) > 0
    np.testing.assert_array_equal(mesh.points[mesh.outer_nodes], polyline.points)
    # Equal facets along each side, and around the circle.
    for name in set(polyline.facet_names):
        assert np.ptp(polyline.lengths()[polyline.on(name)]) < 1e-15
    assert polyline.on("outer").all()


@pytest.mark.parametrize("around", [12, 29, 30, 31, 180])
def test_loaded_arc_is_symmetric_about_the_top(around: int) -> None:
    polyline = meshes.tube(outer_radius=1.0, inner_radius=0.5, around=around).outer_polyline
    loaded = polyline.on("loaded_arc")
    middle = polyline.points[polyline.facets].mean(axis=1)[loaded]
    assert abs(middle[:, 0].sum()) < 1e-12
    assert abs(loaded.sum() * 360 / around - 120) <= 360 / around
    assert (middle[:, 1] > 0.3).all()


@pytest.mark.parametrize(("cell", "order"), ELEMENTS)
def test_cells_and_nodes_agree_with_the_mesh(cell: str, order: int) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, cell=cell, order=order)
    np.testing.assert_array_equal(np.unique(tube.cells), np.arange(len(tube.points)))
    corners = tube.points[tube.cells[:, : 4 if cell == "quadrilateral" else 3]]
    areas = [shoelace(corner) for corner in corners]
    polygon = 30 * np.sin(2 * np.pi / 30) / 2 * (0.05**2 - 0.04**2)
    assert min(areas) > 0 and sum(areas) == pytest.approx(polygon, rel=ROUND_OFF)
    original = tube.domain.geometry.input_global_indices
    np.testing.assert_array_equal(tube.domain.geometry.x[:, :2], tube.points[original])


def test_interrupt_handler_survives_the_mesher() -> None:
    def handler(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, handler)
    try:
        meshes.beam(length=1.0, height=0.1, along=2)
        assert signal.getsignal(signal.SIGINT) is handler
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: meshes.tube(outer_radius=0.04, inner_radius=0.04), "inner_radius = 0.04"),
        (lambda: meshes.tube(outer_radius=-1.0, inner_radius=0.04), "outer_radius = -1.0"),
        (lambda: meshes.tube(outer_radius=0.05, inner_radius=0.0), "inner_radius = 0.0"),
        (lambda: meshes.tube(outer_radius=0.05, inner_radius=0.04, around=4), "around = 4"),
        (lambda: meshes.tube(outer_radius=0.05, inner_radius=0.04, layers=0), "layers = 0"),
        (
            lambda: meshes.tube(outer_radius=0.05, inner_radius=0.04, loaded_arc_degrees=360.0),
            "loaded_arc_degrees = 360.0",
        ),
        (lambda: meshes.beam(length=0.0, height=0.1), "length = 0.0"),
        (lambda: meshes.beam(length=1.0, height=0.0), "height = 0.0"),
        (lambda: meshes.beam(length=1.0, height=float("nan")), "height = nan"),
        (lambda: meshes.beam(length=1.0, height=0.1, along=2.5), "along = 2.5"),
        (lambda: meshes.beam(length=1.0, height=0.1, cell="hexagon"), "cell = 'hexagon'"),
        (lambda: meshes.beam(length=1.0, height=0.1, order=3), "order = 3"),
        (lambda: meshes.beam(length=1.0, height=0.1, origin=(0.0,)), "origin = (0.0,)"),
        (
            lambda: meshes.beam(length=1.0, height=0.1, along=2).outer_polyline.on("inner"),
            "boundary 'inner'",
        ),
    ],
)
def test_bad_numbers_are_refused_by_name(build, words: str) -> None:
    with pytest.raises(meshes.MeshError) as refusal:
        build()
    assert words in str(refusal.value)
    assert "\n" not in str(refusal.value)
