"""The one owner of the compiler settings of all kernels.

Numba's disk cache looks at the file of the compiled function alone: it keeps stale machine
code when a *callee in another file* changes. The cache folder is therefore named after a hash
of the sources of all kernels, so that any edit starts a fresh one. Of two processes that save builds
of one function at the same time it may keep one's index and the other's code: here they save one after
the other. No fast-math flag is set, not even contraction: the same bits must come out of the serial and
the threaded build of a loop, with the ledger and without.
"""

import contextlib
import fcntl
import hashlib
import math
import os
import platform
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.core import config, types
from numba.extending import overload

# Measured on two cores at 15 000 discs: OpenMP 1.64 times one thread, TBB 0.86, Numba's own queue 0.82.
config.THREADING_LAYER = "omp"
# OpenMP's threads spin at a barrier before they sleep. By default so long that a run with two threads falls
# to a tenth of one on busy cores; with this it keeps 2.0 times one thread on quiet ones.
os.environ.setdefault("GOMP_SPINCOUNT", "1000")

Function = TypeVar("Function", bound=Callable[..., Any])


def _cache_folder() -> Path:
    digest = hashlib.sha256(f"{numba.__version__} {platform.python_version()}".encode())
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "leito" / "kernels" / digest.hexdigest()[:16]


CACHE_FOLDER = _cache_folder()


def _compiled(function: Function, *, parallel: bool = False, inline: bool = False) -> Function:
    before = config.CACHE_DIR
    # Numba names the cache file after the function alone: the two builds of one loop need two folders.
    config.CACHE_DIR = str(CACHE_FOLDER / ("threads" if parallel else "serial"))
    try:
        compiled = numba.njit(cache=True, parallel=parallel, forceinline=inline, error_model="numpy")(function)
    finally:
        config.CACHE_DIR = before
    if hasattr(compiled, "_cache"):  # not where Numba is told to compile nothing
        file = compiled._cache._cache_file
        file.save = partial(_save_alone, file.save)
    return compiled


def _save_alone(save: Callable[[Any, Any], None], key: Any, build: Any) -> None:
    """Numba's `save` of a build under a key, while no other process does that."""
    with open(CACHE_FOLDER / "lock", "w") as lock:
        with contextlib.suppress(OSError):  # a disk that knows no locks
            fcntl.flock(lock, fcntl.LOCK_EX)  # given back with the file
        save(key, build)


def kernel(function: Function) -> Function:
    """Compile a function for one thread, cached on disk."""
    return _compiled(function)


def inner_kernel(function: Function) -> Function:
    """Compile a function that is called for every contact: always inlined.

    Left to itself the compiler calls a long one, and counts references to its arrays at each call.
    """
    return _compiled(function, inline=True)


def threaded_kernel(function: Function) -> Function:
    """Compile a function whose `prange` loops run on threads, cached on disk."""
    return _compiled(function, parallel=True)


@inner_kernel
def rarely(value: float) -> float:
    """`value`, behind a call of hypot that changes nothing.

    The compiler takes short branches out of a loop by computing both sides. This keeps it from dividing
    at every contact for the sake of a rare one: 10 % of the whole step.
    """
    return math.copysign(math.hypot(value, 0.0), value)


def by_law(stub: Function) -> Function:
    """A function of laws that kernels call by the type of its first argument, like `functools.singledispatch`.

    `stub` gives name, arguments and meaning; ``@stub.of(Law, ...)`` marks what is done for a law, for a
    float, or for None. The choice is made when a kernel is compiled, and inlined: a law that is not modelled costs nothing.
    """
    choices: dict[type, Callable[..., Any]] = {}

    def choose(law: types.Type, *rest: types.Type) -> Callable[..., Any]:
        if isinstance(law, types.NoneType):
            return choices[type(None)]
        return choices[float if isinstance(law, types.Float) else law.instance_class]

    def of(*kinds: type | None) -> Callable[[Function], Function]:
        def register(function: Function) -> Function:
            choices.update((type(None) if kind is None else kind, function) for kind in kinds)
            return function

        return register

    overload(stub, strict=False, jit_options={"error_model": "numpy", "forceinline": True})(choose)
    stub.of = of
    return stub
