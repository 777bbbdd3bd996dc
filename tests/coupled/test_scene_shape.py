"""The boundary that the scene reckons with is the boundary that the mesh has."""

from __future__ import annotations

import numpy as np
import pytest

import meshes
from coupled.scene import Beam, Tube

TUBE = {"outer_radius": 0.05, "inner_radius": 0.04}
BEAM = {"length": 0.5, "height": 0.025}


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(
    ("shape", "build", "sizes", "divisions"),
    [
        (Tube, meshes.tube, TUBE, {"around": 30, "layers": 2}),
        (Tube, meshes.tube, TUBE, {"around": 16, "layers": 1}),
        (Beam, meshes.beam, BEAM, {"along": 40, "across": 2}),
        (Beam, meshes.beam, BEAM, {"along": 7, "across": 3}),
    ],
)
def test_facet_lengths_are_those_of_the_mesh(shape, build, sizes, divisions, order):
    table = shape(**sizes, **divisions, order=order)
    line = build(**sizes, **divisions, order=order).outer_polyline
    ends = line.points[line.facets]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    # gmsh places nodes to about 1e-9 of the size
    assert sorted(table.facet_lengths("outer")) == pytest.approx(sorted(lengths), rel=1e-6)


def test_the_loaded_arc_of_the_sources_tube_is_a_third_of_it():
    """120 of 360 degrees: 10 of 30 facets."""
    assert len(Tube(**TUBE).facet_lengths("loaded_arc")) == 10
