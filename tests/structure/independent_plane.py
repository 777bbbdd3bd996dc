"""Plane-strain stiffness and mass in numpy alone, by shapes written out: what the tests compare with."""

import numpy as np

GAUSS_2 = (np.array([-1, 1]) / 3**0.5, np.ones(2))
GAUSS_3 = (np.array([-1, 0, 1]) * 0.6**0.5, np.array([5, 8, 5]) / 9)


def _square(rule: tuple[np.ndarray, np.ndarray]) -> list[tuple[float, float, float]]:
    """Places (xi, eta) and weights on (-1, 1)^2."""
    return [(x, y, a * b) for x, a in zip(*rule) for y, b in zip(*rule)]


def _triangle() -> list[tuple[float, float, float]]:
    """Six points, exact to degree 4 (Strang and Fix), on the triangle (0, 0), (1, 0), (0, 1)."""
    places = []
    for a, weight in ((0.816847572980459, 0.109951743655322), (0.108103018168070, 0.223381589678011)):
        b = (1 - a) / 2
        places += [(x, y, weight / 2) for x, y in ((a, b), (b, a), (b, b))]
    return places


def shapes(kind: int, xi: float, eta: float) -> tuple[np.ndarray, np.ndarray]:
    """Values (k,) and slopes (k, 2) of the shapes of a cell with k nodes, in VTK order."""
    if kind in (3, 6):
        area = np.array([1 - xi - eta, xi, eta])
        along = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        if kind == 3:
            return area, along
        pairs = ((0, 1), (1, 2), (2, 0))
        values = [*(area * (2 * area - 1)), *(4 * area[i] * area[j] for i, j in pairs)]
        slopes = [
            *((4 * area - 1)[:, None] * along),
            *(4 * (area[i] * along[j] + area[j] * along[i]) for i, j in pairs),
        ]
        return np.array(values), np.array(slopes)
    places = [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)][:kind]

    def line(at: int, s: float) -> tuple[float, float]:
        """Value and slope of the shape of the node `at` on (-1, 1)."""
        if kind == 4:
            return (1 + at * s) / 2, at / 2
        return (1 - s**2, -2 * s) if at == 0 else (s * (s + at) / 2, s + at / 2)

    pairs = [(line(p, xi), line(q, eta)) for p, q in places]
    return np.array([a * b for (a, _), (b, _) in pairs]), np.array([(da * b, a * db) for (a, da), (b, db) in pairs])


def _as_strain(gradients: np.ndarray) -> np.ndarray:
    operator = np.zeros((3, 2 * len(gradients)))
    operator[0, ::2] = operator[2, 1::2] = gradients[:, 0]
    operator[1, 1::2] = operator[2, ::2] = gradients[:, 1]
    return operator


def _bubbles(xi: float, eta: float, corners: np.ndarray, size: float) -> np.ndarray:
    """Strain of the displacements 1 - xi^2 and 1 - eta^2 as Taylor, Beresford and Wilson's QM6 has them."""
    centre = corners.T @ shapes(4, 0.0, 0.0)[1]
    gradients = np.array([[-2 * xi, 0.0], [0.0, -2 * eta]]) @ np.linalg.inv(centre)
    return _as_strain(gradients * np.linalg.det(centre) / size)


def cell_matrices(
    corners: np.ndarray, elasticity: np.ndarray, density: float, enhanced: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and consistent mass of a cell with k nodes (k, 2); `enhanced` makes the four-node one QM6."""
    kind = len(corners)
    rule = _triangle() if kind in (3, 6) else _square(GAUSS_2 if kind == 4 else GAUSS_3)
    inner = 4 if enhanced else 0
    stiffness, mass = np.zeros((2 * kind + inner,) * 2), np.zeros((2 * kind,) * 2)
    for xi, eta, weight in rule:
        values, slopes = shapes(kind, xi, eta)
        jacobian = corners.T @ slopes
        size = np.linalg.det(jacobian)
        operator = _as_strain(slopes @ np.linalg.inv(jacobian))
        if enhanced:
            operator = np.hstack([operator, _bubbles(xi, eta, corners, size)])
        stiffness += operator.T @ elasticity @ operator * size * weight
        mass += density * np.kron(np.outer(values, values), np.eye(2)) * size * weight
    if enhanced:
        n = 2 * kind
        stiffness = stiffness[:n, :n] - stiffness[:n, n:] @ np.linalg.solve(stiffness[n:, n:], stiffness[n:, :n])
    return stiffness, mass


def body_matrices(
    points: np.ndarray, cells: np.ndarray, *, young: float, poisson: float, density: float, enhanced: bool
) -> tuple[np.ndarray, np.ndarray]:
    """K, M (2 n, 2 n), dense, unknowns x and y of each point in turn."""
    lam, mu = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / 2 / (1 + poisson)
    elasticity = np.array([[lam + 2 * mu, lam, 0], [lam, lam + 2 * mu, 0], [0, 0, mu]])
    stiffness, mass = np.zeros((2, 2 * len(points), 2 * len(points)))
    for cell in cells:
        place = np.ix_(*[(2 * cell[:, None] + np.arange(2)).ravel()] * 2)
        own_stiffness, own_mass = cell_matrices(points[cell], elasticity, density, enhanced)
        stiffness[place] += own_stiffness
        mass[place] += own_mass
    return stiffness, mass
