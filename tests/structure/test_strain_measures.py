"""Measures of strain and the mixing of corrections, against numpy and scipy."""

import numpy as np
from scipy.linalg import logm, polar, svdvals
from structure.theories import gradients
from structure.theories.mixing import Mixing
from structure.stress import turned


def random_gradients(count: int) -> np.ndarray:
    """Displacement gradients of moderate stretches, every third turned by up to half a turn."""
    rng = np.random.default_rng(8)
    found = 0.25 * rng.uniform(-1, 1, size=(count, 2, 2))
    for k in range(0, count, 3):
        c, s = np.cos(angle := rng.uniform(-3, 3)), np.sin(angle)
        found[k] = np.array([[c, -s], [s, c]]) @ (np.eye(2) + found[k]) - np.eye(2)
    return found


def test_measures_are_those_of_polar_decomposition() -> None:
    given = random_gradients(60)
    strains, angles = gradients.logarithmic(given), gradients.rotation(given)
    greens, stretches = gradients.green_lagrange(given), gradients.least_stretch(given)
    for gradient, strain, angle, green, stretch in zip(given, strains, angles, greens, stretches, strict=True):
        deformation = np.eye(2) + gradient
        rotation, left = polar(deformation, side="left")
        expected = logm(left).real
        np.testing.assert_allclose(strain, [expected[0, 0], expected[1, 1], expected[0, 1]], atol=1e-13)
        np.testing.assert_allclose([np.cos(angle), np.sin(angle)], rotation[:, 0], atol=1e-13)
        expected = (deformation.T @ deformation - np.eye(2)) / 2
        np.testing.assert_allclose(green, [expected[0, 0], expected[1, 1], expected[0, 1]], atol=1e-14)
        np.testing.assert_allclose(stretch, svdvals(deformation)[-1], rtol=1e-13)


def test_no_strain_and_no_difference_of_stretches() -> None:
    """The quotient of the logarithms has a limit there."""
    np.testing.assert_array_equal(gradients.logarithmic(np.zeros((1, 2, 2))), 0.0)
    np.testing.assert_allclose(gradients.logarithmic(0.2 * np.eye(2)[None])[0], [np.log(1.2), np.log(1.2), 0.0])


def test_material_turned_inside_out_has_a_negative_stretch() -> None:
    inside_out = np.array([[-1.2, 0.0], [0.0, 0.0]])  # F = diag(-0.2, 1)
    assert np.isclose(gradients.least_stretch(inside_out[None])[0], -0.2)


def test_tensor_turns_like_its_matrix() -> None:
    xx, yy, xy, angle = 0.3, -0.1, 0.2, 0.7
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    expected = rotation @ np.array([[xx, xy], [xy, yy]]) @ rotation.T
    found = turned(np.array([xx, yy, xy]), angle)
    np.testing.assert_allclose(found, [expected[0, 0], expected[1, 1], expected[0, 1]], atol=1e-15)


def test_mixing_finds_what_corrections_miss_in_two_directions() -> None:
    """``c(x) = b - (1 + N) x`` with N of rank two, one eigenvalue of it above 1: alone, corrections diverge."""
    rng = np.random.default_rng(2)
    across = np.linalg.qr(rng.normal(size=(12, 2)))[0]
    matrix = np.eye(12) + across @ np.diag([1.7, -0.4]) @ across.T
    right = rng.normal(size=12)
    solution = np.linalg.solve(matrix, right)
    errors = {}
    for name, mixing in (("plain", None), ("mixed", Mixing(2, lambda sums: sums))):
        place = np.zeros(12)
        for _ in range(6):
            correction = right - matrix @ place
            place = place + (correction if mixing is None else mixing.step(place, correction))
        errors[name] = np.abs(place - solution).max()
    assert errors["plain"] > 1.0
    assert errors["mixed"] < 1e-12
