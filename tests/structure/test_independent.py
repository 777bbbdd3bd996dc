"""Frequencies, statics and supports of every element against an assembly without dolfinx."""

import meshes
import numpy as np
import pytest
from formulations import FORMULATIONS, NAMES, rough_square
from held import HeldBody, both
from independent_plane import body_matrices
from scipy.linalg import eigh
from structure import ElasticStructure, PlaneStrain, PointLoad

METAL = {"young": 70e9, "density": 2700.0}
CASES = pytest.mark.parametrize(("cell", "order", "element", "_"), FORMULATIONS, ids=NAMES)
POISSONS = pytest.mark.parametrize("poisson", [0.0, 0.35, 0.4999])


def material(poisson: float) -> PlaneStrain:
    return PlaneStrain(youngs_modulus=METAL["young"], poissons_ratio=poisson, density=METAL["density"])


def matrices(mesh: meshes.StructureMesh, element: str, poisson: float) -> tuple[np.ndarray, np.ndarray]:
    return body_matrices(mesh.points, mesh.cells, poisson=poisson, enhanced=element == "enhanced", **METAL)


@POISSONS
@CASES
def test_frequencies(cell: str, order: int, element: str, _: int, poisson: float) -> None:
    mesh = rough_square(cell, order, 0)
    stiffness, mass = matrices(mesh, element, poisson)
    squares = eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 9])
    # Round-off of the solvers: eps times the largest omega^2, which near nu = 0.5 is 1e7 times the smallest.
    assert np.abs(squares[:3]).max() < 1e-6 * squares[3]
    found = ElasticStructure(mesh, material=material(poisson), time_step=1.0, element=element).frequencies(7)
    np.testing.assert_allclose(2 * np.pi * found, np.sqrt(squares[3:]), rtol=1e-7)


@POISSONS
@CASES
def test_rest_under_forces_in_balance(cell: str, order: int, element: str, _: int, poisson: float) -> None:
    """Each pair of opposite nodes is pressed together; free of rigid motion, weighted by mass."""
    mesh = rough_square(cell, order, 0)
    ring = mesh.outer_polyline.points
    rng = np.random.default_rng(8)
    loads, force = [], np.zeros_like(mesh.points)
    for one in rng.permutation(len(ring))[:6]:
        other = np.argmin(np.hypot(*(ring + ring[one] - 1.0).T))  # through the middle of the square
        push = (ring[other] - ring[one]) * rng.uniform(1e5, 1e6)
        for node, own in ((one, push), (other, -push)):
            loads.append(PointLoad(point=tuple(ring[node]), force=tuple(own)))
            force[mesh.outer_nodes[node]] += own
    stiffness, mass = matrices(mesh, element, poisson)
    x, y = mesh.points.T
    rigid = np.stack([np.stack(way, axis=1) for way in ((0 * x + 1, 0 * x), (0 * x, 0 * x + 1), (-y, x))])
    border = mass @ rigid.reshape(3, -1).T
    scale = np.abs(stiffness).max() / np.abs(border).max()
    system = np.block([[stiffness, scale * border], [scale * border.T, np.zeros((3, 3))]])
    exact = np.linalg.solve(system, np.concatenate([force.ravel(), np.zeros(3)]))[:-3].reshape(-1, 2)
    body = ElasticStructure(mesh, material=material(poisson), time_step=1.0, loads=loads, element=element)
    # eps times the condition, some 1e3, near nu = 0.5 1e7
    np.testing.assert_allclose(body.static_displacement(), exact, atol=1e-8 * np.abs(exact).max())


@CASES
def test_reaction_is_the_load(cell: str, order: int, element: str, _: int) -> None:
    """Held along one side: what holds it is the load in force and in moment; nothing acts elsewhere."""
    mesh = rough_square(cell, order, 0)
    held = both(np.flatnonzero(mesh.points[:, 0] < 1e-9))
    force = 1e6 * np.random.default_rng(6).normal(size=mesh.points.shape)
    force.ravel()[held] = 0.0
    body = HeldBody(mesh, material(0.35), element)
    u = body.displacement(force, held)
    left = (body.stiffness @ u.ravel()).reshape(-1, 2) - force
    x, y = mesh.points.T
    size = np.abs(force).sum()
    for way in ((1, 0), (0, 1)):
        assert abs((left @ way).sum() + (force @ way).sum()) < 1e-11 * size
    assert abs((x * left[:, 1] - y * left[:, 0]).sum() + (x * force[:, 1] - y * force[:, 0]).sum()) < 1e-11 * size
    free = np.setdiff1d(np.arange(left.size), held)
    assert np.abs(left.ravel()[free]).max() < 1e-11 * size
    # and the independent stiffness says the same of it
    own = matrices(mesh, element, 0.35)[0]
    np.testing.assert_allclose(own @ u.ravel(), (left + force).ravel(), atol=1e-10 * size)
