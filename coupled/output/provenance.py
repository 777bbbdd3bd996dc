"""Who computed this, with what, and how long it took."""

from __future__ import annotations

import json
import os
import platform
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

PACKAGES = ("leito", "numpy", "scipy", "numba", "h5py", "fenics-dolfinx", "petsc4py", "mpi4py", "gmsh")


def write_json(path: Path, content: dict[str, Any]) -> None:
    """Write a dictionary as JSON, in one move."""
    beside = path.with_suffix(".part")
    beside.write_text(json.dumps(content, indent=2) + "\n")
    os.replace(beside, path)


def provenance(*, threads: int, ranks: int, seed: int | None, petsc: dict[str, str]) -> dict[str, Any]:
    """Versions, machine, threads, ranks, seed and the PETSc options of the solvers."""
    return {
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "versions": {name: _version(name) for name in PACKAGES} | {"python": platform.python_version()},
        "machine": {"processor": _processor(), "cores": os.cpu_count(), "system": platform.platform()},
        "threads": threads,
        "ranks": ranks,
        "seed": seed,
        "petsc_options": petsc,
    }


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "")
