"""Discs against the boundary of a structure itself: momenta, energy, ranks, resumed runs, placement, stiffness ratio."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bad_scenes import TUBE, changed
from small_models import discs_on_free_beam

from coupled.balance import take_balance
from coupled.build import build
from coupled.interface.facets import FacetInterface
from coupled.model import Model
from coupled.output import checkpoint
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene
from coupled.templates import write_template
from meshes import beam, tube

FACETS = {"kind": "facets"}
EXCHANGES = {"predicted": {}, "substeps": {"substeps": 4}, "lagged": {"exchange": "lagged"}}
# As in test_coupled_balance: what is underway between the half step of the grains and the structure's step.
UNDERWAY = {"predicted": (0.5, 0.0), "substeps": (0.3125, -0.1875), "lagged": (1.0, 0.5)}


def moments(place: np.ndarray, force: np.ndarray) -> float:
    return float(place[:, 0] @ force[:, 1] - place[:, 1] @ force[:, 0])


@pytest.mark.parametrize("exchange", list(EXCHANGES))
def test_momentum_and_moment_pass_to_the_nodes(exchange: str) -> None:
    """Turning discs with friction and rolling resistance hit faces, an end and a corner of a free elastic beam."""
    discs = [[-0.07, 0.0105, 0.3, -1.0, 90.0], [0.03, 0.011, -0.1, -1.0, -60.0], [0.108, 0.0085, -0.7, -0.7, 50.0]]
    step = 5e-6
    model = discs_on_free_beam(discs, step=step, friction=0.5, interface=FACETS | EXCHANGES[exchange]).model
    now, before = UNDERWAY[exchange]
    start = model.particles.momentum() + model.structure.momentum()
    drift, touched, last = 0.0, 0, np.zeros(2)
    for _ in range(round(2e-3 / model.window)):
        model.advance(1)
        grains, facets = model.particles.grains, model.particles.facets
        on_grains = np.column_stack([grains.fx, grains.fy])
        scale = np.abs(on_grains).sum()
        total = moments(grains.position, on_grains) + grains.torque.sum() + moments(facets.places, facets.force)
        assert abs(total) <= 1e-15 * scale  # 0.1 m of lever arms, some roundings
        touched = max(touched, int((scale > 0.0) and np.count_nonzero(on_grains.any(axis=1))))
        assert model.particles.force_residual() <= 1e-14
        assert np.abs(model.nodal_force.sum(axis=0) - model.reaction).max() <= 1e-14 * np.abs(model.nodal_force).sum()
        underway = model.window * (now * model.reaction + before * last)
        kept = model.particles.momentum() + model.structure.momentum() + underway
        drift, last = max(drift, np.abs(kept - start).max()), model.reaction
    assert touched == 3
    # Round-off of the structure's equation: its internal forces, E u, are 1e4 times the contact forces.
    assert drift <= 1e-11 * np.abs(model.particles.momentum()).max()


def residuals(step: float, **options: Any) -> tuple[float, float]:
    """Largest errors of the ledger and of the works across the interface, over the energy; mean of three phases."""
    seen = []
    for phase in (0.0, 1 / 3, 2 / 3):
        height = 0.01 + 1e-3 + (0.1 + phase) * step
        model = discs_on_free_beam([[0.013, height, 0.1, -1.0, 40.0]], step=step, **options).model
        start, errors = take_balance(model, model.particles.look(), None).entries, []
        for _ in range(20):
            model.advance(round(1e-4 / step))
            balance = take_balance(model, model.particles.look(), start)
            errors.append((abs(balance.error), abs(balance.interface_residual)))
        energy = sum(start[name] for name in ("grains_kinetic", "grains_rotational"))
        seen.append(np.max(errors, axis=0) / energy)
    return tuple(np.mean(seen, axis=0))


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_energy_of_an_impact_is_kept_with_order_two(friction: float) -> None:
    energy, residual = np.array(
        [residuals(step, friction=friction, interface=FACETS) for step in (2e-5, 1e-5, 5e-6, 2.5e-6)]
    ).T
    halvings = np.arange(4)
    assert -np.polyfit(halvings, np.log2(energy), 1)[0] == pytest.approx(2.0, abs=0.15)
    assert energy[0] < 5e-4
    # The two works differ by the error of the prediction, (H omega)^3 of the fast elastic modes.
    assert -np.polyfit(halvings, np.log2(residual), 1)[0] > 1.8
    assert residual[0] < 5e-5


def rigid(shape: dict[str, Any], disc: list[float], step: float) -> Model:
    """A free rigid body at the origin and an elastic disc of 10 mm, without gravity."""
    tables = {
        "title": "A bounce on a free rigid polygon",
        "time": {"duration": 1.0, "step": step},
        "grains": {"sizes": [{"radius": 0.01, "count": 1}], "density": 1000.0, "layout": "list", "positions": [disc]},
        "contact": {"normal_stiffness": 1e6, "tangential_stiffness": 2e5, "friction": 0.3},
        "structure": {"kind": "free_rigid", "density": 500.0, "placement": {"x": 0.0, "y": 0.0}} | shape,
        "interface": FACETS,
    }
    return build(Scene.model_validate(tables)).model


@pytest.mark.parametrize(
    "disc", [[0.02, 0.065, 0.3, -1.0, 20.0], [-0.035, 0.07, 0.4, -1.0, -30.0]], ids=["right", "left"]
)
def test_energy_and_momenta_of_a_bounce_on_a_free_rigid_polygon(disc: list[float]) -> None:
    """A ring of 12 sides is struck off its centre, slips, turns and flies away."""
    shape = {"tube": {"outer_radius": 0.05, "inner_radius": 0.03, "around": 12}}
    errors, spins = [], []
    for step in (1e-5, 5e-6, 2.5e-6):
        model = rigid(shape, disc, step)
        body, grains = model.structure, model.particles.grains
        mass = grains.mass[0]

        def momenta(model: Model = model, mass: float = mass) -> np.ndarray:
            body, g = model.structure, model.particles.grains
            linear = model.particles.momentum() + body.momentum()
            orbit = mass * (g.x[0] * g.vy[0] - g.y[0] * g.vx[0]) + g.inertia[0] * g.omega[0]
            at, speed = body.centroid(), body.momentum()
            spin = 2.0 * (body.energies().kinetic - 0.5 * speed @ speed / body.mass) / body.inertia
            turn = np.sqrt(max(spin, 0.0)) * np.sign(body.mean_rotation())
            return np.array([*linear, orbit + at[0] * speed[1] - at[1] * speed[0] + body.inertia * turn])

        before = momenta()
        start = take_balance(model, model.particles.look(), None).entries
        model.advance(round(0.03 / step))
        balance = take_balance(model, model.particles.look(), start)
        after = momenta()
        assert np.hypot(*body.momentum()) > 0.1 * np.hypot(*model.particles.momentum())
        np.testing.assert_allclose(after[:2], before[:2], atol=1e-12 * mass)
        errors.append((abs(balance.error) / start["grains_kinetic"], abs(after[2] - before[2]) / (mass * 0.05)))
        spins.append(body.mean_rotation())
    energy, angular = np.array(errors).T
    # Kinks where the contact begins, slips and ends fall anywhere in a step: some 1e-5 at all three.
    assert energy.max() < 1e-4
    # The forces act at the predicted places of the nodes, and go to the body where it then is: order 2.
    assert angular[0] < 1e-6
    assert np.log2(angular[:-1] / angular[1:]) == pytest.approx([2.0, 2.0], abs=0.1)
    assert abs(spins[2]) > 0.01 and spins[2] == pytest.approx(spins[1], rel=1e-4)


RANKS = """
import sys
import numpy as np
from mpi4py import MPI
from coupled.build import build
from coupled.scene import load_scene

scene = load_scene("winkler_beam", ["structure.loads.0.schedule.over=0.02", 'interface.kind="facets"'])
model = build(scene).model
model.advance(1500)
if MPI.COMM_WORLD.rank == 0:
    np.savez(sys.argv[1], u=model.structure.boundary_displacement, f=model.nodal_force, r=model.contact_force)
"""


def test_two_ranks_give_the_answer_of_one(tmp_path: Path) -> None:
    permitted = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    found = []
    for ranks in (1, 2):
        target = tmp_path / f"{ranks}.npz"
        command = ["mpirun", "-n", str(ranks), "--oversubscribe", sys.executable, "-c", RANKS, str(target)]
        done = subprocess.run(command, env=os.environ | permitted, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        found.append(np.load(target))
    for name in ("u", "f", "r"):
        scale = np.abs(found[0][name]).max()
        # another order of sums inside the solver, amplified by 1500 steps
        assert np.abs(found[1][name] - found[0][name]).max() <= 1e-9 * scale, name


def test_resumed_run_has_the_bits_of_one_that_was_not_stopped(tmp_path: Path) -> None:
    """The tube on its bed: grains, contacts and histories on facets."""
    path = write_template("tube", tmp_path / "tube.toml")
    quick = ["interface.kind=facets", "output.figures=false", "output.checkpoint_interval=0.02"]
    whole = run_scene(
        load_scene(path, [*quick, "time.duration=0.12"]), out=tmp_path / "whole", threads=1, progress=False
    )
    part = run_scene(load_scene(path, [*quick, "time.duration=0.06"]), out=tmp_path / "part", threads=1, progress=False)
    run_scene(load_scene(path, [*quick, "time.duration=0.12"]), out=part, resume=True, threads=1, progress=False)
    one, _ = checkpoint.load(whole / "checkpoint.h5")
    other, _ = checkpoint.load(part / "checkpoint.h5")
    assert one.keys() == other.keys() and "particles.facets.spring" in one
    assert np.count_nonzero(one["particles.facets.spring"]) > 0
    for name in one.keys() - {"run.seconds"}:
        np.testing.assert_array_equal(one[name], other[name], err_msg=name)
    rows = [np.loadtxt(folder / "history.csv", delimiter=",", skiprows=1)[-1] for folder in (whole, part)]
    assert np.array_equal(*rows)


def test_structure_is_lowered_until_it_touches_the_bed(tmp_path: Path) -> None:
    """Lowered by 1 um more, and only then, it touches; whatever lies below, disc or floor."""
    for places in ([[0.03, 0.004], [0.052, 0.004]], [[0.05, 0.004], [0.061, 0.03]], [[0.01, 0.004], [0.09, 0.004]]):
        grains = {"layout": "list", "positions": places, "density": 1600.0, "sizes": [{"radius": 0.003, "count": 2}]}
        for sunk, touches in ((-1e-6, True), (1e-6, False)):
            scene = changed(TUBE, {"interface": FACETS, "grains": grains, "gravity": [0.0, 0.0]})
            height = build(Scene.model_validate(scene)).model.structure.centroid()[1]
            scene["structure"]["placement"] = {"x": 0.05, "y": height + sunk}
            if height + sunk < 0.02:  # the floor came first, which a scene may not pass
                assert height == pytest.approx(0.02, rel=0.01)
                continue
            model = build(Scene.model_validate(scene)).model
            assert (model.particles.look().count > 0) == touches


def test_closest_contacts_are_as_close_as_the_smallest_grains() -> None:
    line = beam(length=1.0, height=0.1, along=10, across=2).outer_polyline
    few, many = (FacetInterface(line, boundaries=("bottom",), closest=c).operator for c in (0.24, 0.02))
    place = line.points[:, 0]
    np.testing.assert_allclose(few @ place - place.min(), [0.0, 0.3, 0.6, 0.9], atol=1e-12)  # on nodes 0.1 m apart
    np.testing.assert_allclose(many @ place - place.min(), np.linspace(0.0, 1.0, 51), atol=1e-12)
    ring = tube(outer_radius=0.05, inner_radius=0.04, around=30).outer_polyline
    assert FacetInterface(ring, closest=4e-3).operator.shape[0] == 60  # facets of 10.5 mm
    assert FacetInterface(ring).operator.shape[0] == 30


def test_stiffness_ratio_of_the_row_is_that_of_glued_grains_above_it() -> None:
    """121 discs of 8.2 mm on facets of 25 mm: as many and where the glued grains are."""
    facets, glued = (build(load_scene("winkler_beam", [f"interface.kind={kind}"])) for kind in ("facets", "glued"))
    assert facets.stiffness_ratio == pytest.approx(glued.stiffness_ratio, rel=1e-3)  # of the power iteration
