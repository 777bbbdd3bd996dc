"""The gradient of nodal displacements at points of all cells, and what is read from it."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem
from numpy.typing import NDArray

from structure import compat
from structure.discrete import DiscreteBody
from structure.nodes import fill

Floats = NDArray[np.float64]


class GradientProbe:
    """Evaluates ``grad u`` on this rank's cells; compiled once.

    Parameters
    ----------
    body : DiscreteBody
    points : (p, 2)
        In the reference cell of dolfinx.
    """

    def __init__(self, body: DiscreteBody, points: Floats) -> None:
        self._function = fem.Function(body.space)
        gradient = ufl.grad(self._function)
        flat = ufl.as_vector([gradient[i, j] for i in range(2) for j in range(2)])
        self._expression = compat.compiled_expression(flat, points)
        self._domain = body.mesh.domain
        self._cells = np.arange(self._domain.topology.index_map(2).size_local, dtype=np.int32)

    def __call__(self, displacement: Floats) -> Floats:
        """``du_i/dX_j`` (owned cells, p, 2, 2) of this rank's (owned unknowns,) [m]; collective."""
        fill(self._function, displacement)
        values = compat.evaluate(self._expression, self._domain, self._cells)
        return values.reshape(len(self._cells), -1, 2, 2)


def rotation(gradient: Floats) -> Floats:
    """Angle [rad] (...) of R in ``1 + grad u = R U`` for gradients (..., 2, 2)."""
    return np.arctan2(gradient[..., 1, 0] - gradient[..., 0, 1], 2.0 + gradient[..., 0, 0] + gradient[..., 1, 1])


def green_lagrange(gradient: Floats) -> Floats:
    """``E = (grad u + grad u^T + grad u^T grad u)/2`` (..., 3) as xx, yy, xy."""
    a, b = gradient[..., 0, 0], gradient[..., 0, 1]
    c, d = gradient[..., 1, 0], gradient[..., 1, 1]
    return np.stack([a + (a * a + c * c) / 2, d + (b * b + d * d) / 2, (b + c + a * b + c * d) / 2], axis=-1)


def logarithmic(gradient: Floats) -> Floats:
    """``ln V``, ``V^2 = F F^T``, ``F = 1 + grad u``: the true strain in the axes of space, (..., 3) as xx, yy, xy."""
    left = green_lagrange(np.swapaxes(gradient, -1, -2))  # (V^2 - 1)/2
    xx, yy, xy = np.moveaxis(left, -1, 0)
    mean, half = 1.0 + xx + yy, np.hypot(xx - yy, 2 * xy)  # of the squares of the principal stretches
    spread = np.where(half > 0.0, np.arctanh(half / mean) / np.where(half > 0.0, half, 1.0), 1.0 / mean) / 2
    middle = np.log(mean * mean - half * half) / 4
    return np.stack([middle + spread * (xx - yy), middle - spread * (xx - yy), spread * 2 * xy], axis=-1)


def least_stretch(gradient: Floats) -> Floats:
    """Smallest principal stretch (...) of ``F = 1 + grad u``; negative where F turns the material inside out."""
    a, b = 1.0 + gradient[..., 0, 0], gradient[..., 0, 1]
    c, d = gradient[..., 1, 0], 1.0 + gradient[..., 1, 1]
    return (np.hypot(a + d, c - b) - np.hypot(a - d, c + b)) / 2
