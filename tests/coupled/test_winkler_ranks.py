"""The coupled beam on springs is the same on one rank and on two."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

PROGRAM = """
import sys
import numpy as np
from mpi4py import MPI
from coupled.build import build
from coupled.scene import load_scene

scene = load_scene("winkler_beam", ["structure.loads.0.schedule.over=0.02", *sys.argv[3:]])
model = build(scene).model
model.advance(int(sys.argv[2]))
body = model.structure.energies()  # collective
if MPI.COMM_WORLD.rank == 0:
    energies = [body.kinetic, body.strain, body.rayleigh_loss, body.external_work, body.boundary_work]
    np.savez(
        sys.argv[1], ranks=MPI.COMM_WORLD.size, displacement=model.structure.boundary_displacement,
        reaction=model.reaction, forces=model.nodal_force, energies=energies,
    )
else:
    assert model.particles is None
"""


def run(ranks: int, target: Path, steps: int, *options: str) -> dict[str, np.ndarray]:
    permitted = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    program = [sys.executable, "-c", PROGRAM, str(target), str(steps), *options]
    command = ["mpirun", "-n", str(ranks), "--oversubscribe", *program]
    done = subprocess.run(command, env=os.environ | permitted, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return dict(np.load(target))


# The tolerance is below what is compared: ranks may differ in whether a window needs one more iteration.
WAYS = {"predicted": (2000,), "iterated": (300, "interface.exchange=iterated", "interface.tolerance=1e-10")}


@pytest.mark.parametrize("way", WAYS)
def test_two_ranks_give_the_answer_of_one(tmp_path: Path, way: str) -> None:
    one, two = (run(ranks, tmp_path / f"{ranks}.npz", *WAYS[way]) for ranks in (1, 2))
    assert (one["ranks"], two["ranks"]) == (1, 2)
    for name in ("displacement", "reaction", "forces", "energies"):
        # Another order of sums and another factorisation: round-off, amplified by the steps.
        assert np.abs(two[name] - one[name]).max() <= 1e-9 * np.abs(one[name]).max(), name
