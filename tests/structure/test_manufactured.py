"""Orders of convergence against manufactured solutions: in space for every element, in time for the step."""

import meshes
import numpy as np
import pytest
from formulations import FORMULATIONS, NAMES, rough_square
from held import HeldBody, both
from scipy.linalg import expm
from structure import ElasticStructure, PlaneStrain, Rayleigh

YOUNG, NU, DENSITY = 70e9, 0.3, 2700.0
MATERIAL = PlaneStrain(youngs_modulus=YOUNG, poissons_ratio=NU, density=DENSITY)
SHEAR = YOUNG / 2 / (1 + NU)
LAME = YOUNG * NU / ((1 + NU) * (1 - 2 * NU))


def field(x, y, sin, cos) -> tuple:
    """Displacement with shear and dilatation, zero on the sides of the unit square."""
    return sin(np.pi * x) * sin(2 * np.pi * y), sin(2 * np.pi * x) * sin(np.pi * y)


def pull(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Minus ``(lambda + mu) grad div u + mu laplace u`` of `field`, (n, 2) [N/m^3]."""
    s, c = np.sin, np.cos
    laplace = 5 * np.pi**2 * np.column_stack(field(x, y, s, c))  # minus the Laplacian
    grad_div = np.pi**2 * np.column_stack(
        [
            -s(np.pi * x) * s(2 * np.pi * y) + 2 * c(2 * np.pi * x) * c(np.pi * y),
            2 * c(np.pi * x) * c(2 * np.pi * y) - s(2 * np.pi * x) * s(np.pi * y),
        ]
    )
    return SHEAR * laplace - (LAME + SHEAR) * grad_div


@pytest.mark.parametrize(("cell", "order", "element", "rate"), FORMULATIONS, ids=NAMES)
def test_order_in_space(cell: str, order: int, element: str, rate: int) -> None:
    """Each triangle of a rough mesh is cut into four: quadrilaterals in it stay as skew as they were."""
    errors = []
    for refinements in (1, 2, 3) if order == 1 else (0, 1, 2):
        mesh = rough_square(cell, order, refinements)
        x, y = mesh.points.T
        body = HeldBody(mesh, MATERIAL, element)
        force = (body.mass @ (pull(x, y) / DENSITY).ravel()).reshape(-1, 2)
        held = both(np.flatnonzero((np.minimum(x, 1 - x) < 1e-9) | (np.minimum(y, 1 - y) < 1e-9)))
        errors.append(body.distance(body.displacement(force, held), field))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates[-1] == pytest.approx(rate, abs=0.1), rates


@pytest.mark.parametrize("damping", [None, Rayleigh(mass_factor=900.0, stiffness_factor=3e-5)], ids=["free", "damped"])
@pytest.mark.parametrize(("cell", "order", "element", "_"), FORMULATIONS, ids=NAMES)
def test_order_in_time(cell: str, order: int, element: str, _: int, damping: Rayleigh | None) -> None:
    """A block pushed by b sin(w t), against the matrix exponential of the semi-discrete system."""
    mesh = meshes.beam(length=1.0, height=0.5, along=2, across=1, cell=cell, order=order)
    held = HeldBody(mesh, MATERIAL, element)
    stiffness, mass = held.stiffness.toarray(), held.mass.toarray()
    n, pace, duration = len(mass), 2e4, 4e-4
    push = 1e6 * np.random.default_rng(3).normal(size=mesh.outer_polyline.points.shape)
    force = np.zeros_like(mesh.points)
    force[mesh.outer_nodes] = push
    losses = np.zeros_like(mass) if damping is None else 900.0 * mass + 3e-5 * stiffness
    # states: displacement, velocity, sin(w t), cos(w t)
    system = np.zeros((2 * n + 2, 2 * n + 2))
    system[:n, n : 2 * n] = np.eye(n)
    solved = np.linalg.solve(mass, np.column_stack([stiffness, losses, force.ravel()]))
    system[n : 2 * n, :n], system[n : 2 * n, n : 2 * n] = -solved[:, :n], -solved[:, n : 2 * n]
    system[n : 2 * n, 2 * n] = solved[:, -1]
    system[2 * n, 2 * n + 1], system[2 * n + 1, 2 * n] = pace, -pace
    start = np.zeros(2 * n + 2)
    start[-1] = 1.0
    exact = (expm(system * duration) @ start)[:n].reshape(-1, 2)[mesh.outer_nodes]
    errors = []
    for steps in (400, 800, 1600):
        dt = duration / steps
        body = ElasticStructure(mesh, material=MATERIAL, time_step=dt, damping=damping, element=element)
        for step in range(1, steps + 1):
            body.advance(push * np.sin(pace * step * dt))
        errors.append(np.abs(body.boundary_displacement - exact).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates == pytest.approx(2.0, abs=0.1), errors
    assert errors[-1] < 1e-3 * np.abs(exact).max()
