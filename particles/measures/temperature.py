"""Granular temperature: what is left of the motion beside the local mean velocity."""

from typing import NamedTuple

import numpy as np

from particles.errors import ParticleError
from particles.measures.cells import Cells
from particles.state import Floats

FIELDS = {"constant": 1, "linear": 3}  # unknowns of the mean velocity in a cell, per component


class Temperature(NamedTuple):
    """Per cell (rows, columns): temperatures [J/m], not a number where too few grains are, and numbers of grains."""

    translational: Floats
    rotational: Floats
    count: np.ndarray


class MovingGrains(NamedTuple):
    """Places x, y [m], velocities [m/s], spin [rad/s], mass [kg/m] and inertia [kg m] of grains, all (n,)."""

    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    omega: Floats
    mass: Floats
    inertia: Floats


def granular_temperature(grains: MovingGrains, cells: Cells, *, mean: str = "linear") -> Temperature:
    """Mean fluctuating energy per degree of freedom, times two, in every cell.

    ``T = sum m |v - u(x)|^2 / (2 (N - p))`` and ``T_r = sum I (omega - <omega>)^2 / (N - 1)`` over the N grains of a
    cell. The mean velocity u has p unknowns per component, fitted with the masses as weights: "constant" (p = 1), or
    "linear" in the place (p = 3), which takes shear and rotation of the flow out. Dividing by N - p makes both unbiased
    for Maxwell's velocities, for which T and T_r are the variance of ``sqrt(m) v`` and of ``sqrt(I) omega``.

    Raises
    ------
    ParticleError
        If `mean` is neither "constant" nor "linear".
    """
    if mean not in FIELDS:
        raise ParticleError(f'mean = "{mean}" must be "constant" or "linear"')
    cell = cells.number(grains.x, grains.y)
    inside = cell >= 0
    g, cell = MovingGrains(*(array[inside] for array in grains)), cell[inside]
    count = np.bincount(cell, minlength=cells.count)
    basis = _basis(g, cell, cells, FIELDS[mean])
    left = [_left_over(v, basis, g.mass, cell, cells.count) for v in (g.vx, g.vy)]
    spin = _left_over(g.omega, basis[:, :1], g.inertia, cell, cells.count)
    energy = np.bincount(cell, g.mass * (left[0] ** 2 + left[1] ** 2), minlength=cells.count)
    turning = np.bincount(cell, g.inertia * spin**2, minlength=cells.count)
    parts = [_over(energy, 2.0 * (count - FIELDS[mean])), _over(turning, 1.0 * (count - 1))]
    return Temperature(cells.shaped(parts[0]), cells.shaped(parts[1]), cells.shaped(count))


def _basis(g: MovingGrains, cell: np.ndarray, cells: Cells, unknowns: int) -> Floats:
    """1, and the place in the cell from -1/2 to 1/2 in x and y: (n, unknowns)."""
    across, up = cells.local(g.x, g.y)
    row, column = np.divmod(cell, cells.columns)
    wide, high = cells.size
    return np.column_stack([np.ones(len(cell)), across / wide - column - 0.5, up / high - row - 0.5])[:, :unknowns]


def _left_over(values: Floats, basis: Floats, weight: Floats, cell: np.ndarray, count: int) -> Floats:
    """What a weighted fit of the basis in every cell leaves of values (n,); of the least norm where it is singular."""
    unknowns = basis.shape[1]
    matrix, right = np.empty((count, unknowns, unknowns)), np.empty((count, unknowns))
    for p in range(unknowns):
        right[:, p] = np.bincount(cell, weight * basis[:, p] * values, minlength=count)
        for q in range(unknowns):
            matrix[:, p, q] = np.bincount(cell, weight * basis[:, p] * basis[:, q], minlength=count)
    fit = np.einsum("cpq,cq->cp", np.linalg.pinv(matrix, rcond=1e-12, hermitian=True), right)
    return values - np.einsum("np,np->n", basis, fit[cell])


def _over(total: Floats, freedoms: Floats) -> Floats:
    return np.divide(total, freedoms, out=np.full(len(total), np.nan), where=freedoms > 0)
