"""Which settings are run, in which order, and what fits into a budget."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from coupled.errors import LeitoError
from coupled.scene import Scene
from coupled.scene.accuracy import NAMES
from coupled.step import with_step
from coupled.study.settings.cost import Trial, work
from coupled.study.settings.coupling import borne
from coupled.study.settings.knob import Knob
from coupled.study.settings.knobs import refined_together, values_of
from coupled.study.settings.setting import Load, Setting
from coupled.study.settings.turns import Changes, Value

LEVELS = 2  # of refinement of the reference, each twice as fine, unless the budget or the user wants less
REFERENCE_SHARE = 0.5  # of a budget, for the reference and the level before it
BASE, FINEST = "as it is", "finest"


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Settings to run, what does not fit, and the estimated wall time [s]."""

    settings: tuple[Setting, ...]
    left_out: tuple[Setting, ...] = ()
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Terms:
    """What a plan has to keep to.

    Parameters
    ----------
    trial : Trial
    samples, workers : int
        Runs per setting; runs side by side.
    budget : float, optional
        Wall time of all runs [s].
    levels : int
        Of refinement of the reference.
    """

    trial: Trial
    samples: int
    workers: int
    budget: float | None = None
    levels: int = LEVELS

    def seconds(self, settings: Sequence[Setting]) -> float:
        """Estimated wall time of some settings [s]."""
        return sum(setting.work for setting in settings) * self.trial.seconds * self.samples / self.workers


def make_plan(
    load: Load, knobs: Sequence[Knob], asked: Mapping[str, tuple[Value, ...]], reference: Changes, terms: Terms
) -> Plan:
    """Plan a study: base, reference and the level before it, presets, then each knob alone, cheapest first.

    Parameters
    ----------
    load : function
    knobs : sequence of Knob
    asked : mapping
        Values that are asked for, by knob.
    reference : tuple
        Overrides of the reference; empty: all knobs that have levels are refined together, whichever are turned.

    Raises
    ------
    LeitoError
        If the budget does not hold the base and a reference.
    """
    base = load()
    weigh = _weigher(load, base, terms.trial)
    first = [Setting(name=BASE, role="base"), *_reference(load, base, reference, weigh, terms)]
    others = [weigh(Setting(name=f"accuracy = {name}", role="preset", accuracy=name)) for name in NAMES]
    turned = [weigh(one_turn(load, knob, value, base)) for knob in knobs for value in values_of(knob, base, asked)]
    others += sorted(turned, key=lambda setting: setting.work)
    if terms.budget is not None and terms.seconds(first) > terms.budget:
        raise LeitoError(
            f"--budget {terms.budget:g}: the scene as it is and its reference alone take about "
            f"{terms.seconds(first):.0f} s; give more, fewer --seeds, or a shorter time.duration"
        )
    kept, left = _within(first, others, terms)
    return Plan(settings=tuple(kept), left_out=tuple(left), seconds=terms.seconds(kept))


def _within(kept: list[Setting], others: Sequence[Setting], terms: Terms) -> tuple[list[Setting], list[Setting]]:
    left = []
    for setting in others:
        if terms.budget is not None and terms.seconds([*kept, setting]) > terms.budget:
            left.append(setting)
        else:
            kept = [*kept, setting]
    return kept, left


def one_turn(load: Load, knob: Knob, value: Value, base: Scene) -> Setting:
    """The base with one knob turned, and a shorter step where the exchange asks for it."""
    label = knob.label(value)
    turned = ((knob.name, label),)
    setting = Setting(name=name_of(turned), role="knob", knobs=turned, speed_only=knob.speed_only)
    if knob.threads:
        return replace(setting, threads=int(value))
    changes = knob.turn(base, value)
    return replace(setting, changes=changes) if knob.sets_step else _on_a_step(load, replace(setting, changes=changes))


def name_of(turned: Sequence[tuple[str, str]]) -> str:
    """Name of a setting with these knobs turned."""
    return ", ".join(f"{knob} = {value}" for knob, value in turned)


def _on_a_step(load: Load, setting: Setting) -> Setting:
    """The setting with the longest step that its exchange bears; as it is if it is refused, which the run will say."""
    try:
        changes, factor = borne(load, setting.changes)
    except (LeitoError, ValueError):
        return setting
    if factor == 1.0:
        return setting
    return replace(setting, name=f"{setting.name}, step x {factor:.2g}", changes=changes)


def _weigher(load: Load, base: Scene, trial: Trial) -> Callable[[Setting], Setting]:
    def weigh(setting: Setting) -> Setting:
        """Enter the estimated cost; a setting that is refused costs nothing."""
        try:
            scene = load(setting.changes, setting.accuracy)
            return replace(setting, work=work(scene, base, trial, setting.threads))
        except (LeitoError, ValueError):
            return replace(setting, work=0.0)

    return weigh


def _reference(
    load: Load, base: Scene, given: Changes, weigh: Callable[[Setting], Setting], terms: Terms
) -> list[Setting]:
    """The reference, and the level before it that tells how good it is."""
    if given:
        return [weigh(Setting(name=FINEST, role="reference", changes=given))]
    found: list[Setting] = []
    for level in range(1, terms.levels + 1):
        setting = weigh(_level(load, refined_together(base), level))
        affordable = terms.budget is None or terms.seconds([*found, setting]) <= REFERENCE_SHARE * terms.budget
        if found and not affordable:
            break
        found.append(setting)
    *before, finest = found
    return [replace(setting, name="second finest", role="finer") for setting in before] + [finest]


def _level(load: Load, knobs: Sequence[Knob], level: int) -> Setting:
    """All knobs that have levels, refined together; one that the scene refuses to refine stays."""
    changes: Changes = ()
    turned = []
    for knob in knobs:
        finer = _first_possible(load, changes, knob.refine(load(changes), level))
        if finer is not None:
            changes = finer
            turned.append((knob.name, f"level {level}"))
    changes, _ = borne(load, changes)
    return Setting(name=FINEST, role="reference", changes=changes, knobs=tuple(turned))


def _first_possible(load: Load, before: Changes, alternatives: Sequence[Changes]) -> Changes | None:
    """The changes of before with the first alternative that the scene does not refuse."""
    for more in alternatives:
        try:
            with_step(load(before + more))
        except LeitoError:  # such as a row of springs under the facets, which fixes their number
            continue
        return before + more
    return None
