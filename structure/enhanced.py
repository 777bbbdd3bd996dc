"""Four-node quadrilaterals that bend: strains enhanced by four modes of each cell's own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from structure.errors import StructureError

# Corners in dolfinx' order, in (-1, 1) x (-1, 1).
CORNERS = np.array([(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)])
GAUSS = CORNERS / np.sqrt(3.0)  # weights 1


class EnhancedCells:
    """Assumed enhanced strain in plane strain, the modes condensed out.

    ``eps = B u + M alpha``, ``M = (j0/j) T0 [[xi, 0, 0, 0], [0, eta, 0, 0], [0, 0, xi, eta]]``,
    ``alpha = -(int M^T D M)^-1 int M^T D B u``; hence ``eps = B* u`` and ``k = int B*^T D B*``.
    j is the determinant of the map from (-1, 1)^2, j0 and T0 (which takes the natural strain
    components to x and y) are those of the centre; D acts on (xx, yy, gamma_xy); 2 x 2 Gauss points.
    As ``int M`` is zero, constant strain is exact in cells of any convex shape (patch test). In
    parallelograms pure bending is exact as well; trapezoids of a slender cell bend too stiffly, as
    four nodes that pass the patch test must (MacNeal 1992).

    Source: Simo and Rifai (1990), four modes; the same element as Taylor, Beresford and Wilson's
    QM6 (1976) when the cell is a parallelogram.

    Parameters
    ----------
    corners : (cells, 4, 2)
        Positions [m] of the corners in dolfinx' order.
    elasticity : (3, 3)
        D [Pa].

    Raises
    ------
    StructureError
        A cell is not convex.
    """

    def __init__(self, corners: NDArray[np.float64], elasticity: NDArray[np.float64]) -> None:
        self._corners, self._elasticity = corners, elasticity
        _refuse_folded(corners)
        _, self._central, to_natural = _gradients(corners, np.zeros(2))
        self._turn = _component_change(to_natural)
        own = np.zeros((len(corners), 4, 4))
        coupling = np.zeros((len(corners), 4, 8))
        for point in GAUSS:
            compatible, determinant = self._compatible(point)
            modes = self._modes(point, determinant)
            stress = np.abs(determinant)[:, None, None] * (modes.transpose(0, 2, 1) @ elasticity)
            own += stress @ modes
            coupling += stress @ compatible
        self._amplitudes = -_solved(own, coupling)

    def strain_operator(self, point: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """``B*`` (cells, 3, 8) at a point of (-1, 1)^2 as xx, yy, gamma_xy, and |j| (cells,)."""
        compatible, determinant = self._compatible(point)
        return compatible + self._modes(point, determinant) @ self._amplitudes, np.abs(determinant)

    def stiffness(self) -> NDArray[np.float64]:
        """k (cells, 8, 8) [Pa], symmetric; unknowns x, y of each corner in turn."""
        total = np.zeros((len(self._corners), 8, 8))
        for point in GAUSS:
            operator, weight = self.strain_operator(point)
            total += weight[:, None, None] * (operator.transpose(0, 2, 1) @ self._elasticity @ operator)
        return (total + total.transpose(0, 2, 1)) / 2

    def _compatible(self, point: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """B (cells, 3, 8) and j (cells,)."""
        gradient, determinant, _ = _gradients(self._corners, point)
        operator = np.zeros((len(gradient), 3, 8))
        operator[:, 0, 0::2] = operator[:, 2, 1::2] = gradient[:, :, 0]
        operator[:, 1, 1::2] = operator[:, 2, 0::2] = gradient[:, :, 1]
        return operator, determinant

    def _modes(self, point: NDArray[np.float64], determinant: NDArray[np.float64]) -> NDArray[np.float64]:
        """M (cells, 3, 4)."""
        xi, eta = point
        natural = np.array([[xi, 0.0, 0.0, 0.0], [0.0, eta, 0.0, 0.0], [0.0, 0.0, xi, eta]])
        return (self._central / determinant)[:, None, None] * (self._turn @ natural)


def _gradients(
    corners: NDArray[np.float64], point: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Shape functions' gradients (cells, 4, 2), determinant (cells,), d(xi, eta)/d(x, y) (cells, 2, 2)."""
    natural = CORNERS * (1.0 + CORNERS[:, ::-1] * point[::-1]) / 4.0
    (a, b), (c, d) = (corners.transpose(0, 2, 1) @ natural).transpose(1, 2, 0)
    determinant = a * d - b * c
    inverse = (np.array([[d, -b], [-c, a]]) / determinant).transpose(2, 0, 1)
    return natural @ inverse, determinant, inverse


def _solved(matrices: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64]:
    """``matrices^-1 right`` for positive definite matrices (cells, 4, 4), which need no pivots, all cells at once.

    LAPACK is called cell by cell, and with threads of its own that takes 6 to 75 times as long.
    """
    system = np.concatenate([matrices, right], axis=2)
    for k in range(matrices.shape[1]):
        row = system[:, k] / system[:, k, k, None]
        system -= system[:, :, k, None] * row[:, None, :]
        system[:, k] = row
    return system[:, :, matrices.shape[1] :]


def _component_change(to_natural: NDArray[np.float64]) -> NDArray[np.float64]:
    """T (cells, 3, 3): xx, yy, gamma_xy of the covariant natural components 11, 22, twice 12."""
    (a, b), (c, d) = to_natural.transpose(1, 2, 0)
    rows = [[a * a, c * c, a * c], [b * b, d * d, b * d], [2 * a * b, 2 * c * d, a * d + b * c]]
    return np.array(rows).transpose(2, 0, 1)


def _refuse_folded(corners: NDArray[np.float64]) -> None:
    ahead = corners[:, [1, 3, 0, 2]] - corners  # counter-clockwise or clockwise, cell by cell
    back = corners[:, [2, 0, 3, 1]] - corners
    turn = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
    folded = np.flatnonzero((turn.min(axis=1) <= 0.0) & (turn.max(axis=1) >= 0.0))
    if len(folded):
        middle = corners[folded[0]].mean(axis=0)
        raise StructureError(
            f"the cell around {tuple(np.round(middle, 12).tolist())!r} is not convex: mend the mesh, "
            "the corners of a quadrilateral must all turn the same way"
        )
