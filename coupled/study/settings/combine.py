"""Combinations along the front: the cheapest setting of each knob that costs no accuracy, turned together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from coupled.errors import LeitoError
from coupled.study.judging.errors import Judged
from coupled.study.settings.cost import Trial, work
from coupled.study.settings.coupling import borne
from coupled.study.settings.knob import Knob
from coupled.study.settings.plan import name_of
from coupled.study.settings.setting import Load, Setting
from coupled.study.settings.turns import Changes, Value

WORSE = 1.1  # of the base's known error: what still counts as no loss
MOST = 3


def combinations(
    judged: Mapping[str, Sequence[Judged]], values: Mapping[str, tuple[Knob, Value]], load: Load, trial: Trial
) -> list[Setting]:
    """Settings to try next: the knobs that save time without loss, one more at a time, the best first.

    Parameters
    ----------
    judged : mapping
        All settings by quantity.
    values : mapping
        Knob and value of each setting of one knob, by the setting's name.
    """
    saving = _savings(judged, values)
    found: list[Setting] = []
    for count in range(len(saving), 1, -1):
        setting = _together([values[name] for name in saving[:count]], load, trial)
        if setting is not None:
            found.append(setting)
        if len(found) == MOST:
            break
    return found


def _savings(judged: Mapping[str, Sequence[Judged]], values: Mapping[str, tuple[Knob, Value]]) -> list[str]:
    """Names of the fastest setting of each knob that loses nothing in any quantity, the best first."""
    bases = {quantity: base for quantity, items in judged.items() if (base := _base(items)) is not None}
    rates: dict[str, tuple[float, str]] = {}
    for name, (knob, _) in values.items():
        here = [
            (item, base) for quantity, base in bases.items() for item in judged[quantity] if item.setting.name == name
        ]
        if not here or len(here) < len(bases) or any(item.known > WORSE * base.known for item, base in here):
            continue
        rate = here[0][0].ran.wall_seconds / here[0][1].ran.wall_seconds
        if rate < min(1.0, rates.get(knob.name, (1.0, ""))[0]):
            rates[knob.name] = (rate, name)
    return [name for _, name in sorted(rates.values())]


def _base(items: Sequence[Judged]) -> Judged | None:
    return next((item for item in items if item.setting.role == "base"), None)


def _together(turned: Sequence[tuple[Knob, Value]], load: Load, trial: Trial) -> Setting | None:
    changes: Changes = ()
    base, threads = load(), 1
    try:
        for knob, value in turned:
            if knob.threads:
                threads = int(value)
            else:
                changes += knob.turn(load(changes), value)
        changes, _ = borne(load, changes)
        cost = work(load(changes), base, trial, threads)
    except (LeitoError, ValueError):
        return None
    pairs = tuple((knob.name, knob.label(value)) for knob, value in turned)
    return Setting(name=name_of(pairs), role="combination", knobs=pairs, changes=changes, threads=threads, work=cost)
