"""Free vibration: energy kept, modes damped by Rayleigh's ratios, steps stable up to where they must be."""

import meshes
import numpy as np
import pytest
from formulations import FORMULATIONS, NAMES
from held import HeldBody
from scipy.linalg import eigh
from structure import ElasticStructure, Newmark, PlaneStrain, Rayleigh, StructureError

CASES = pytest.mark.parametrize(("cell", "order", "element", "_"), FORMULATIONS, ids=NAMES)


def block(cell: str, order: int) -> meshes.StructureMesh:
    return meshes.beam(length=1.0, height=0.5, along=4, across=2, cell=cell, order=order)


def frequencies(mesh: meshes.StructureMesh, material: PlaneStrain, element: str) -> np.ndarray:
    """All elastic angular frequencies [rad/s], ascending, by a dense solver."""
    body = HeldBody(mesh, material, element)
    return np.sqrt(eigh(body.stiffness.toarray(), body.mass.toarray(), eigvals_only=True)[3:])


def free(body: ElasticStructure, steps: int) -> None:
    rest = np.zeros_like(body.polyline.points)
    for _ in range(steps):
        body.advance(rest)


@pytest.mark.parametrize("stretch", [0.1, 1.0, 100.0])
@CASES
def test_energy_is_kept_to_round_off(
    cell: str, order: int, element: str, _: int, stretch: float, soft: PlaneStrain
) -> None:
    """Average acceleration without damping, from any shape at rest, steps of `stretch` radians of the fastest mode."""
    mesh = block(cell, order)
    fastest = frequencies(mesh, soft, element)[-1]
    body = ElasticStructure(mesh, material=soft, time_step=stretch / fastest, element=element)
    body.set_initial(displacement=1e-3 * np.random.default_rng(2).normal(size=mesh.points.shape))
    energies = []
    for _ in range(20):
        e = body.energies()
        energies.append((e.kinetic, e.strain))
        free(body, 25)
    kinetic, strain = np.array(energies).T
    assert np.ptp(strain) > 1e-3 * strain.max()  # it does change hands
    # Round-off of K u, relative eps, moves a node by eps (w dt)^2/4 of u in each of 500 steps; that of the solves
    # and of the sums counts as w dt = 6.
    whole = kinetic + strain
    assert np.abs(whole - whole[0]).max() < 500 * np.finfo(float).eps * max(36, stretch**2) / 4 * whole[0]


def energy(body: ElasticStructure) -> float:
    return body.energies().kinetic + body.energies().strain


def decay(body: ElasticStructure, number: int, steps: int) -> np.ndarray:
    """Exponents (2,) [1/s] of the motion from elastic mode `number` at rest.

    Whatever the damping, one mode obeys ``x(n+1) - (p + q) x(n) + p q x(n-1) = 0`` with p = exp(s1 dt),
    q = exp(s2 dt): fitted, not assumed to swing.
    """
    body.release_from_mode(number, 1e-3)
    shape = body.boundary_displacement.ravel()
    shape = shape / (shape @ shape)
    swing = []
    for _ in range(steps):
        swing.append(body.boundary_displacement.ravel() @ shape)
        free(body, 1)
    x = np.array(swing)
    system = np.column_stack([x[1:-1], -x[:-2]])
    both, product = np.linalg.lstsq(system, x[2:], rcond=None)[0]
    return np.log(np.roots([1.0, -both, product]).astype(complex)) / body.time_step


@pytest.mark.parametrize("number", [1, 2, 5])
@pytest.mark.parametrize(
    ("of_mass", "of_stiffness"),
    [(0.06, 0.0), (0.0, 0.04), (0.02, 0.04), (0.0, 2.5), (3.0, 0.0), (1.0, 2.0)],
    ids=["mass", "stiffness", "both", "over-damped by stiffness", "over-damped by mass", "over-damped by both"],
)
@pytest.mark.parametrize("element", ["standard", "enhanced"])
def test_rayleigh_damps_each_mode_by_its_ratio(
    element: str, of_mass: float, of_stiffness: float, number: int, soft: PlaneStrain
) -> None:
    """``zeta = (c_a/w + c_b w)/2``; the numbers are c_a and c_b in terms of the mode's own frequency."""
    mesh = meshes.beam(length=1.0, height=0.1, along=20)
    omega = 2 * np.pi * ElasticStructure(mesh, material=soft, time_step=1.0, element=element).frequencies(number)[-1]
    damping = Rayleigh(mass_factor=of_mass * omega, stiffness_factor=of_stiffness / omega)
    body = ElasticStructure(mesh, material=soft, time_step=0.02 / omega, damping=damping, element=element)
    one, other = decay(body, number, 600 if of_mass + of_stiffness < 2 else 150)
    zeta = (of_mass + of_stiffness) / 2
    assert damping.overdamped_above == pytest.approx(2 * omega / of_stiffness if of_stiffness else np.inf)
    if zeta < 1:
        assert one.imag != 0.0 and other == one.conjugate()
        # (w dt)^2/12 of the period, as much of the damping
        assert -one.real / abs(one) == pytest.approx(zeta, rel=2e-4)
        assert abs(one) == pytest.approx(omega, rel=2e-4)
    else:
        exact = omega * (-zeta + np.array([1, -1]) * np.sqrt(zeta**2 - 1))
        assert np.abs([one.imag, other.imag]).max() < 1e-6 * omega
        # of exp(s dt) the step keeps (1 + s dt/2)/(1 - s dt/2): (s dt)^2/12 with s up to 2.6 w
        assert sorted([one.real, other.real], reverse=True) == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize(("beta", "gamma"), [(0.25, 0.5), (0.3025, 0.6), (0.5625, 1.0)])
@CASES
def test_stable_pairs_are_stable_for_every_step(
    cell: str, order: int, element: str, _: int, beta: float, gamma: float, soft: PlaneStrain
) -> None:
    mesh = block(cell, order)
    fastest = frequencies(mesh, soft, element)[-1]
    scheme = Newmark(beta=beta, gamma=gamma)
    for product in (1.0, 3.47, 30.0, 1e3):
        body = ElasticStructure(mesh, material=soft, time_step=product / fastest, scheme=scheme, element=element)
        body.set_initial(displacement=1e-3 * np.random.default_rng(1).normal(size=mesh.points.shape))
        before = energy(body)
        free(body, 300)
        # Round-off as above, 2e-8 at the longest step.
        assert energy(body) < (1 + 1e-7) * before


@CASES
def test_linear_acceleration_is_stable_below_its_limit_and_not_above(
    cell: str, order: int, element: str, _: int, soft: PlaneStrain
) -> None:
    """(1/6, 1/2): omega dt up to sqrt(12) = 3.46, of the highest frequency that the body has."""
    with pytest.raises(StructureError, match="allow_conditional"):
        Newmark(beta=1 / 6, gamma=0.5)
    mesh = meshes.beam(length=1.0, height=0.5, along=2, across=1, cell=cell, order=order)
    highest = frequencies(mesh, soft, element)[-1]
    scheme = Newmark(beta=1 / 6, gamma=0.5, allow_conditional=True)
    growth = {}
    for share in (0.99, 1.01):
        step = share * np.sqrt(12) / highest
        body = ElasticStructure(mesh, material=soft, time_step=step, scheme=scheme, element=element)
        body.set_initial(displacement=1e-3 * np.random.default_rng(1).normal(size=mesh.points.shape))
        sizes = [energy(body) ** 0.5]
        for _ in range(40):
            free(body, 20)
            sizes.append(energy(body) ** 0.5)
        growth[share] = np.array(sizes) / sizes[0]
    # Below, ``v.M v + u.(K - w^2 M) u`` is kept: a mode near the limit wavers by 1/sqrt(1 - share^2) = 7.
    assert growth[0.99].max() < 8
    # Above, each step multiplies the fastest mode by the root beyond -1 of z + 1/z = 2 - x/(1 + x/6), x = 12 share^2.
    x = 12 * 1.01**2
    both = 2 - x / (1 + x / 6)
    largest = (np.sqrt(both**2 - 4) - both) / 2
    assert (growth[1.01][-1] / growth[1.01][-11]) ** (1 / 200) == pytest.approx(largest, rel=1e-3)
    assert growth[1.01][-1] > 1e10
