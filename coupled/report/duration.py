"""Wall times in words."""

from __future__ import annotations


def spoken(seconds: float) -> str:
    """A time [s] in seconds, minutes or hours."""
    if seconds < 9.5:
        return f"{seconds:.2g} s"
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"
