"""All measures of groups of runs, and what is missing and why."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from coupled.errors import LeitoError
from coupled.measuring.rises import Periods, Rise, intruder_names, rise_of
from coupled.measuring.samples import Group, groups_of
from coupled.measuring.states import Profiles, Rolls, profiles_of, rolls_of
from coupled.scene.units import in_units
from particles import ParticleError


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
