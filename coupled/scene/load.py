"""From a scene file to a typed scene, and back."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any, get_args

import tomli_w
from pydantic import BaseModel, ValidationError

from coupled.errors import SceneError
from coupled.scene.columns import read_schedules
from coupled.scene.find import find_scene
from coupled.scene.knobs import plain
from coupled.scene.overrides import apply_override, parse_override
from coupled.scene.preset import KNOBS, dotted, take_preset
from coupled.scene.refusal import translate
from coupled.scene.scene import Scene
from coupled.scene.units import told_in

INHERITED = ("units", "gravity", "box", "intruders", "contact", "damping")
_BED, _ACCURACY = "bed", "accuracy"


def load_scene(path: str | Path, overrides: Sequence[str] = (), *, accuracy: str | None = None) -> Scene:
    """Read, complete and check a scene.

    A scene that names a bed takes `units`, `gravity`, `box`, `intruders`, `contact` and `damping` from it
    unless it has its own; if its own `contact` has nothing but `pairs`, they are added to the bed's
    contact law. Overrides act after that; those that start with ``bed.`` act on the bed. The rows of a
    CSV file that a load's schedule names become part of the scene. A preset gives way to a key in the file if the
    file asks for it, and only to overrides if `accuracy` does.

    Parameters
    ----------
    path
        Path of a TOML file, or the bare name of a scene that ships.
    overrides
        Single keys, ``"time.step=1e-5"`` or ``"grains.sizes.0.count=10"``.
    accuracy
        Preset instead of the one that the file asks for; the same as the override ``"accuracy=draft"``.

    Raises
    ------
    SceneError
        One sentence with the key's path, its value, what is allowed and the remedy.
    """
    own = [parse_override(text) for text in overrides]
    return _load(find_scene(path), own if accuracy is None else [(["accuracy"], accuracy), *own], ())


def dump_scene(scene: Scene, *, without: frozenset[str] = frozenset()) -> str:
    """Return the scene as TOML with every default written; `load_scene` reads it back equal if no table is left out."""
    return tomli_w.dumps(scene.model_dump(mode="json", exclude_none=True, exclude=set(without)))


Override = tuple[list[str], Any]


def _load(path: Path, overrides: list[Override], above: tuple[Path, ...]) -> Scene:
    data = _read(path)
    with told_in(_units(data, overrides)):
        return _completed(path, data, overrides, above)


def _units(data: dict[str, Any], overrides: list[Override]) -> str:
    """The key `units`, as far as it can be told before the scene is checked."""
    return str([data.get("units", "SI"), *(value for keys, value in overrides if keys == ["units"])][-1])


def _completed(path: Path, data: dict[str, Any], overrides: list[Override], above: tuple[Path, ...]) -> Scene:
    try:
        for_bed = [(keys[1:], value) for keys, value in overrides if keys[0] == _BED and keys[1:]]
        own = [(keys, value) for keys, value in overrides if keys[0] != _BED or not keys[1:]]
        asked = [value for keys, value in own if keys == [_ACCURACY]]
        own = [(keys, value) for keys, value in own if keys != [_ACCURACY]]
        written = dotted(data)
        _resolve_bed(data, path, own, for_bed, above)
        preset = [data.pop(_ACCURACY, None), *asked][-1]
        if preset is not None:
            apart = [(keys, value) for keys, value in own if ".".join(keys) not in KNOBS]
            scene = _with_overrides(deepcopy(data), apart, path.parent)
            by_hand = dotted({".".join(keys): value for keys, value in overrides})
            take_preset(data, scene, preset, by_command=bool(asked), written=written, overrides=by_hand)
        scene = _with_overrides(data, own, path.parent)
        plain(scene)  # refuses factors that make no scene
        return scene
    except ValidationError as error:
        raise _named(path, translate(error, DESCRIPTIONS)) from None
    except SceneError as error:
        raise _named(path, error) from None


def _with_overrides(data: dict[str, Any], own: list[Override], folder: Path) -> Scene:
    for keys, value in own:
        apply_override(data, keys, value)
    read_schedules(data, folder)
    return Scene.model_validate(data)


def _read(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{path}: this is not valid TOML, mend it: {error}.", file=path.name) from None
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: cannot be read: {error}.", file=path.name) from None


def _resolve_bed(
    data: dict[str, Any],
    path: Path,
    own: list[Override],
    for_bed: list[Override],
    above: tuple[Path, ...],
) -> None:
    """Put the bed into ``data["bed"]`` and copy what is inherited from it, in place."""
    name = _bed_name(data, own)
    if name is None:
        if for_bed:
            key = ".".join([_BED, *for_bed[0][0]])
            raise SceneError(f"--set {key}: the scene names no bed.", key=key)
        return
    chain = (*above, path.resolve())
    if isinstance(data.get(_BED), dict):
        for keys, value in for_bed:
            apply_override(data[_BED], keys, value)
        bed = Scene.model_validate(data[_BED])
    else:
        bed = _load(_bed_file(name, path, chain), for_bed, chain)
    data[_BED] = bed
    tables = bed.model_dump(exclude_none=True)
    for key in INHERITED:
        if key in tables:
            data.setdefault(key, tables[key])
    settled, own = tables.get("contact"), data.get("contact")
    if settled is not None and isinstance(own, dict) and list(own) == ["pairs"] and isinstance(own["pairs"], list):
        data["contact"] = settled | {"pairs": [*settled["pairs"], *own["pairs"]]}


def _bed_name(data: dict[str, Any], own: list[Override]) -> str | None:
    grains = data.get("grains")
    name = grains.get(_BED) if isinstance(grains, dict) else None
    for keys, value in own:
        if keys == ["grains", _BED]:
            name = value
    return name if isinstance(name, str) else None


def _bed_file(name: str, path: Path, chain: tuple[Path, ...]) -> Path:
    try:
        file = find_scene(name, beside=path.parent)
    except SceneError as error:
        raise SceneError(f'grains.bed = "{name}" is not found: {error}', key="grains.bed") from None
    if file.resolve() in chain:
        raise SceneError(
            f'grains.bed = "{name}" leads back to this scene; name a scene that lays grains out.',
            key="grains.bed",
        )
    return file


def _named(path: Path, error: SceneError) -> SceneError:
    """Put the file's name in front, once: an error inside a bed has the bed's already."""
    if error.file:
        return error
    return SceneError(f"{path.name}: {error}", key=error.key, file=path.name)


def _describe(model: type[BaseModel], prefix: str = "") -> dict[str, str]:
    """Return the descriptions of all keys below a table, by path without list indices."""
    found: dict[str, str] = {}
    for name, field in model.model_fields.items():
        found[prefix + name] = field.description or ""
        for table in _tables_in(field.annotation):
            if table is not Scene:
                found.update(_describe(table, f"{prefix}{name}."))
    return found


def _tables_in(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [table for part in get_args(annotation) for table in _tables_in(part)]


DESCRIPTIONS = _describe(Scene)
