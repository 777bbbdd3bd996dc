"""How many processes mpirun has started, asked without loading MPI."""

from __future__ import annotations

import os

_RANK = ("OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK")
_RANKS = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE")


def ranks() -> int:
    """Number of processes that were started together; 1 without mpirun."""
    return max(int(os.environ.get(name, "1")) for name in _RANKS)


def first_rank() -> bool:
    """Whether this process is the first of them."""
    return all(os.environ.get(name, "0") == "0" for name in _RANK)
