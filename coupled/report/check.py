"""What a scene would cost and how close it is to its limits, before it runs."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

from mpi4py import MPI

from coupled import bed as beds
from coupled.bodies import stable_ratio
from coupled.build import Built, build
from coupled.loads import load_rows
from coupled.output.folder import SUMMARY
from coupled.report import cautions
from coupled.report.contact import contact_rows
from coupled.report.duration import spoken
from coupled.report.need_rows import need_rows
from coupled.report.needs import without_need
from coupled.report.paired import measured_shares
from coupled.report.preset import preset_rows
from coupled.report.shares import Trial
from coupled.scene import Scene, SettledGrains, Time
from coupled.scene.units import in_units, told_in
from coupled.step import StepLimits, limits_of, with_step
from particles.timestep import SOURCE_FACTOR

Row = tuple[str, str, str]
COST = "cost"  # section whose seconds are those of a clock
TRIED = 50  # steps timed for the estimate
SETTLED_OVER_LOOSE = 2.3  # cost of a step of settled grains over that of loose ones, as `make bench` measures
BYTES_PER_CONTACT = 60  # slot, history and dashpots of one listed pair
LISTED_PAIRS = 2.5  # per grain, measured in settled beds


def check_scene(scene: Scene, *, measure: bool = False) -> list[Row]:
    """Build a scene, try a few steps, and tell what it is made of and what each part costs.

    A scene that names a bed is tried on that bed if a run has settled it in `runs` already. If not,
    its grains stand on the lattice: counts and limits are the same, the time is estimated. `measure` also takes the
    features out of it one by one and compares times.

    Returns
    -------
    Rows (section, quantity, value).
    """
    with told_in(scene.units):
        rows = _rows(scene, measure)
    return [row if row[0] == COST else (*row[:2], in_units(row[2], scene.units)) for row in rows]


def _rows(scene: Scene, measure: bool) -> list[Row]:
    asked, scene = scene, with_step(scene)
    settled = _settled_bed(scene)
    threads = max(1, (os.cpu_count() or 1) // MPI.COMM_WORLD.size)
    tried = scene if settled is not None else on_lattice(scene)
    built = build(tried, bed=settled, threads=threads)
    needless = without_need(asked, built)  # before the trial moves anything
    rows = [("scene", "title", scene.title), *preset_rows(scene), *_grain_rows(built)]
    limits = limits_of(built.model)
    if limits is not None:
        rows += _step_rows(limits, asked.time)
    notes = cautions.before(built, limits)
    rows += _structure_rows(scene, built)
    trial = _try_out(built, SETTLED_OVER_LOOSE if settled is None else 1.0)
    rows += _cost_rows(scene, built, trial)
    measured = measured_shares(tried, settled) if measure else {}
    if measured and settled is None and built.model.particles is not None and not built.model.particles.look().count:
        notes.append("--measure found no grains in contact: run the bed first, or take the shares by the table")
    rows += need_rows(scene, needless, trial, measured)
    return rows + [("note", "", sentence) for sentence in notes]


def on_lattice(scene: Scene) -> Scene:
    """The scene with its grains as they are laid out, without the bed that settles them."""
    if not isinstance(scene.grains, SettledGrains):
        return scene
    return scene.model_copy(update={"grains": scene.first_grains, "bed": None})


def _settled_bed(scene: Scene) -> dict[str, Any] | None:
    if scene.bed is None:
        return None
    folder = beds.bed_folder(scene, Path("runs"))
    return beds.settled_state(folder) if (folder / SUMMARY).exists() else None


def _grain_rows(built: Built) -> list[Row]:
    system = built.model.particles
    if system is None:
        return []
    n_free, n = system.grains.n_free, len(system.grains)
    rows = [("grains", "free, prescribed", f"{n_free}, {n - n_free}")]
    return rows + _shaking_rows(built) + contact_rows(built.scene)


def _shaking_rows(built: Built) -> list[Row]:
    """The motion of the walls: amplitude, period, largest acceleration over gravity, largest velocity."""
    motion, gravity = built.model.particles.shaking, math.hypot(*built.scene.gravity)
    if motion is None:
        return []
    omega = 2.0 * math.pi / motion.period
    walls = [wall.name for wall in built.model.particles.walls if wall.shaken]
    rows = [
        ("moves", ", ".join([*walls, *(f"rows.{index}" for index in built.scene.shaken_rows)])),
        ("amplitude, period", f"{motion.amplitude:.4g} m, {motion.period:.6g} s"),
        ("period in steps", f"{motion.period / built.scene.time.step:.6g}"),
        ("largest velocity", f"{motion.amplitude * omega:.4g} m/s"),
    ]
    if gravity > 0.0:
        rows.append(("Gamma", f"{motion.amplitude * omega**2 / gravity:.4g}"))
    return [("shaking", *row) for row in rows]


def _step_rows(limits: StepLimits, asked: Time) -> list[Row]:
    """The step in use, and its share of the source's bound and of the limits of any packing and of this one."""
    by = ""
    if asked.step_fraction is not None:
        by = f" (auto: {asked.step_fraction:g} of the limit of a settled sample, or of the coupling)"
    elif asked.step == "auto":
        by = f" (auto: {asked.safety:g} of the limit of any packing)"
    network = limits.network
    present = "no contacts yet"
    if network.contacts:
        present = f"{network.step:.4g} s ({network.undamped:.4g} s without dashpots), {network.contacts} contacts"
    rows = [
        ("chosen", f"{limits.chosen:.4g} s{by}"),
        (f"source's bound (C = {SOURCE_FACTOR:g})", f"{limits.source:.4g} s"),
        ("chosen over the bound", f"{limits.chosen / limits.source:.3f}"),
        ("limit of a single contact", f"{limits.single:.4g} s"),
        ("limit of any packing", f"{limits.packing:.4g} s"),
        ("chosen over that", f"{limits.of_packing:.3f}"),
        ("limit of the present contacts", present),
    ]
    if network.contacts:
        rows.append(("chosen over that", f"{limits.of_network:.3f}"))
    return [("time step", *row) for row in rows]


def _structure_rows(scene: Scene, built: Built) -> list[Row]:
    body = built.model.structure
    if body is None:
        return []
    rows = [
        ("structure", "kind, nodes, cells", f"{scene.structure.kind}, {len(body.mesh.points)}, {len(body.mesh.cells)}"),
        ("structure", "step", f"{body.time_step:.4g} s"),
        *load_rows(scene.structure.loads),
    ]
    if built.model.interface is not None:
        rows += [
            ("interface", *built.model.interface.describe()),
            (
                "interface",
                f"stiffness ratio r (stable up to {stable_ratio(scene):.4g})",
                f"{built.stiffness_ratio:.3g}",
            ),
        ]
    return rows


def _try_out(built: Built, factor: float) -> Trial:
    """Time some steps; `factor` is how much longer settled grains take than those that are tried."""
    model = built.model
    model.advance(1)  # loads the compiled code
    n_free = 0 if model.particles is None else model.particles.grains.n_free
    steps, n_free = MPI.COMM_WORLD.bcast((TRIED if n_free > 1000 else 10 * TRIED, n_free), root=0)
    before = dict(model.seconds)
    model.advance(steps)
    spent = {name: (seconds - before[name]) / steps for name, seconds in model.seconds.items()}
    if n_free:
        spent["grains"] *= factor
    return Trial(whole=sum(spent.values()), n_free=n_free, **spent)


def _cost_rows(scene: Scene, built: Built, trial: Trial) -> list[Row]:
    model, per_step = built.model, trial.whole
    total = math.ceil(scene.time.duration / model.window)
    rows = [
        (COST, "steps", f"{total}"),
        (COST, "time per step", f"{1e6 * per_step:.0f} us"),
        (COST, "estimated time", spoken(per_step * total)),
        (COST, "memory of the state", f"{_state_bytes(model) / 1e6:.1f} MB"),
    ]
    if scene.bed is not None:
        rows.append(
            (COST, "and, once, to settle its bed", spoken(per_step * scene.bed.time.duration / scene.bed.time.step))
        )
    return rows


def _state_bytes(model: Any) -> int:
    size = 0
    if model.particles is not None:
        size += sum(array.nbytes for array in model.particles.state().values())
        size += int(BYTES_PER_CONTACT * LISTED_PAIRS * model.particles.grains.n_free)
    if model.structure is not None:
        size += sum(array.nbytes for array in model.structure.state().values())
    return size
