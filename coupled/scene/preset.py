"""Taking a preset into the tables of a scene file: what it sets, and what was written by hand."""

from __future__ import annotations

from typing import Any

from coupled.scene.accuracy import NAMES, PRESETS, Group
from coupled.scene.overrides import apply_override
from coupled.scene.refusal import nearest, refusal
from coupled.scene.scene import Scene

Tables = dict[str, Any]
KNOBS = frozenset(
    key for groups in PRESETS.values() for group in groups for key in (*group.keys, *group.rivals, *group.set_rivals)
)
"""Keys that presets set or give way to."""


def take_preset(data: Tables, scene: Scene, name: str, *, by_command: bool, written: Tables, overrides: Tables) -> None:
    """Put the keys of a preset into the tables of a scene file, in place, and what it did into the table `preset`.

    Keys that are written by hand stay. If the file asks for the preset these are those of the file and of ``--set``, if
    the command line does, those of ``--set`` alone.

    Parameters
    ----------
    data
        Tables of the file, its bed read.
    scene
        The same without the preset, with the overrides but for those of `KNOBS`.
    by_command
        Whether the command line asks for it.
    written, overrides
        Values by dotted key, of the file and of ``--set``.

    Raises
    ------
    SceneError
        If there is no such preset, or the scene has one in it already.
    """
    if name not in NAMES:
        raise refusal("accuracy", name, f"is no preset; {nearest(str(name), NAMES)}")
    if "preset" in data:
        raise refusal(
            "accuracy", name, "is asked of a scene that a run has written, with its preset in it; give the scene file"
        )
    by_hand = overrides if by_command else written | overrides
    gives: list[str] = []
    kept: list[str] = []
    for group in PRESETS[name]:
        if not group.where(scene):
            continue
        rival = _rival(group, by_hand, overrides)
        if rival is not None:
            kept.append(rival)
            continue
        mine = {key: value for key, value in group.keys.items() if not _is_given(key, by_hand)}
        kept += [key for key in group.keys if key not in mine]
        _put(data, dict.fromkeys(group.drops) | mine)
        gives += [f"{key} = {_written(value)}" for key, value in mine.items()]
    data["preset"] = {"name": name, "gives": gives, "by_hand": list(dict.fromkeys(kept))}


def dotted(tables: Any, prefix: str = "") -> Tables:
    """Values by dotted key; lists are values."""
    if not isinstance(tables, dict):
        return {prefix: tables}
    return {
        key: value
        for name, inner in tables.items()
        for key, value in dotted(inner, f"{prefix}.{name}" if prefix else name).items()
    }


def _rival(group: Group, by_hand: Tables, overrides: Tables) -> str | None:
    """The key by hand that leaves no place for a group."""
    for key in group.rivals:
        if _is_given(key, by_hand):
            return key
    return next((key for key in group.set_rivals if key in overrides), None)


def _is_given(key: str, by_hand: Tables) -> bool:
    """Whether a value is written by hand; a step that is left to the model is none."""
    return key in by_hand and by_hand[key] not in ("auto", None)


def _put(data: Tables, values: Tables) -> None:
    """Set keys in place, or take them out where the value is None; those of the bed in the bed that is read."""
    of_bed = {key.removeprefix("bed."): value for key, value in values.items() if key.startswith("bed.")}
    if of_bed:
        bed = data["bed"].model_dump(exclude_none=True)
        _put(bed, of_bed)
        data["bed"] = Scene.model_validate(bed)
    for key, value in values.items():
        if not key.startswith("bed."):
            apply_override(data, key.split("."), value)


def _written(value: Any) -> str:
    return f'"{value}"' if isinstance(value, str) else f"{value:g}"
