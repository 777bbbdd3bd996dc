"""Meshes from arrays and files: the same as the shapes', free of numbering, and refused when unsound."""

from pathlib import Path

import meshes
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from measures import shoelace, tagged_length
from meshes.session import gmsh, session

ELEMENTS = [("quadrilateral", 1), ("triangle", 1), ("quadrilateral", 2), ("triangle", 2)]
CLOCKWISE = {3: [0, 2, 1], 4: [0, 3, 2, 1], 6: [0, 2, 1, 5, 4, 3], 9: [0, 3, 2, 1, 7, 6, 5, 4, 8]}
SQUARE = ([(0, 0), (1, 0), (1, 1), (0, 1)], [[0, 1, 2, 3]])


def corner_edges(mesh: meshes.StructureMesh, name: str) -> np.ndarray:
    """End nodes of the edges of an outer boundary, mid-side nodes left out."""
    nodes = mesh.outer_nodes[mesh.outer_polyline.facets[mesh.outer_polyline.on(name)]]
    return np.column_stack([nodes[:: mesh.order, 0], nodes[mesh.order - 1 :: mesh.order, 1]])


def grid(along: int, across: int) -> tuple[np.ndarray, np.ndarray]:
    """Unit squares from (0, 0), nodes row by row."""
    x, y = np.meshgrid(np.arange(along + 1.0), np.arange(across + 1.0))
    first = (np.arange(across)[:, None] * (along + 1) + np.arange(along)).ravel()
    return np.column_stack([x.ravel(), y.ravel()]), np.column_stack(
        [first, first + 1, first + along + 2, first + along + 1]
    )


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize(("cell", "order"), ELEMENTS)
def test_shape_given_as_arrays_in_another_numbering_is_the_same(cell: str, order: int, clockwise: bool) -> None:
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, centre=(0.3, 0.1), cell=cell, order=order)
    rng = np.random.default_rng(2)
    new = rng.permutation(len(tube.points))
    points = np.empty_like(tube.points)
    points[new] = tube.points
    cells = new[rng.permutation(tube.cells)]
    if clockwise:
        cells = cells[:, CLOCKWISE[cells.shape[1]]]
    loaded = new[rng.permutation(corner_edges(tube, "loaded_arc"))]
    mesh = meshes.from_arrays(points, cells, boundaries={"loaded": loaded[:, ::-1]})
    assert (mesh.cell, mesh.order) == (cell, order)
    np.testing.assert_array_equal(mesh.points, points)
    np.testing.assert_array_equal(np.sort(mesh.cells, axis=1), np.sort(cells, axis=1))
    corners = mesh.points[mesh.cells[:, : 4 if cell == "quadrilateral" else 3]]
    assert min(map(shoelace, corners)) > 0
    assert set(mesh.boundaries) == {"outer", "loaded"}
    for own, other in (("outer", "outer"), ("loaded", "loaded_arc")):
        assert tagged_length(mesh, own) == pytest.approx(tagged_length(tube, other), rel=1e-12)
    # both loops begin at the lowest point
    np.testing.assert_array_equal(mesh.outer_polyline.points, tube.outer_polyline.points)
    np.testing.assert_array_equal(mesh.outer_polyline.facets, tube.outer_polyline.facets)
    np.testing.assert_array_equal(mesh.outer_polyline.on("loaded"), tube.outer_polyline.on("loaded_arc"))
    np.testing.assert_array_equal(mesh.points[mesh.outer_nodes], mesh.outer_polyline.points)
    original = mesh.domain.geometry.input_global_indices
    np.testing.assert_array_equal(mesh.domain.geometry.x[:, :2], mesh.points[original])


def test_holes_are_boundaries_but_not_outer() -> None:
    """A frame of 3 x 3 squares without the middle one; a name may lie on both loops."""
    points, cells = grid(3, 3)
    cells = np.delete(cells, 4, axis=0)
    hole = [[5, 6], [6, 10], [10, 9], [9, 5]]
    mesh = meshes.from_arrays(points, cells, boundaries={"hole": hole[:3], "both": [[9, 5], [0, 1]]})
    for name, length in (("outer", 12.0), ("hole", 3.0), ("both", 2.0)):
        assert tagged_length(mesh, name) == pytest.approx(length, rel=1e-12)
    polyline = mesh.outer_polyline
    assert len(polyline.points) == 12 and shoelace(polyline.points) == pytest.approx(9.0)
    np.testing.assert_array_equal(polyline.points[0], [0.0, 0.0])
    assert polyline.facet_names == ("both", *["outer"] * 11)
    # named in full, the outer loop is the one that is found
    again = meshes.from_arrays(points, cells, boundaries={"outer": mesh.outer_nodes[polyline.facets]})
    np.testing.assert_array_equal(again.outer_polyline.points, polyline.points)
    assert set(again.boundaries) == {"outer"}


def plate(path: Path, cell: str, order: int, version: float) -> None:
    """A rectangle 2 x 1 with a round hole, free mesh; in files of version 4.1 the circle's centre is a node as well."""
    with session():
        geo = gmsh.model.geo
        corners = [geo.addPoint(x, y, 0.0, 0.2) for x, y in ((0, 0), (2, 0), (2, 1), (0, 1))]
        middle, *ring = (geo.addPoint(x, 0.5, 0.0, 0.1) for x in (1.0, 0.8, 1.2))
        sides = [geo.addLine(corners[k], corners[(k + 1) % 4]) for k in range(4)]
        arcs = [geo.addCircleArc(ring[k], middle, ring[1 - k]) for k in range(2)]
        surface = geo.addPlaneSurface([geo.addCurveLoop(sides), geo.addCurveLoop(arcs)])
        geo.synchronize()
        for name, curves in (("foot", sides[:1]), ("hole", arcs)):
            gmsh.model.setPhysicalName(1, gmsh.model.addPhysicalGroup(1, curves), name)
        gmsh.model.addPhysicalGroup(2, [surface])
        gmsh.option.setNumber("Mesh.SaveAll", float(version > 4))
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        if cell == "quadrilateral":
            gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 0)
            gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 1)  # quadrilaterals only
            gmsh.model.geo.mesh.setRecombine(2, surface)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        gmsh.write(str(path))


@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.parametrize(("cell", "order"), ELEMENTS)
def test_file_of_gmsh(cell: str, order: int, version: float, tmp_path: Path) -> None:
    plate(tmp_path / "plate.msh", cell, order, version)
    mesh = meshes.from_gmsh(tmp_path / "plate.msh")
    assert (mesh.cell, mesh.order) == (cell, order)
    np.testing.assert_array_equal(np.unique(mesh.cells), np.arange(len(mesh.points)))
    assert tagged_length(mesh, "outer") == pytest.approx(6.0, rel=1e-12)
    assert tagged_length(mesh, "foot") == pytest.approx(2.0, rel=1e-12)
    # chords, or parabolas, over arcs of about 0.1/0.2 rad
    short = {1: 0.5**2 / 24, 2: 0.5**4 / 2000}[order]
    assert tagged_length(mesh, "hole") == pytest.approx(2 * np.pi * 0.2, rel=2 * short)
    assert shoelace(mesh.outer_polyline.points) == pytest.approx(2.0, rel=1e-12)
    np.testing.assert_array_equal(mesh.outer_polyline.points[0], [0.0, 0.0])
    feet = mesh.outer_polyline.points[mesh.outer_polyline.facets[mesh.outer_polyline.on("foot")]]
    assert np.abs(feet[..., 1]).max() == 0.0


@settings(max_examples=60, deadline=None)
@given(moves=arrays(float, (4, 2), elements=st.floats(-1.2, 1.2)))
def test_moved_nodes_are_refused_when_a_cell_turns_over(moves: np.ndarray) -> None:
    """The inner nodes of 3 x 3 squares: sound as long as every corner of every cell turns left."""
    points, cells = grid(3, 3)
    points[[5, 6, 9, 10]] += moves
    corners = points[cells]
    ahead, back = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    turns = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
    if turns.min() > 1e-6:
        assert len(meshes.from_arrays(points, cells).cells) == 9
    elif turns.min() <= 0.0:
        with pytest.raises(meshes.MeshError, match="inverted|folded|no area|same place"):
            meshes.from_arrays(points, cells)


def bow() -> tuple[list, list]:
    """A strip of 13 cells around 390 degrees: sound cells, the ends overlap."""
    angle = np.linspace(0.0, np.radians(390.0), 14)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    ring[-1] *= 1.01  # no two nodes at one place
    ring[-2] *= 1.005
    cells = [[k, k + 14, k + 15, k + 1] for k in range(13)]
    return np.vstack([ring, 1.2 * ring]).tolist(), cells


def spoiled(node: int, place: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    points, cells = grid(2, 2)
    points[node] = place
    return points, cells


def fan(middle: tuple[float, float]) -> tuple[list, list]:
    """A square of four triangles around a node."""
    return [*SQUARE[0], middle], [[k, (k + 1) % 4, 4] for k in range(4)]


def turned_cell() -> tuple[np.ndarray, np.ndarray]:
    points, cells = grid(2, 1)
    cells[1] = cells[1, ::-1]
    return points, cells


def bent_over() -> tuple[list, list]:
    """A triangle of order 2 with the middle of a side behind the opposite corner."""
    return [(0, 0), (1, 0), (0, 1), (0.5, 0.6), (0.5, 0.5), (0, 0.5)], [[0, 1, 2, 3, 4, 5]]


UNSOUND = {
    "points in space": (([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [[0, 1, 2]]), "points of shape (3, 3)"),
    "point not finite": (([(0, 0), (1, 0), (0, np.nan)], [[0, 1, 2]]), "must be finite"),
    "five nodes": (([(0, 0)] * 5, [[0, 1, 2, 3, 4]]), "cells of shape (1, 5)"),
    "serendipity": (([(0, 0)] * 8, [[*range(8)]]), "4 or 9 for quadrilaterals"),
    "no cells": (([(0, 0)], np.zeros((0, 4), int)), "cells of shape (0, 4)"),
    "cells of floats": (([(0, 0), (1, 0), (0, 1)], [[0.0, 1.0, 2.0]]), "must be integers"),
    "numbers from 1": (([(0, 0), (1, 0), (0, 1)], [[1, 2, 3]]), "nodes 1 to 3: there are the points 0 to 2"),
    "point without a cell": (([*SQUARE[0], (3, 4)], SQUARE[1]), "point 4 at (3, 4) belongs to no cell"),
    "two points at one place": (
        ([*SQUARE[0], (1, 0), (2, 0), (2, 1)], [[0, 1, 2, 3], [4, 5, 6, 2]]),
        "points 1 and 4 lie at the same place, (1, 0)",
    ),
    "node across an edge": (fan((0.5, -0.2)), "cell 0 around (0.5, -0.0666667) is inverted"),
    "node far outside": (spoiled(4, (2.5, 2.5)), "is folded"),
    "cell listed the other way": (turned_cell(), "cell 1 around (1.5, 0.5) is inverted"),
    "crossed cell": ((SQUARE[0], [[0, 2, 1, 3]]), "cell 0 around (0.5, 0.5) is folded"),
    "dart": (([(0, 0), (1, 0), (0.2, 0.2), (0, 1)], SQUARE[1]), "is folded"),
    "corner of 180 degrees": (([(0, 0), (1, 0), (0.5, 0.5), (0, 1)], SQUARE[1]), "is folded"),
    "bent over": (bent_over(), "is folded"),
    "flat": (([(0, 0), (1, 1), (2, 2)], [[0, 1, 2]]), "has no area"),
    "node used twice": (([(0, 0), (1, 0), (0, 1)], [[0, 1, 2, 2]]), "is folded"),
    "same cell twice": ((SQUARE[0], [[0, 1, 2, 3], [1, 2, 3, 0]]), "two cells lie on the same side"),
    "two pieces": (
        ([*SQUARE[0], (2, 0), (3, 0), (3, 1), (2, 1)], [[0, 1, 2, 3], [4, 5, 6, 7]]),
        "in 2 pieces, of which one holds cell 1 around (2.5, 0.5)",
    ),
    "hanging node": (
        ([(0, 0), (2, 0), (2, 2), (0, 2), (3, 0), (3, 1), (2, 1), (3, 2)], [[0, 1, 2, 3], [1, 4, 5, 6], [6, 5, 7, 2]]),
        "in 2 pieces",
    ),
    "boundary across itself": (bow(), "crosses or touches itself"),
}


@pytest.mark.parametrize("case", UNSOUND)
def test_unsound_arrays_are_refused(case: str) -> None:
    (points, cells), words = UNSOUND[case]
    with pytest.raises(meshes.MeshError) as refusal:
        meshes.from_arrays(points, cells)
    assert words in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_boundary_that_touches_itself_is_refused() -> None:
    points, cells = grid(4, 4)
    cells = np.delete(cells, [5, 10], axis=0)  # two holes with a corner in common
    with pytest.raises(meshes.MeshError, match=r"touches itself at \(2, 2\)"):
        meshes.from_arrays(points, cells)


def test_cells_of_several_kinds_are_refused() -> None:
    points = [*SQUARE[0], [2.0, 0.5]]
    with pytest.raises(meshes.MeshError, match="cells must be numbers in rows of one length"):
        meshes.from_arrays(points, [[0, 1, 2, 3], [1, 4, 2]])


@pytest.mark.parametrize("names", [("outer", "top"), ("top", "outer")])
def test_the_whole_outer_loop_may_be_named_beside_its_pieces(names: tuple[str, str]) -> None:
    edges = {"outer": [[0, 1], [1, 2], [2, 3], [3, 0]], "top": [[2, 3]]}
    mesh = meshes.from_arrays(*SQUARE, boundaries={name: edges[name] for name in names})
    assert tagged_length(mesh, "outer") == pytest.approx(4.0)
    assert tagged_length(mesh, "top") == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("boundaries", "words"),
    [
        ({"top": [[0, 2]]}, "boundary 'top' has the edge (0, 2)"),
        ({"top": [[2, 3]], "lid": [[3, 2]]}, "on 'top' and on 'lid'"),
        ({"top": [2, 3]}, "boundary 'top' of shape (2,)"),
        ({"top": []}, "boundary 'top' of shape (0,)"),
        ({"top": [[2.0, 3.0]]}, "boundary 'top'"),
        ({"outer": [[2, 3]]}, "not the whole outer loop of 4"),
        ({"top": [[2, 3], [3]]}, "boundary 'top' must be numbers in rows of one length"),
        ({3: [[2, 3]]}, "boundary 3 must have a name"),
    ],
)
def test_boundaries_that_do_not_fit_are_refused(boundaries: dict, words: str) -> None:
    with pytest.raises(meshes.MeshError) as refusal:
        meshes.from_arrays(*SQUARE, boundaries=boundaries)
    assert words in str(refusal.value)


def test_files_that_are_no_mesh_are_refused(tmp_path: Path) -> None:
    with pytest.raises(meshes.MeshError, match="is no file"):
        meshes.from_gmsh(tmp_path / "absent.msh")
    (tmp_path / "words.msh").write_text("no mesh at all")
    with pytest.raises(meshes.MeshError, match="words.msh"):
        meshes.from_gmsh(tmp_path / "words.msh")
    for name, places, kinds, words in (
        ("mixed", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)], {3: [1, 2, 3, 4], 2: [2, 5, 3]}, "kinds"),
        ("bent", [(0, 0, 0), (1, 0, 0), (1, 1, 0.1), (0, 1, 0)], {3: [1, 2, 3, 4]}, "is not plane"),
    ):
        with session():
            gmsh.model.addDiscreteEntity(2, 1)
            gmsh.model.mesh.addNodes(2, 1, range(1, len(places) + 1), np.ravel(places))
            for kind, nodes in kinds.items():
                gmsh.model.mesh.addElementsByType(1, kind, [], nodes)
            gmsh.write(str(tmp_path / f"{name}.msh"))
        with pytest.raises(meshes.MeshError, match=words):
            meshes.from_gmsh(tmp_path / f"{name}.msh")
