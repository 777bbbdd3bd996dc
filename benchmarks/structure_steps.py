"""Cost of a step of the structure against unknowns and ranks, ours beside bare dolfinx: a process for each size."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

SIZES = (100, 1000, 10_000, 100_000)
WEAK_SHARE = 50_000  # unknowns per rank
MILLION = 1_000_000
LARGE = 1_000  # from here on the step is arithmetic; below, calls
HERE = Path(__file__).parent
Row = dict[str, Any]
Numbers = dict[str, float | None]


class Rows:
    """All cases measured so far."""

    def __init__(self) -> None:
        self.rows: list[Row] = []

    def case(self, unknowns: int, ranks: int) -> Row:
        """Measure one size."""
        row = run_case(unknowns, ranks)
        self.rows.append(row)
        return row


def run_case(unknowns: int, ranks: int) -> Row:
    """A process of its own, or one for each rank; BLAS on one thread."""
    environment = os.environ | {"OMP_NUM_THREADS": "1", "PYTHONPATH": str(HERE.parent)}
    command = [sys.executable, str(HERE / "structure_case.py"), str(unknowns)]
    if ranks > 1:
        command = ["mpirun", "--allow-run-as-root", "-n", str(ranks), *command]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment)
    row: Row = json.loads(done.stdout.strip().splitlines()[-1])
    return row


def steps(rows: Rows) -> Numbers:
    """All sizes on one rank and on two, and twice the size on two ranks."""
    ranks = (1, 2) if len(os.sched_getaffinity(0)) > 1 else (1,)
    found = {(size, k): rows.case(size, k) for size in SIZES for k in ranks}
    alone = [found[size, 1] for size in SIZES]
    large = [row for row in alone if row["unknowns"] >= LARGE]
    numbers: Numbers = {
        "structure_overhead": max(overhead(row) for row in large),
        "structure_ledger": max(row["step_seconds"] / row["lean_step_seconds"] - 1.0 for row in large),
    }
    if len(ranks) > 1:
        numbers["structure_strong_100k"] = _speedup(found[SIZES[-1], 1], found[SIZES[-1], 2])
        numbers["structure_weak_50k"] = _speedup(rows.case(WEAK_SHARE, 1), rows.case(2 * WEAK_SHARE, 2))
    return numbers


def million(rows: Rows) -> Numbers:
    """A million unknowns, whose factorisation takes most of three minutes."""
    alone = rows.case(MILLION, 1)
    numbers: Numbers = {"structure_overhead_1e6": overhead(alone)}
    if len(os.sched_getaffinity(0)) > 1:
        numbers["structure_strong_1e6"] = _speedup(alone, rows.case(MILLION, 2))
    return numbers


def overhead(row: Row) -> float:
    """What our step without ledger costs more than the bare one, which has none, over the latter."""
    return row["lean_step_seconds"] / row["bare_step_seconds"] - 1.0


def _speedup(one: Row, two: Row) -> float:
    return one["step_seconds"] / two["step_seconds"]
