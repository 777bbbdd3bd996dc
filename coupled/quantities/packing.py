"""Packing fraction in a rectangle, with discs cut by its sides exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def packing_fraction(
    x: Floats, y: Floats, radius: Floats, across: tuple[float, float], upward: tuple[float, float]
) -> float:
    """Area of discs (n,) [m] in a rectangle, over that of the rectangle [-]; ends of both sides in m."""
    (left, right), (bottom, top) = across, upward
    inside = (
        _corner(right - x, top - y, radius)
        - _corner(left - x, top - y, radius)
        - _corner(right - x, bottom - y, radius)
        + _corner(left - x, bottom - y, radius)
    )
    return float(inside.sum()) / ((right - left) * (top - bottom))


def _corner(across: Floats, upward: Floats, radius: Floats) -> Floats:
    """Area [m2] of discs about the origin left of one line and below another.

    With the disc's part left of ``a``, ``H(a) = a sqrt(1 - a^2) + asin a + pi/2``, it is ``(H(a) + H(b))/2 + a b
    - pi/4`` where the corner (a, b) lies in the unit disc; else the parts overlap in nothing, in one of them, or in
    ``H(a) + H(b) - pi``.
    """
    a, b = np.clip(across / radius, -1.0, 1.0), np.clip(upward / radius, -1.0, 1.0)
    left, below = _part(a), _part(b)
    cut = (left + below) / 2 + a * b - np.pi / 4
    apart = np.where(a < 0, np.where(b < 0, 0.0, left), np.where(b < 0, below, left + below - np.pi))
    return np.where(a**2 + b**2 <= 1.0, cut, apart) * radius**2


def _part(a: Floats) -> Floats:
    return a * np.sqrt(1.0 - a**2) + np.arcsin(a) + np.pi / 2
