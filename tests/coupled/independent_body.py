"""A plane-strain body of bilinear cells, with numpy and scipy alone: what the tests compare with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.linalg import eigsh, splu

GAUSS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / np.sqrt(3)
CORNER_X, CORNER_Y = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])


class IndependentBody:
    """Displacement (x, y) of each node in turn; `points` (n, 2) [m], `cells` (m, 4) counter-clockwise."""

    def __init__(self, points: np.ndarray, cells: np.ndarray, *, young: float, poisson: float) -> None:
        self.points, self.cells, self.size = points, cells, 2 * len(points)
        self._unknowns = (2 * cells[:, :, None] + np.arange(2)).reshape(-1, 8)
        lam, mu = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / 2 / (1 + poisson)
        elasticity = np.array([[lam + 2 * mu, lam, 0], [lam, lam + 2 * mu, 0], [0, 0, mu]])
        stiffness = np.zeros((len(cells), 8, 8))
        for weight, slopes, _ in self._gauss_points():
            strain = np.zeros((len(cells), 3, 8))
            strain[:, 0, ::2] = strain[:, 2, 1::2] = slopes[:, 0]
            strain[:, 1, 1::2] = strain[:, 2, ::2] = slopes[:, 1]
            stiffness += weight[:, None, None] * (strain.transpose(0, 2, 1) @ elasticity @ strain)
        self.stiffness = self._assemble(stiffness)

    def mass(self, density: float) -> csr_matrix:
        """Consistent mass [kg/m]."""
        mass = np.zeros((len(self.cells), 8, 8))
        for weight, _, shape in self._gauss_points():
            mass += density * weight[:, None, None] * np.kron(np.outer(shape, shape), np.eye(2))
        return self._assemble(mass)

    def modes(self, density: float, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Angular frequencies (count,) [1/s] of the free body and modes (size, count), mass one."""
        shift = -1e-3 * self.stiffness.diagonal().min() / self.mass(density).diagonal().max()
        squares, shapes = eigsh(self.stiffness.tocsc(), count + 3, self.mass(density).tocsc(), sigma=shift)
        order = np.argsort(squares)[3:]
        return np.sqrt(squares[order]), shapes[:, order]

    def between(self, first: np.ndarray, second: np.ndarray, share: np.ndarray) -> csr_matrix:
        """Operator (2 k, size): displacement at ``(1 - share)`` of node `first` and `share` of `second`."""
        rows = np.arange(2 * len(share)).reshape(-1, 2)
        columns = [2 * node[:, None] + np.arange(2) for node in (first, second)]
        values = [np.repeat(part[:, None], 2, axis=1) for part in (1 - share, share)]
        places = (np.concatenate([rows, rows]).ravel(), np.concatenate(columns).ravel())
        return csr_matrix((np.concatenate(values).ravel(), places), shape=(2 * len(share), self.size))

    def _gauss_points(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Weight (m,), slopes (m, 2, 4) along x and y, and shape functions (4,) at the 2 x 2 points."""
        found = []
        for x, y in GAUSS:
            own = np.array([CORNER_X * (1 + CORNER_Y * y), CORNER_Y * (1 + CORNER_X * x)]) / 4
            jacobian = own @ self.points[self.cells]
            shape = (1 + CORNER_X * x) * (1 + CORNER_Y * y) / 4
            found.append((np.linalg.det(jacobian), np.linalg.inv(jacobian) @ own, shape))
        return found

    def _assemble(self, cells: np.ndarray) -> csr_matrix:
        places = (np.repeat(self._unknowns, 8, axis=1).ravel(), np.tile(self._unknowns, 8).ravel())
        return coo_matrix((cells.ravel(), places), shape=(self.size, self.size)).tocsr()


@dataclass(frozen=True)
class Motion:
    """What `motion` saw at its chosen steps: displacements (k, size), velocities, and what `look` gave."""

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    contact: np.ndarray


Forces = Callable[[float, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def motion(
    body: IndependentBody,
    *,
    density: float,
    step: float,
    duration: float,
    every: int,
    contact: Forces,
    load: Callable[[float], np.ndarray] | None = None,
    velocity: np.ndarray | None = None,
    rayleigh: tuple[float, float] = (0.0, 0.0),
) -> Motion:
    """Average acceleration with the forces of the new time, found by fixed-point iteration.

    ``contact(t, u, v)`` gives nodal forces (size,) and the forces on the springs, which are recorded.
    """
    mass, stiffness = body.mass(density), body.stiffness
    damping = rayleigh[0] * mass + rayleigh[1] * stiffness
    solve = splu((mass + step / 2 * damping + step**2 / 4 * stiffness).tocsc()).solve
    outside = (lambda time: 0.0) if load is None else load
    u = np.zeros(body.size)
    v = np.zeros(body.size) if velocity is None else velocity.copy()
    force, pushes = contact(0.0, u, v)
    a = splu(mass.tocsc()).solve(outside(0.0) + force - damping @ v)
    seen: list[tuple[float, np.ndarray, np.ndarray, np.ndarray]] = []
    for n in range(1, round(duration / step) + 1):
        time = n * step
        to_u, to_v = u + step * v + step**2 / 4 * a, v + step / 2 * a
        known = outside(time) - damping @ to_v - stiffness @ to_u
        for _ in range(6):
            new = solve(known + force)
            old, (force, pushes) = force, contact(time, to_u + step**2 / 4 * new, to_v + step / 2 * new)
            change = np.abs(force - old).max() / max(1.0, np.abs(force).max())
            if change <= 1e-7:  # the next would be a thousand times smaller
                break
        # A disc below a node between two facets may be nearest to either in turn: their slopes differ by 1e-6.
        assert change <= 1e-5, f"the contact forces do not settle at t = {time:g} s: take a smaller step"
        a = solve(known + force)
        u, v = to_u + step**2 / 4 * a, to_v + step / 2 * a
        if n % every == 0:
            seen.append((time, u, v, pushes))
    return Motion(*(np.array(column) for column in zip(*seen)))
