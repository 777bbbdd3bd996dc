"""The elements that every proof is made for, and meshes of them that no coordinate line follows."""

import meshes
import numpy as np
from scipy.spatial import Delaunay

# cell, order, formulation, order of convergence of the displacement in L2
FORMULATIONS = [
    ("quadrilateral", 1, "standard", 2),
    ("quadrilateral", 1, "enhanced", 2),
    ("triangle", 1, "standard", 2),
    ("quadrilateral", 2, "standard", 3),
    ("triangle", 2, "standard", 3),
]
NAMES = [f"{cell}-{order}-{element}" for cell, order, element, _ in FORMULATIONS]


def _with_middles(points: np.ndarray, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points with the middle of each side, shared by the cells on both sides of it, and its number (m, sides)."""
    sides = np.stack([cells, np.roll(cells, -1, axis=1)], axis=2)
    edges, number = np.unique(np.sort(sides.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    return np.vstack([points, points[edges].mean(axis=1)]), number.reshape(cells.shape) + len(points)


def refined(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Each triangle cut into four by the middles of its sides."""
    points, middle = _with_middles(points, triangles)
    (a, b, c), (ab, bc, ca) = triangles.T, middle.T
    return points, np.vstack([np.column_stack(t) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])


def _sides(points: np.ndarray, cells: np.ndarray) -> dict[str, np.ndarray]:
    """Edges of cells whose both ends lie on a side of the unit square."""
    edges = np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2)
    places = {"left": (0, 0.0), "right": (0, 1.0), "bottom": (1, 0.0), "top": (1, 1.0)}
    return {name: edges[(points[edges, axis] == at).all(axis=1)] for name, (axis, at) in places.items()}


def rough_square(cell: str, order: int, refinements: int, sides: int = 3) -> meshes.StructureMesh:
    """The unit square in triangles between points at random, or quadrilaterals, three in each triangle; named sides."""
    rng = np.random.default_rng(4)
    x, y = (a.ravel() for a in np.meshgrid(*[np.linspace(0, 1, sides + 1)] * 2))
    inside = (np.minimum(x, 1 - x) > 0) & (np.minimum(y, 1 - y) > 0)
    points = np.column_stack([x, y]) + 0.25 / sides * rng.uniform(-1, 1, (len(x), 2)) * inside[:, None]
    cells = Delaunay(points).simplices.astype(np.int64)
    ahead, back = (points[cells[:, k]] - points[cells[:, 0]] for k in (1, 2))
    turn = ahead[:, 0] * back[:, 1] - ahead[:, 1] * back[:, 0]
    cells = np.where(turn[:, None] > 0, cells, cells[:, ::-1])[np.abs(turn) > 1e-9]  # nothing flat along a side
    for _ in range(refinements):
        points, cells = refined(points, cells)
    if cell == "quadrilateral":
        middle_of_cell = points[cells].mean(axis=1)
        points, middle = _with_middles(points, cells)
        centre = len(points) + np.arange(len(cells))
        points = np.vstack([points, middle_of_cell])
        cells = np.vstack([np.column_stack([cells[:, k], middle[:, k], centre, middle[:, k - 1]]) for k in range(3)])
    boundaries = _sides(points, cells)
    if order == 2:
        middle_of_cell = points[cells].mean(axis=1)
        points, middle = _with_middles(points, cells)
        cells = np.hstack([cells, middle])
        if cell == "quadrilateral":
            cells = np.column_stack([cells, len(points) + np.arange(len(cells))])
            points = np.vstack([points, middle_of_cell])
    return meshes.from_arrays(points, cells, boundaries=boundaries)
