"""What only a process of its own shows: compiling, starting, peak memory."""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

FIRST_STEP = """
import particles as p
law = p.ContactModel(
    normal=p.LinearSpringDashpot(stiffness=2e6, damping=99.0),
    tangential=p.CoulombFriction(stiffness=1e5, friction=0.8),
    rolling=p.ElasticPlasticRolling(friction=0.2),
)
p.ParticleSystem(p.lattice([(2e-3, 1000)], 1600.0, width=0.2), law, time_step=1e-5, walls=p.box(0.2, 1.0)).advance(1)
"""

WIDE_BED = """
import beds
system = beds.side_by_side(beds.reference(), {copies})
system.advance(10)
status = open("/proc/self/status").read().splitlines()
print(next(line.split()[1] for line in status if line.startswith("VmHWM")))
"""


def _run(code: str, environment: Mapping[str, str] | None = None) -> tuple[float, str]:
    """Wall time [s] and output of a Python process that sees the modules beside this one."""
    begin = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, stdout=subprocess.PIPE, text=True, env=environment,
        cwd=Path(__file__).parent,
    )  # fmt: skip
    return time.perf_counter() - begin, done.stdout


def starts() -> dict[str, float | None]:
    """1000 discs under the full law up to the first step: nothing compiled, then compiled code on disk."""
    with tempfile.TemporaryDirectory() as empty:
        compiling, _ = _run(FIRST_STEP, os.environ | {"XDG_CACHE_HOME": empty})
    taken = [_run(FIRST_STEP)[0] for _ in range(4)]
    return {"first_start_seconds": compiling, "second_start_seconds": statistics.median(taken[1:])}


def peak_memory(copies: int) -> float:
    """Peak resident memory [MiB] of a process that makes the wide bed and runs it.

    The saved state from which the bed is made counts too. The kernel's own high-water mark is read
    because `ru_maxrss` would start at the memory of the process that started this one.
    """
    return float(_run(WIDE_BED.format(copies=copies))[1]) / 1024
