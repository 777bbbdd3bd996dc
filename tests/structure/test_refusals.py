"""Bad numbers are refused by name in one sentence."""

import meshes
import numpy as np
import pytest
from structure import (
    BodyForce,
    BoundaryLoad,
    ElasticStructure,
    FreeRigid,
    Newmark,
    PlaneStrain,
    PointLoad,
    PrescribedRigid,
    Ramp,
    Rayleigh,
    StructureError,
)

STEEL = {"youngs_modulus": 200e9, "poissons_ratio": 0.3, "density": 7800.0}


def mesh() -> meshes.StructureMesh:
    return meshes.beam(length=1.0, height=0.1, along=10, across=1)


def elastic(**options) -> ElasticStructure:
    return ElasticStructure(mesh(), **({"material": PlaneStrain(**STEEL), "time_step": 1e-5} | options))


def enhanced(**options) -> ElasticStructure:
    other = meshes.beam(length=1.0, height=0.1, along=10, across=1, **options)
    return ElasticStructure(other, material=PlaneStrain(**STEEL), time_step=1e-5, element="enhanced")


def path(*rows) -> PrescribedRigid:
    return PrescribedRigid(mesh(), path=rows, time_step=1.0)


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: PlaneStrain(**STEEL | {"poissons_ratio": 0.5}), "poissons_ratio = 0.5"),
        (lambda: PlaneStrain(**STEEL | {"youngs_modulus": -1.0}), "youngs_modulus = -1.0"),
        (lambda: PlaneStrain(**STEEL | {"density": float("inf")}), "density = inf"),
        (lambda: Rayleigh(mass_factor=-0.1, stiffness_factor=0.0), "mass_factor = -0.1"),
        (lambda: Newmark(beta=0.25, gamma=0.4), "gamma = 0.4"),
        (lambda: Newmark(beta=0.25, gamma=0.6), "beta = 0.25"),
        (lambda: Newmark(beta=0.0, gamma=0.5), "beta = 0.0"),
        (lambda: BodyForce(acceleration=(0.0, float("nan"))), "acceleration"),
        (lambda: BodyForce(acceleration=(0.0, 1.0), schedule=Ramp(over=-1.0)), "over = -1.0"),
        (lambda: elastic(time_step=0.0), "time_step = 0.0"),
        (
            lambda: elastic(loads=[BoundaryLoad(boundary="loaded_arc", total_force=(0.0, 1.0))]),
            "bottom, left, outer, right, top",
        ),
        (
            lambda: elastic(loads=[PointLoad(point=(0.5, 0.3), force=(0.0, 1.0))]),
            "point = (0.5, 0.3)",
        ),
        (lambda: elastic(loads=["gravity"]), "'gravity'"),
        (lambda: elastic(element="reduced"), "element = 'reduced' is not known: use one of standard, enhanced"),
        (lambda: enhanced(order=2), "not for a quadrilateral of order 2"),
        (lambda: enhanced(cell="triangle"), "not for a triangle of order 1"),
        (lambda: elastic().advance(np.zeros((3, 2))), "boundary_force has shape (3, 2)"),
        (lambda: elastic().set_initial(displacement=np.zeros((3, 2))), "displacement"),
        (lambda: elastic().release_from_mode(0, 1e-3), "mode 0"),
        (lambda: elastic().release_from_mode(1, 0.0), "amplitude"),
        (lambda: elastic().frequencies(1000), "mode 1000"),
        (lambda: path((0, 0, 0), (1, 0, -0.1), (1, 0, 0)), "later"),
        (lambda: path((1, 0, 0), (2, 0, -0.1)), "first row"),
        (lambda: path((0, 0), (2, 0)), "path of shape (2, 2)"),
        (lambda: FreeRigid(mesh(), density=0.0, time_step=1.0), "density = 0.0"),
    ],
)
def test_bad_numbers(build, words: str) -> None:
    with pytest.raises(StructureError) as refusal:
        build()
    assert words in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_accepted_pairs() -> None:
    assert Newmark(beta=0.3025, gamma=0.6).gamma == 0.6
    assert Rayleigh(mass_factor=0.005, stiffness_factor=0.0).overdamped_above == np.inf
