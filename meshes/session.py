"""gmsh with the caller's Ctrl-C kept: its module replaces the handler on import and at the end."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def _interrupt_handler_kept() -> Iterator[None]:
    in_main_thread = threading.current_thread() is threading.main_thread()
    handler = signal.getsignal(signal.SIGINT) if in_main_thread else None
    try:
        yield
    finally:
        if handler is not None:
            signal.signal(signal.SIGINT, handler)


with _interrupt_handler_kept():
    import gmsh

    try:
        from dolfinx.io import gmshio
    except ImportError:  # dolfinx 0.10 and later, not tested
        from dolfinx.io import gmsh as gmshio

__all__ = ["gmsh", "gmshio", "session"]


@contextmanager
def session() -> Iterator[None]:
    """A quiet gmsh with one empty model, closed on the way out."""
    with _interrupt_handler_kept():
        gmsh.initialize([], False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("General.Verbosity", 0)
            gmsh.model.add("structure")
            yield
        finally:
            gmsh.finalize()
