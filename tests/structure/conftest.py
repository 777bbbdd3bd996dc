"""Materials and shapes shared by the tests of the room; makes its helper `held` importable."""

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import meshes
import numpy as np
import pytest
from structure import PlaneStrain

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture
def aluminium() -> PlaneStrain:
    return PlaneStrain(youngs_modulus=70e9, poissons_ratio=0.35, density=2700.0)


@pytest.fixture
def soft() -> PlaneStrain:
    """Stiffness and step of the same order as inertia: nothing hides in round-off."""
    return PlaneStrain(youngs_modulus=70e5, poissons_ratio=0.35, density=2700.0)


@pytest.fixture
def distort() -> Callable[[meshes.StructureMesh], meshes.StructureMesh]:
    """Moves the inside of a unit square's mesh by up to 0.09, the boundary stays."""

    def moved(mesh: meshes.StructureMesh) -> meshes.StructureMesh:
        x, y = mesh.points.T
        swell = np.sin(np.pi * x) * np.sin(np.pi * y)
        points = mesh.points + np.column_stack([0.09 * swell, -0.07 * swell * np.cos(3 * x)])
        geometry = mesh.domain.geometry
        geometry.x[:, :2] = points[np.asarray(geometry.input_global_indices)]
        return replace(mesh, points=points)

    return moved
