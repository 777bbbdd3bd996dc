"""How much memory may still be taken."""

from __future__ import annotations

import os
from pathlib import Path


def available_memory() -> float:
    """Memory [bytes] that can be had without swapping, as the kernel says; all of it where the kernel does not."""
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
    except OSError:
        lines = []
    for line in lines:
        if line.startswith("MemAvailable:"):
            return 1024.0 * float(line.split()[1])
    return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
