"""The doors between the rooms: the import contracts hold, and the particles need no FEniCSx."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]

BLOCKED_RUN = """
import sys

class Blocked:
    names = {"dolfinx", "ufl", "petsc4py", "slepc4py", "gmsh", "mpi4py", "meshes", "structure", "coupled"}

    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in self.names:
            raise ImportError(name + " is blocked")

sys.meta_path.insert(0, Blocked())
import particles
import particles.beds, particles.contact.recipe, particles.timestep
grains = particles.lattice([(1e-3, 10)], 1600.0, width=0.02)
assert len(grains) == 10
assert not Blocked.names & {name.split(".")[0] for name in sys.modules}
"""


def test_import_contracts_hold() -> None:
    lint = Path(sys.executable).with_name("lint-imports")
    result = subprocess.run(
        [str(lint), "--config", "pyproject.toml", "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stdout + result.stderr


def test_particles_run_without_fenicsx() -> None:
    result = subprocess.run([sys.executable, "-c", BLOCKED_RUN], cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
