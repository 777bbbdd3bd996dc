"""All measures of groups of runs, and what is missing and why."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coupled.errors import LeitoError
from coupled.measuring.rises import Periods, Rise, intruder_names, rise_of
from coupled.measuring.samples import Group, groups_of
from coupled.measuring.states import Profiles, Rolls, profiles_of, rolls_of
from coupled.scene.units import in_units
from particles import ParticleError

FAR = 0.2  # of a period between rows: a flight of one period is at most 4 % of its height off the line between them


@dataclass(frozen=True, kw_only=True)
class Findings:
    """Of one group: the rises of its intruders, profiles, convection; None or fewer where `notes` say why."""

    group: Group
    rises: tuple[Rise, ...]
    profiles: Profiles | None
    rolls: Rolls | None
    notes: tuple[str, ...]


def find(folders: Sequence[Path], periods: Periods) -> list[Findings]:
    """Measure the runs in folders, group by group.

    Raises
    ------
    LeitoError
        If a folder holds no run, or nothing at all can be measured.
    """
    found = [_find_group(group, periods) for group in groups_of(folders)]
    if not any(one.rises or one.profiles or one.rolls for one in found):
        raise LeitoError(f"nothing to measure: {'; '.join(note for one in found for note in one.notes)}")
    return found


def _find_group(group: Group, periods: Periods) -> Findings:
    notes, rises, rolls = [], [], None
    first = group.records[0]
    if first.shaken is None:
        notes.append(f"{group.label}: no walls shake: no rises, no convection")
    else:
        if not intruder_names(first):
            notes.append(f"{group.label}: the scene names no [[intruders]]: no rises")
        for name in intruder_names(first):
            try:
                rises.append(rise_of(group, name, periods))
                notes += _far_rows(group, rises[-1])
            except ParticleError as error:
                notes.append(f"{group.label}: no rises of {name}: {error}")
        try:
            rolls = rolls_of(group, periods)
        except ParticleError as error:
            notes.append(f"{group.label}: {error}")
    profiles = profiles_of(group, periods)
    if profiles is None:
        notes.append(f"{group.label}: no frames of grains in the periods that count: no profiles")
    notes += [
        f"{group.label}: no large-deviation function of {rise.name}: {rise.deviations.lacks}"
        for rise in rises
        if rise.deviations.lacks
    ]
    short = [lacks for record in group.records if (lacks := record.lacks) is not None]
    if short:
        notes.append(f"{group.label}: {len(short)} of {len(group.records)} runs not at the end; {short[0]}")
    told = tuple(in_units(note, first.units) for note in notes)
    return Findings(group=group, rises=tuple(rises), profiles=profiles, rolls=rolls, notes=told)


def _far_rows(group: Group, rise: Rise) -> list[str]:
    """A sentence where heights are read between rows of the history that are far apart."""
    for record, sample in zip(group.records, rise.samples, strict=True):
        time, period = record.history["time"], record.shaken.period
        after = np.clip(np.searchsorted(time, sample.time), 1, len(time) - 1)
        apart, beside = (
            time[after] - time[after - 1],
            np.minimum(time[after] - sample.time, sample.time - time[after - 1]),
        )
        if (between := (apart > FAR * period) & (beside > 0.1 * FAR * period)).any():
            return [
                f"{group.label}: heights of {rise.name} are interpolated between rows "
                f"{float(apart[between].max() / period):.2g} periods apart: set output.history_interval to a tenth of "
                "shaking.period, or run so that rows fall on the phase"
            ]
    return []
