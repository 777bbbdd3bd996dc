"""A coupled scene has one answer: on one rank and on two to 1e-9, with one thread and two to the bit."""

from pathlib import Path

import numpy as np
from mpi_runs import on_ranks

PROGRAM = """
import sys
import numpy as np
from mpi4py import MPI
from coupled.build import build
from coupled.scene import Scene

WAYS = {
    "glued": {"per_facet": 2}, "facets": {"kind": "facets"}, "iterated": {"kind": "facets", "exchange": "iterated"}
}
TABLES = {
    "title": "a tube is driven into grains that fall",
    "gravity": [0.0, -9.81],
    "time": {"duration": 1.0, "step": 4e-5},
    "box": {"width": 0.4, "height": 1.0},
    "grains": {  # enough of them for several blocks, so that threads share them
        "sizes": [{"radius": 2e-3, "count": 1200}, {"radius": 2.4e-3, "count": 1200}],
        "density": 1600.0, "spacing": 1.01, "jitter": 0.5,
    },
    "contact": {
        "normal_stiffness": 1e6, "normal_damping": 60.0, "tangential_stiffness": 5e4, "tangential_damping": 10.0,
        "friction": 0.5, "rolling_friction": 0.2,
    },
    "structure": {
        "kind": "elastic", "youngs_modulus": 1e9, "poissons_ratio": 0.35, "density": 2700.0,
        "tube": {"outer_radius": 0.05, "inner_radius": 0.04, "around": 24},
        "placement": {"x": 0.21, "y": "on_bed"},
        "rayleigh": {"mass_factor": 0.0, "stiffness_factor": 1e-4},
        "loads": [{"kind": "boundary", "boundary": "loaded_arc", "total_force": [300.0, -2000.0]}],
    },
}
out = {}
for way, interface in WAYS.items():
    for theory in ("linear", "corotational"):
        for threads in (1, 2):
            structure = TABLES["structure"] | {"theory": theory}
            scene = Scene.model_validate(TABLES | {"interface": interface, "structure": structure})
            model = build(scene, threads=threads).model
            model.advance(200)
            body = model.structure.energies()  # collective
            if MPI.COMM_WORLD.rank == 0:
                grains = model.particles.grains
                name = f"{way} {theory} {threads} "
                order = np.argsort(grains.number)
                out |= {
                    name + "displacement": model.structure.boundary_displacement,
                    name + "forces": model.nodal_force,
                    name + "reaction": model.reaction,
                    name + "grains": grains.position[order],
                    name + "speeds": np.column_stack([grains.vx, grains.vy])[order],
                    name + "spins": grains.omega[order],
                    name + "energies": [body.kinetic, body.strain, body.rayleigh_loss, body.boundary_work],
                }
            else:
                assert model.particles is None
if MPI.COMM_WORLD.rank == 0:
    np.savez(sys.argv[1], ranks=MPI.COMM_WORLD.size, **out)
"""


def test_ranks_and_threads_give_one_answer(tmp_path: Path) -> None:
    answers = []
    for ranks in (1, 2):
        done = on_ranks(ranks, "-c", PROGRAM, tmp_path / f"{ranks}.npz")
        assert done.returncode == 0, done.stderr
        answers.append(dict(np.load(tmp_path / f"{ranks}.npz")))
    one, two = answers
    assert (one.pop("ranks"), two.pop("ranks")) == (1, 2)
    for name, array in one.items():
        if " 1 " in name:
            for answer in answers:
                np.testing.assert_array_equal(answer[name], answer[name.replace(" 1 ", " 2 ")], err_msg=name)
        # another order of sums in products and solves: round-off, amplified by 200 steps of contacts
        assert np.abs(two[name] - array).max() <= 1e-9 * np.abs(array).max(), name
        if name.endswith("reaction"):
            assert np.abs(array).min() > 1.0, "the tube has reached the grains"
