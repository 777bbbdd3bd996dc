"""Momentum, angular momentum and work across the interface, with every interface, exchange and kind of structure."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bad_scenes import RIGID, changed
from collision import DISCS, Collision, collision
from mpi_runs import on_ranks
from small_models import BODIES, discs_on_free_beam
from ways import EXCHANGES

from coupled.build import build
from coupled.interface.couples import FacetCouples
from coupled.model import Model
from coupled.running.observe import observe
from coupled.scene import Scene

INTERFACES: dict[str, dict[str, Any]] = {
    "facets": {"kind": "facets"},
    "glued": {"couple": True},
    "glued, torque dropped": {"couple": False},
}
KEEPING = ("facets", "glued")
STEPS = (4e-5, 2e-5, 1e-5)


def of(interface: str, exchange: str, body: str, step: float = STEPS[1]) -> Collision:
    return collision(tuple((INTERFACES[interface] | EXCHANGES[exchange]).items()), body, step)


def orders(errors: list[float]) -> np.ndarray:
    return np.log2(np.abs(errors[:-1]) / np.abs(errors[1:]))


@pytest.mark.parametrize("body", list(BODIES))
@pytest.mark.parametrize("exchange", list(EXCHANGES))
@pytest.mark.parametrize("interface", list(INTERFACES))
def test_momentum_is_kept(interface: str, exchange: str, body: str) -> None:
    """Before and after, whatever was underway between both halves of the step while they touched."""
    seen = of(interface, exchange, body)
    assert seen.work > 0.3 and seen.turned > 1e-4
    # Round-off of the structure's equation: its internal forces, E u, are 1e4 times the contact forces, and a row of
    # the stiffness sums 18 of them: 1e4 sqrt(18) eps = 9e-12.
    assert np.abs(seen.drift[:2]).max() < 1e-11


@pytest.mark.parametrize("body", ["corotational", "rigid"])
@pytest.mark.parametrize("interface", KEEPING)
def test_angular_momentum_is_kept(interface: str, body: str) -> None:
    """Forces act at the predicted places of the nodes, and go to the body where it then is: order 2; 1 if it lags."""
    drift = [of(interface, "predicted", body, step).drift[2] for step in STEPS]
    assert abs(drift[0]) < 5e-8
    # Facets on the rigid body begin at 7e-9, where it is seen at which moment of a step a disc touches.
    assert orders(drift)[1] == pytest.approx(2.0, abs=0.2)
    # Forces of a window are summed, their places are not: of the size of what the prediction makes.
    for exchange in ("substeps", "iterated", "iterated-substeps"):
        assert abs(of(interface, exchange, body, STEPS[0]).drift[2]) < 5e-8
    lagged = [of(interface, "lagged", body, step).drift[2] for step in STEPS]
    assert abs(lagged[0]) < 1e-5
    assert orders(lagged) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("exchange", list(EXCHANGES))
@pytest.mark.parametrize("body", ["corotational", "rigid"])
def test_moment_dropped_is_what_is_lost(body: str, exchange: str) -> None:
    """Of a body that keeps its angular momentum; the rest is the error of the exchange, as with nothing dropped."""
    seen, kept = of("glued, torque dropped", exchange, body), of("glued", exchange, body)
    assert abs(seen.dropped) > 1e-4
    assert abs(seen.drift[2] + seen.dropped) < (1e-5 if exchange == "lagged" else 5e-8)
    assert kept.dropped == 0.0


def test_linear_theory_keeps_the_moment_about_the_first_shape_alone() -> None:
    """What the interface passes is right, and yet angular momentum is off, at any step."""
    drift = [of("glued", "predicted", "elastic", step).drift[2] for step in STEPS]
    assert np.abs(drift).min() > 1e-4
    assert orders(drift) == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize(
    ("exchange", "order", "largest"), [("predicted", 3, 1e-5), ("substeps", 2, 5e-5), ("lagged", 1, 0.02)]
)
@pytest.mark.parametrize("body", ["elastic", "corotational"])
@pytest.mark.parametrize("interface", list(INTERFACES))
def test_both_works_agree_with_the_order_of_the_exchange(
    interface: str, body: str, exchange: str, order: int, largest: float
) -> None:
    """Over the energy of the discs, after the blow; of the windows the worst is one in which a disc touches."""
    seen = [of(interface, exchange, body, step) for step in STEPS]
    assert abs(seen[1].residual) < largest
    assert orders([one.residual for one in seen])[1] == pytest.approx(order, abs=0.1)
    assert orders([one.worst_window for one in seen])[1] > 1.6


@pytest.mark.parametrize("body", ["elastic", "rigid"])
@pytest.mark.parametrize("exchange", ["iterated", "iterated-substeps"])
@pytest.mark.parametrize("interface", list(INTERFACES))
def test_iterated_works_agree_to_its_tolerance(interface: str, exchange: str, body: str) -> None:
    """At any step: a window's works may differ by 1e-6 of its own, the places of its end being known to that."""
    for step in STEPS:
        seen = of(interface, exchange, body, step)
        assert abs(seen.residual) < 1e-6 * seen.work
        assert seen.worst_window < 1e-6 * seen.work


@pytest.mark.parametrize("interface", list(INTERFACES))
def test_works_agree_to_round_off_on_a_prescribed_path(interface: str) -> None:
    """The predicted places are the places."""
    grains = {"layout": "list", "positions": [[0.046, 0.0025], [0.055, 0.0025]], "density": 1600.0}
    table = changed(
        RIGID,
        {
            "interface": {"per_facet": 2} | INTERFACES[interface],
            "grains": grains | {"sizes": [{"radius": 2.5e-3, "count": 2}]},
            "structure.path.points": [[0.0, 0.0, 0.0], [0.01, 0.0005, -0.0005], [1.0, 0.02, -0.0005]],
        },
    )
    model = build(Scene.model_validate(table)).model
    model.advance(3000)
    numbers = observe(model, None).numbers
    assert numbers["interface_work"] > 1e-4
    assert abs(numbers["interface_residual"]) < 1e-13 * numbers["interface_work"] * np.sqrt(3000)
    assert ("moment_dropped" in numbers) == (interface == "glued, torque dropped")


def node_places(model: Model) -> np.ndarray:
    """Where the grains see the nodes, from the places of facets or glued grains."""
    particles = model.particles
    if particles.facets is not None:
        return particles.facets.places
    glued = particles.grains.position[particles.grains.n_free :]
    return np.linalg.lstsq(model.interface.operator.toarray(), glued, rcond=None)[0]


@pytest.mark.parametrize("body", list(BODIES))
@pytest.mark.parametrize("interface", KEEPING)
def test_moment_of_the_nodal_forces_is_that_of_the_contacts(interface: str, body: str) -> None:
    """Friction, rolling resistance and dashpots, at every step of the collision, to round-off."""
    table = INTERFACES[interface] | {"largest_stiffness_ratio": 100.0}
    model = discs_on_free_beam(DISCS, step=2e-5, friction=0.5, interface=table, body=BODIES[body], damping=50.0).model
    touched = 0
    for _ in range(350):
        model.advance(1)
        g, places = model.particles.grains, node_places(model)
        free = slice(g.n_free)
        force = np.abs(g.fx[free]).sum() + np.abs(g.fy[free]).sum()
        on_discs = g.x[free] @ g.fy[free] - g.y[free] @ g.fx[free] + g.torque[free].sum()
        on_nodes = places[:, 0] @ model.nodal_force[:, 1] - places[:, 1] @ model.nodal_force[:, 0]
        assert (
            abs(on_discs + on_nodes) <= 1e-14 * force
        )  # 0.1 m of lever arms, some roundings and the solution for places
        touched += force > 0.0
    assert touched > 50


def chain(closed: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places of two grains per facet on a bent chain, its facets by their grains, facets of the grains."""
    nodes = np.array([[0.0, 0.0], [1.0, 0.1], [1.5, 0.8], [0.4, 1.2]])
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])[: 4 if closed else 3]
    middle = nodes[ends].mean(axis=1)
    places = np.concatenate([np.stack([nodes[ends[:, 0]], middle], axis=1).reshape(-1, 2), nodes[len(ends) :]])
    on = np.append(np.repeat(np.arange(len(ends)), 2), [] if closed else [2]).astype(int)
    first = 2 * np.arange(len(ends))
    second = np.roll(first, -1) if closed else first + 2
    return places, np.column_stack([first, second]), on


@pytest.mark.parametrize("closed", [True, False])
def test_couples_do_the_work_of_the_torques(closed: bool) -> None:
    """For any torques and any motion; and they are couples: no resultant, the moment of the torques."""
    places, facets, on = chain(closed)
    random = np.random.default_rng(4)
    couples, torque = FacetCouples(facets, on), random.normal(size=len(on))
    after = places + 0.1 * random.normal(size=places.shape)
    spins = couples.spins(places, after, 0.01)
    force = couples.over_window(torque)
    assert np.vdot(force, after - places) == pytest.approx(0.01 * torque @ spins, rel=1e-13)
    now = couples.now(torque, places)
    np.testing.assert_allclose(now.sum(axis=0), 0.0, atol=1e-14 * np.abs(now).sum())
    assert places[:, 0] @ now[:, 1] - places[:, 1] @ now[:, 0] == pytest.approx(torque.sum(), rel=1e-13)


def test_glued_grains_turn_with_the_body() -> None:
    """A straight way from end to end of an arc turns by 2 tan(a/2), and a stretch not at all."""
    places, facets, on = chain(True)
    couples, angle = FacetCouples(facets, on), 0.2
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    assert couples.spins(places, places @ turn.T + [0.3, 0.1], 0.5) == pytest.approx(2 * np.tan(angle / 2) / 0.5)
    assert couples.spins(places, 1.1 * places, 0.5) == pytest.approx(0.0, abs=1e-14)


def test_sums_of_a_resumed_run_have_the_same_bits() -> None:
    table = INTERFACES["glued, torque dropped"] | EXCHANGES["substeps"]
    whole, part, again = (discs_on_free_beam(DISCS, step=5e-6, friction=0.5, interface=table).model for _ in range(3))
    whole.advance(200)
    part.advance(130)
    again.restore(part.state())
    again.advance(70)
    assert whole.exchanged.work > 0.0 and whole.exchanged.dropped > 0.0
    assert again.exchanged == whole.exchanged
    np.testing.assert_array_equal(again.structure.boundary_displacement, whole.structure.boundary_displacement)


RANKS = """
import sys
import numpy as np
from mpi4py import MPI
from collision import DISCS
from small_models import BODIES, discs_on_free_beam

for body in BODIES:
    model = discs_on_free_beam(DISCS, step=1e-5, friction=0.5, body=BODIES[body]).model
    model.advance(400)
    if MPI.COMM_WORLD.rank == 0:
        u, turn = model.structure.boundary_displacement, model.particles.grains.omega
        np.savez(f"{sys.argv[1]}/{body}{MPI.COMM_WORLD.size}.npz", u=u, turn=turn, sums=np.array(model.exchanged))
"""


def test_two_ranks_give_the_answer_of_one(tmp_path: Path) -> None:
    for ranks in (1, 2):
        done = on_ranks(ranks, "-c", RANKS, tmp_path, cwd=Path(__file__).parent)
        assert done.returncode == 0, done.stderr
    for body in BODIES:
        one, two = (np.load(tmp_path / f"{body}{ranks}.npz") for ranks in (1, 2))
        for name in ("u", "turn", "sums"):
            # another order of sums inside the solver, amplified by 400 steps
            assert np.abs(one[name] - two[name]).max() <= 1e-9 * np.abs(one[name]).max(), (body, name)
