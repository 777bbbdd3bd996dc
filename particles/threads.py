"""Threads of the compiled loops."""

import numba

from particles.errors import ParticleError


def use_threads(threads: int) -> int:
    """Set the number of threads of the compiled loops, at most what the machine lends."""
    if threads < 1:
        raise ParticleError(f"threads = {threads} must be at least 1")
    allowed = min(threads, numba.config.NUMBA_NUM_THREADS)
    numba.set_num_threads(allowed)
    return allowed
