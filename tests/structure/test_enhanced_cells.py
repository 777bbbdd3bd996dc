"""One enhanced cell by itself: constant strain, rigid motion, bending, and its twin by incompatible modes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from structure import PlaneStrain, StructureError
from structure.enhanced import CORNERS, EnhancedCells

AROUND = [0, 1, 3, 2]  # corners of a cell in counter-clockwise order
POISSONS = (-0.4, 0.0, 0.35, 0.4999)


def elasticity(poissons_ratio: float) -> np.ndarray:
    return PlaneStrain(youngs_modulus=2.0, poissons_ratio=poissons_ratio, density=1.0).elasticity


@st.composite
def convex_cells(draw: st.DrawFn) -> np.ndarray:
    """A bent square, turned, mirrored or not, stretched up to 1:5, anywhere."""
    number = st.floats(-1.0, 1.0)
    # Corners that move by less than 0.24 sides in x and in y leave a square convex.
    bend = np.array(draw(st.lists(number, min_size=8, max_size=8))).reshape(4, 2) * 0.48
    stretch = np.diag([draw(st.floats(0.2, 1.0)), draw(st.sampled_from([-1.0, 1.0]))])
    angle = np.pi * draw(number)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return (CORNERS + bend) @ stretch @ turn.T + [draw(number), draw(number)]


def traction_forces(corners: np.ndarray, stress: np.ndarray) -> np.ndarray:
    """Nodal forces (4, 2) of a uniform stress (2, 2): each straight side gives half to each end."""
    force = np.zeros((4, 2))
    loop = corners[AROUND]
    area = 0.5 * np.sum(loop[:, 0] * np.roll(loop[:, 1], -1) - loop[:, 1] * np.roll(loop[:, 0], -1))
    for one, two in zip(AROUND, np.roll(AROUND, -1)):
        along = (corners[two] - corners[one]) * np.sign(area)
        push = stress @ np.array([along[1], -along[0]])
        force[one] += push / 2
        force[two] += push / 2
    return force


@settings(max_examples=60, deadline=None)
@given(corners=convex_cells(), poisson=st.sampled_from(POISSONS))
def test_constant_strain_is_exact_in_any_convex_cell(corners: np.ndarray, poisson: float) -> None:
    """The patch test, cell by cell: linear displacements need the tractions of a constant stress."""
    cells = EnhancedCells(corners[None], elasticity(poisson))
    for gradient in np.eye(4).reshape(4, 2, 2):
        u = corners @ gradient.T
        xx, yy, xy = elasticity(poisson) @ [gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]]
        expected = traction_forces(corners, np.array([[xx, xy], [xy, yy]]))
        found = (cells.stiffness()[0] @ u.ravel()).reshape(4, 2)
        # Round-off of sums of terms of the size of lambda (1e4 near nu = 0.5), amplified by the shape.
        scale = np.abs(elasticity(poisson)).max()
        np.testing.assert_allclose(found, expected, atol=1e-12 * scale)
        for point in CORNERS:
            strain = cells.strain_operator(point)[0][0] @ u.ravel()
            np.testing.assert_allclose(
                strain, [gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]], atol=1e-10
            )


@settings(max_examples=60, deadline=None)
@given(corners=convex_cells(), poisson=st.sampled_from(POISSONS))
def test_three_rigid_motions_and_nothing_else_cost_no_energy(corners: np.ndarray, poisson: float) -> None:
    stiffness = EnhancedCells(corners[None], elasticity(poisson)).stiffness()[0]
    np.testing.assert_array_equal(stiffness, stiffness.T)
    values = np.linalg.eigvalsh(stiffness)
    assert np.abs(values[:3]).max() < 1e-13 * values[-1]
    # The softest strain costs mu = 0.67 to 1.67 times an area of at least 0.1; bending of a cell stretched 1:5 less.
    assert values[3] > 1e-3


@settings(max_examples=60, deadline=None)
@given(corners=convex_cells(), poisson=st.sampled_from(POISSONS))
def test_twin_by_incompatible_displacements(corners: np.ndarray, poisson: float) -> None:
    """Taylor, Beresford and Wilson's QM6: displacements 1 - xi^2 and 1 - eta^2, gradients by the centre's Jacobian."""

    def jacobian(xi: float, eta: float) -> tuple[np.ndarray, np.ndarray]:
        slopes = np.array([[s * (1 + t * eta), t * (1 + s * xi)] for s, t in CORNERS]) / 4
        return corners.T @ slopes, slopes

    def as_strain(gradients: np.ndarray) -> np.ndarray:
        operator = np.zeros((3, 2 * len(gradients)))
        for k, (dx, dy) in enumerate(gradients):
            operator[:, 2 * k : 2 * k + 2] = [[dx, 0], [0, dy], [dy, dx]]
        return operator

    centre, _ = jacobian(0.0, 0.0)
    whole = np.zeros((12, 12))
    for xi in (-(3**-0.5), 3**-0.5):
        for eta in (-(3**-0.5), 3**-0.5):
            here, slopes = jacobian(xi, eta)
            size = np.linalg.det(here)
            bubbles = np.array([[-2 * xi, 0.0], [0.0, -2 * eta]]) @ np.linalg.inv(centre)
            bubbles *= np.linalg.det(centre) / size
            operator = np.hstack([as_strain(slopes @ np.linalg.inv(here)), as_strain(bubbles)])
            whole += operator.T @ elasticity(poisson) @ operator * abs(size)
    condensed = whole[:8, :8] - whole[:8, 8:] @ np.linalg.solve(whole[8:, 8:], whole[8:, :8])
    found = EnhancedCells(corners[None], elasticity(poisson)).stiffness()[0]
    # Condensation subtracts terms of the size of lambda.
    np.testing.assert_allclose(found, condensed, atol=1e-11 * np.abs(whole).max())


@pytest.mark.parametrize("poisson", POISSONS)
@pytest.mark.parametrize("slant", [0.0, 0.7])
def test_pure_bending_is_exact(poisson: float, slant: float) -> None:
    """A parallelogram bent to the curvature kappa stores E' I kappa^2/2 per length, however slender."""
    for length in (1.0, 20.0):
        x, y = CORNERS[:, 0] * length / 2, CORNERS[:, 1] / 2
        corners = np.column_stack([x + slant * y, y])
        # Beam axis along x: u = -kappa x y, v = kappa (x^2 + nu' y^2)/2 with the slice's nu' = nu/(1 - nu).
        sideways = poisson / (1 - poisson)
        u = np.column_stack([-corners[:, 0] * y, (corners[:, 0] ** 2 + sideways * y**2) / 2])
        stiffness = EnhancedCells(corners[None], elasticity(poisson)).stiffness()[0]
        energy = u.ravel() @ stiffness @ u.ravel() / 2
        expected = 2.0 / (1 - poisson**2) * (1 / 12) * length / 2
        # Round-off of the terms that cancel in the product.
        terms = np.abs(u.ravel()) @ np.abs(stiffness) @ np.abs(u.ravel())
        assert energy == pytest.approx(expected, abs=8 * np.finfo(float).eps * terms)


@pytest.mark.parametrize(
    "corners",
    [
        [(0, 0), (1, 0), (0, 1), (0.4, 0.4)],  # a corner pushed in past the diagonal
        [(0, 0), (1, 0), (1, 1), (0, 1)],  # sides that cross
        [(0, 0), (1, 0), (0, 1), (0.5, 0.5)],  # a straight angle
    ],
)
def test_folded_cells_are_refused(corners: list[tuple[float, float]]) -> None:
    with pytest.raises(StructureError, match="not convex"):
        EnhancedCells(np.array([corners]), elasticity(0.3))
