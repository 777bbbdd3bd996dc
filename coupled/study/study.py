"""A scene over its knobs: plan, run, compare, write."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from coupled.errors import LeitoError
from coupled.output.lock import require_place
from coupled.output.provenance import write_json
from coupled.report.duration import spoken
from coupled.report.quantities import unit_shown
from coupled.running.launch import ranks
from coupled.scene import Scene, dump_scene, load_scene
from coupled.scene.quantities import Quantity
from coupled.study.judging.errors import Judged
from coupled.study.judging.judge import judge_all, references
from coupled.study.judging.reference import Reference
from coupled.study.pages import table
from coupled.study.pages.picture import draw_front
from coupled.study.pages.words import Told, text_of
from coupled.study.runs import RUNS, Runner
from coupled.study.settings.combine import combinations
from coupled.study.settings.cost import Trial, try_out
from coupled.study.settings.knob import Knob
from coupled.study.settings.knobs import knobs_of, values_of
from coupled.study.settings.plan import LEVELS, Plan, Terms, make_plan, one_turn
from coupled.study.settings.seeds import seeds_of
from coupled.study.settings.setting import Load, Ran, Setting
from coupled.study.settings.turns import Changes, Value

TRIAL, TEXT = "trial.json", "study.md"
QUIET = ("output.figures=false", "output.frames_per_second=0.0")  # no setting pays for pictures


@dataclass(frozen=True, kw_only=True)
class Wishes:
    """What a study is asked for.

    Parameters
    ----------
    overrides : tuple
        Of the scene in every setting.
    accuracy : str, optional
        Preset of the base, instead of what the scene asks for.
    knobs : tuple, optional
        Names; none at all for presets and reference alone; absent: all that the scene has.
    values : dict
        Values to try, by knob.
    reference : tuple
        Overrides of the reference; empty: the scene's finest level.
    seeds, jobs : int, optional
        Samples per setting; runs side by side.
    budget : float, optional
        Wall time of all runs [s].
    levels : int
        Of refinement of the reference.
    """

    overrides: tuple[str, ...] = ()
    accuracy: str | None = None
    knobs: tuple[str, ...] | None = None
    values: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    reference: Changes = ()
    seeds: int | None = None
    jobs: int | None = None
    budget: float | None = None
    levels: int = LEVELS


@dataclass(frozen=True, kw_only=True)
class Case:
    """The scene of a study, and what of it is turned and looked at."""

    load: Load
    base: Scene
    quantities: Sequence[Quantity]
    knobs: Sequence[Knob]
    values: Mapping[str, tuple[Value, ...]]
    seeds: tuple[int, ...]

    def turned(self) -> dict[str, tuple[Knob, Value]]:
        """Knob and value of each setting of one knob, by the setting's name."""
        pairs = [(knob, value) for knob in self.knobs for value in values_of(knob, self.base, self.values)]
        return {one_turn(self.load, knob, value, self.base).name: (knob, value) for knob, value in pairs}


@dataclass(frozen=True, kw_only=True)
class Study:
    """A finished study: what ran, its errors by quantity, and the files."""

    rans: tuple[Ran, ...]
    judged: dict[str, list[Judged]]
    references: dict[str, Reference]
    units: dict[str, str]
    folder: Path

    def rows(self) -> list[tuple[str, ...]]:
        """Rows for a terminal."""
        return table.rows(self.judged, self.units)

    def without_result(self) -> list[str]:
        """A line for each setting without values."""
        return table.without_result(self.rans)


def _print(sentence: str) -> None:
    print(sentence, flush=True)


def run_study(
    scene: str | Path,
    wishes: Wishes,
    *,
    out: Path,
    resume: bool = False,
    overwrite: bool = False,
    progress: bool = True,
    say: Callable[[str], None] = _print,
) -> Study:
    """Run a scene over its knobs and write study.csv, study.md and a picture per quantity.

    Parameters
    ----------
    scene : path or name
    wishes : Wishes
    out : Path
        Folder of the study; what its runs hold is reused with `resume`, refused without it.
    say : function
        Takes the plan as one sentence, before anything runs.

    Raises
    ------
    LeitoError
        One sentence: no quantities, an unknown knob, a budget that is too small, a folder that holds a study.
    Interrupted
        After Ctrl-C.
    """

    if ranks() > 1:
        raise LeitoError("a study makes its runs side by side itself: start it without mpirun, and give --jobs")

    def load(changes: Changes = (), accuracy: str | None = None) -> Scene:
        return load_scene(scene, (*wishes.overrides, *QUIET, *changes), accuracy=accuracy or wishes.accuracy)

    base = load()
    case = Case(
        load=load, base=base, quantities=_quantities(base, scene), values=wishes.values,
        knobs=_knobs(base, wishes), seeds=seeds_of(base, wishes.seeds),
    )  # fmt: skip
    load(wishes.reference)  # a reference that cannot be is refused at once
    _take(out, resume, overwrite)
    workers = wishes.jobs or os.cpu_count() or 1
    terms = Terms(
        trial=_trial(base, out), samples=max(1, len(case.seeds)), workers=workers, budget=wishes.budget,
        levels=wishes.levels,
    )  # fmt: skip
    plan = make_plan(load, case.knobs, wishes.values, wishes.reference, terms)
    say(_announcement(plan, terms, out))
    runner = Runner(load, out, case.seeds, wishes.jobs, progress)
    rans = runner.run(plan.settings)
    rans += runner.run(_further(case, rans, terms, plan))
    return _written(case, plan, rans, out)


def _quantities(scene: Scene, name: str | Path) -> Sequence[Quantity]:
    if not scene.quantities:
        raise LeitoError(
            f"{name}: the scene names no quantities of interest, so that there is nothing to compare; add "
            '[[quantities]] with name, kind and column, e.g. kind = "drop", column = "centroid_y"'
        )
    return scene.quantities


def _knobs(base: Scene, wishes: Wishes) -> list[Knob]:
    """The knobs to turn: those named, and those of which values are given."""
    if wishes.knobs is None and not wishes.values:
        return knobs_of(base)
    return knobs_of(base, (*(wishes.knobs or ()), *wishes.values))


def _take(out: Path, resume: bool, overwrite: bool) -> None:
    """Make the folder, or clear what is to be overwritten."""
    require_place(out)
    ours = (RUNS, TRIAL, TEXT, table.CSV)
    holds = any((out / name).exists() for name in ours if name != TRIAL)  # a budget that was too small leaves a trial
    if holds and not (resume or overwrite):
        raise LeitoError(f"{out} holds a study already; go on with --resume, or start anew with --overwrite or --out")
    if overwrite:
        for name in ours:
            place = out / name
            shutil.rmtree(place) if place.is_dir() else place.unlink(missing_ok=True)
        for picture in out.glob("pareto_*.png"):
            picture.unlink()
    out.mkdir(parents=True, exist_ok=True)


def _trial(base: Scene, out: Path) -> Trial:
    """The trial of this folder: a study that goes on with the same scene keeps its plan."""
    path, scene = out / TRIAL, dump_scene(base)
    if path.exists():
        kept = json.loads(path.read_text())
        if kept.pop("scene", None) == scene:
            return Trial(**kept)
    trial = try_out(base)
    write_json(path, trial._asdict() | {"scene": scene})
    return trial


def _announcement(plan: Plan, terms: Terms, out: Path) -> str:
    count = len(plan.settings)
    samples = f", {terms.samples} seeds each" if terms.samples > 1 else ""
    left = f"; {len(plan.left_out)} more do not fit into the budget" if plan.left_out else ""
    return (
        f"study of {count} settings{samples}, {count * terms.samples} runs, {terms.workers} at a time: about "
        f"{spoken(plan.seconds)} and some seconds per run to load and build{left}; results in {out}"
    )


def _further(case: Case, rans: Sequence[Ran], terms: Terms, plan: Plan) -> list[Setting]:
    """Combinations along the front, as far as the budget goes."""
    if not any(ran.done and ran.setting.role == "base" for ran in rans):
        return []
    judged = judge_all(rans, references(rans, case.quantities, chance=bool(case.seeds)), chance=bool(case.seeds))
    found: list[Setting] = []
    for setting in combinations(judged, case.turned(), case.load, terms.trial):
        if terms.budget is None or plan.seconds + terms.seconds([*found, setting]) <= terms.budget:
            found.append(setting)
    return found


def _written(case: Case, plan: Plan, rans: list[Ran], out: Path) -> Study:
    """Compare, and write what is to be read."""
    left = [Ran(setting=setting, status="left out", message="does not fit into --budget") for setting in plan.left_out]
    rans = rans + left
    found = references(rans, case.quantities, chance=bool(case.seeds))
    judged = judge_all(rans, found, chance=bool(case.seeds))
    units = {quantity.name: unit_shown(quantity, case.base.units) for quantity in case.quantities}
    pictures = {name: out / f"pareto_{name}.png" for name in judged}
    title = case.base.title
    for name, items in judged.items():
        draw_front(pictures[name], f"{title}: {name}", items)
    table.write_csv(out / table.CSV, rans, judged, found, units)
    told = Told(
        title=title,
        seeds=case.seeds,
        rans=rans,
        judged=judged,
        references=found,
        units=units,
        knobs={knob: knob.own(case.base) for knob in case.knobs},
        pictures=pictures,
    )
    (out / TEXT).write_text(text_of(told))
    return Study(rans=tuple(rans), judged=judged, references=found, units=units, folder=out)
