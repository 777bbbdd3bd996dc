"""Five answers to the same questions: every kind of structure through the one interface, `Structure`."""

from collections.abc import Callable

import meshes
import numpy as np
import pytest
from moving import balance, exchanged
from structure import BodyForce, ElasticStructure, FreeRigid, PlaneStrain, PrescribedRigid, Structure

SOFT = PlaneStrain(youngs_modulus=70e5, poissons_ratio=0.35, density=2700.0)
STEP, FALL = 1e-4, np.array([0.5, -9.81])


def elastic(theory: str) -> Callable[[meshes.StructureMesh], Structure]:
    loads = [BodyForce(acceleration=tuple(FALL))]
    return lambda mesh: ElasticStructure(mesh, material=SOFT, time_step=STEP, loads=loads, theory=theory)


KINDS: dict[str, Callable[[meshes.StructureMesh], Structure]] = {
    "prescribed": lambda mesh: PrescribedRigid(mesh, path=[(0, 0, 0), (1, 2, -3)], time_step=STEP, density=2700.0),
    "free_rigid": lambda mesh: FreeRigid(
        mesh, density=2700.0, time_step=STEP, loads=[BodyForce(acceleration=tuple(FALL))]
    ),
    **{theory: elastic(theory) for theory in ("linear", "corotational", "large_strain")},
}


@pytest.fixture(scope="module")
def tube() -> meshes.StructureMesh:
    return meshes.tube(outer_radius=0.05, inner_radius=0.04)


@pytest.mark.parametrize("kind", KINDS)
def test_momentum_and_energy_are_those_of_the_forces(kind: str, tube: meshes.StructureMesh) -> None:
    body = KINDS[kind](tube)
    rng = np.random.default_rng(3)
    before, momentum = balance(body.energies()), body.momentum()
    last, impulse = np.zeros_like(body.polyline.points), np.zeros(2)
    for _ in range(100):
        force = rng.normal(size=last.shape)
        body.advance(force)
        impulse += STEP * (last + force).sum(axis=0) / 2
        last = force
    assert body.time == pytest.approx(100 * STEP)
    after = body.energies()
    # 100 steps of sums over some hundred terms.
    assert abs(balance(after) - before) < 1e4 * np.finfo(float).eps * exchanged(after)
    if kind == "prescribed":
        np.testing.assert_array_equal(body.momentum(), body.mass * np.array([2.0, -3.0]))
    else:
        np.testing.assert_allclose(body.momentum() - momentum, impulse + 100 * STEP * body.mass * FALL, rtol=1e-10)
        np.testing.assert_allclose(body.external_force(), body.mass * FALL, rtol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_all_say_where_they_are_and_will_be(kind: str, tube: meshes.StructureMesh) -> None:
    body = KINDS[kind](tube)
    push = np.zeros_like(body.polyline.points)
    push[0] = [0.0, 1.0]
    body.begin_under(push)
    # At once a force on a node pulls that node; nothing pulls a prescribed one.
    pull = body.acceleration_by(push)[0]
    assert pull @ [0.0, 1.0] > 0 or kind == "prescribed"
    for _ in range(20):
        body.advance(push)
    ahead = body.predict(STEP)
    body.advance(push)
    moved = np.abs(body.boundary_velocity).max() * STEP
    np.testing.assert_allclose(body.boundary_displacement, ahead, atol=0.05 * moved)
    fields, peaks = body.fields(), body.peaks()
    np.testing.assert_allclose(
        fields.point_data["displacement"][tube.outer_nodes], body.boundary_displacement, rtol=0, atol=1e-15
    )
    assert (peaks.strain > 0) == (peaks.von_mises > 0) == (kind in ("linear", "corotational", "large_strain"))
    assert body.centroid().shape == (2,) and abs(body.mean_rotation()) < 0.1


@pytest.mark.parametrize("kind", KINDS)
def test_state_is_taken_up_again_to_the_bit(kind: str, tube: meshes.StructureMesh) -> None:
    straight, resumed = KINDS[kind](tube), KINDS[kind](tube)
    push = np.random.default_rng(5).normal(size=straight.polyline.points.shape)
    for _ in range(10):
        straight.advance(push)
    resumed.restore(straight.state())
    for _ in range(10):
        straight.advance(push)
        resumed.advance(push)
    for name, array in straight.state().items():
        np.testing.assert_array_equal(resumed.state()[name], array, err_msg=name)


@pytest.mark.parametrize("kind", KINDS)
def test_steps_from_a_snapshot_have_the_same_bits(kind: str, tube: meshes.StructureMesh) -> None:
    body = KINDS[kind](tube)
    push = np.random.default_rng(5).normal(size=body.polyline.points.shape)
    for _ in range(5):
        body.advance(push)
    kept = body.snapshot()
    for _ in range(2):  # twice: a step after going back must not write into what was kept
        for _ in range(5):
            body.advance(push)
        wanted = {name: np.array(array) for name, array in body.state().items()}
        body.rewind(kept)
        for _ in range(3):
            body.advance(-push)
        body.rewind(kept)
    for _ in range(5):
        body.advance(push)
    for name, array in body.state().items():
        np.testing.assert_array_equal(array, wanted[name], err_msg=name)
    np.testing.assert_array_equal(body.boundary_displacement, body.predict(0.0, order=1))
