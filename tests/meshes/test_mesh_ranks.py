"""The plain arrays of a mesh do not depend on the number of ranks."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

SCRIPT = """
import sys
import meshes, numpy as np
tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, order=2)
beam = meshes.beam(length=1.0, height=0.05, cell="triangle")
rank = tube.domain.comm.rank
given = meshes.from_arrays(beam.points, beam.cells, boundaries={"foot": beam.outer_nodes[beam.outer_polyline.facets[:9]]})
for refused in (lambda: meshes.from_gmsh("absent.msh"), lambda: meshes.from_arrays(beam.points, beam.cells[:1])):
    try:                                        # on every rank: one alone would leave the other waiting
        refused()
    except meshes.MeshError:
        continue
    raise AssertionError("an unsound mesh is taken")
arrays = {}
for name, mesh in (("tube", tube), ("beam", beam), ("given", given)):
    line = mesh.outer_polyline
    arrays |= {name + key: value for key, value in (
        ("points", mesh.points), ("cells", mesh.cells), ("line", line.points),
        ("facets", line.facets), ("names", np.array(line.facet_names)))}
np.savez(f"{sys.argv[1]}_{rank}.npz", **arrays)
"""


@pytest.mark.parametrize("ranks", [2])
def test_same_arrays_on_every_rank(ranks: int, tmp_path: Path) -> None:
    # An MPI process marks its environment; a new mpirun must not take it for its own.
    marks = ("OMPI_", "PMIX_", "PRTE_", "ORTE_")
    clean = {key: value for key, value in os.environ.items() if not key.startswith(marks)}
    run = [sys.executable, "-c", SCRIPT]
    subprocess.run([*run, str(tmp_path / "serial")], check=True, env=clean, timeout=300)
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)]
    subprocess.run([*mpirun, *run, str(tmp_path / "parallel")], check=True, env=clean, timeout=300)
    serial = np.load(tmp_path / "serial_0.npz")
    for rank in range(ranks):
        parallel = np.load(tmp_path / f"parallel_{rank}.npz")
        assert set(parallel) == set(serial)
        for name in serial:
            np.testing.assert_array_equal(parallel[name], serial[name], err_msg=name)
