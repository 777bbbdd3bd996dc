"""What share of a run each feature of a scene takes: a short trial of its parts, split by a table of measured costs."""

from __future__ import annotations

from dataclasses import dataclass

from coupled.report import modelled as m
from coupled.running.guard import LOOK
from coupled.scene import Scene

# ns per settled grain and step, from `make bench ARGS=features`: one thread of an AMD EPYC, 15 000 discs.
NANOSECONDS = {
    m.FREE_GRAINS: 9.0,
    m.FRICTION: 12.0,
    m.ROLLING: 3.2,
    m.HERTZ: 6.4,
    m.FOLLOWING: 10.0,
    m.MATERIALS: 0.3,
    m.DAMPING: 2.0,  # beside the ledger, which sums what it takes
    m.WALLS: 0.3,
    m.PERIODIC: 0.3,
    m.VERLET: 3.2,
}
LEDGER, LEDGER_NANOSECONDS = "energy ledger", 2.2
# ns per grain each time, from the same command.
ROW, FRAME, CHECKPOINT, WATCH = 60.0, 700.0, 1100.0, 210.0
HISTORY, FRAMES, CHECKPOINTS, WATCHDOGS = "history", "frames", "checkpoints", "watchdogs"


@dataclass(frozen=True)
class Trial:
    """Seconds of one step of the structure, or of the grains without one: whole, and its parts."""

    whole: float
    grains: float
    structure: float
    exchange: float
    n_free: int


def shares(scene: Scene, trial: Trial) -> dict[str, float]:
    """Share of the time of a run of each feature [-], by name; those that have no cost of their own are not in it.

    The parts of the model are measured in the trial; what the grains take is split in proportion to `NANOSECONDS`,
    and what a run writes and watches is added at its intervals.
    """
    written = _written(scene, trial)
    whole = trial.whole + sum(written.values())
    if whole <= 0.0:
        return {}
    found = {name: spent / whole for name, spent in written.items()}
    if trial.grains > 0.0:
        bare = m.FREE_GRAINS if scene.grains is not None else m.ROWS
        costs = {name: NANOSECONDS[name] for name in m.models(scene) if name in NANOSECONDS}
        costs |= {bare: NANOSECONDS[m.FREE_GRAINS], LEDGER: LEDGER_NANOSECONDS}
        total = sum(costs.values())
        found |= {name: trial.grains / whole * cost / total for name, cost in costs.items()}
    if scene.structure is not None:
        found[m.structure_name(scene)] = trial.structure / whole
    if scene.interface is not None:
        found[m.interface_name(scene)] = trial.exchange / whole
    return found


def _written(scene: Scene, trial: Trial) -> dict[str, float]:
    """Seconds per step of what a run writes and watches."""
    if not trial.n_free:
        return {}
    output, substeps = scene.output, 1 if scene.interface is None else scene.interface.substeps
    window = scene.time.step * substeps
    each = 1e-9 * trial.n_free
    found = {HISTORY: each * ROW * window / output.history_interval}
    if output.frames_per_second > 0.0:
        found[FRAMES] = each * FRAME * window * output.frames_per_second
    if output.checkpoint_interval is not None:
        found[CHECKPOINTS] = each * CHECKPOINT * window / output.checkpoint_interval
    return found | {WATCHDOGS: each * WATCH * substeps / LOOK}
