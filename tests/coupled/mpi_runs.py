"""Programs of the tests on several ranks."""

import os
import subprocess
import sys
from pathlib import Path

# An MPI process marks its environment; a new mpirun must not take it for its own.
MARKS = ("OMPI_", "PMIX_", "PRTE_", "ORTE_")
ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def on_ranks(ranks: int, *arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run Python with some arguments under mpirun."""
    clean = {key: value for key, value in os.environ.items() if not key.startswith(MARKS)}
    command = ["mpirun", "-n", str(ranks), "--oversubscribe", sys.executable, *map(str, arguments)]
    return subprocess.run(command, env=clean | ROOT, cwd=cwd, capture_output=True, text=True, timeout=300)
