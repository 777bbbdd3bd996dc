"""The folder of a run: what may be written where, and when it is taken up again."""

from __future__ import annotations

import json
import shutil
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coupled.errors import LeitoError
from coupled.output import checkpoint
from coupled.running.restep import STEP, with_finer_step
from coupled.scene import Scene, SceneError, dump_scene, load_scene

SCENE = "scene.toml"
SUMMARY = "summary.json"
BEFORE_FAILURE = "before_failure.h5"
OURS = (
    SCENE, SUMMARY, checkpoint.NAME, BEFORE_FAILURE, "history.csv", "grains.xdmf", "structure.xdmf", "provenance.json",
    "log.txt", "frames", "figures", "measures",
)  # fmt: skip
# When a run is taken up again:
FREE_TO_CHANGE = (
    "time.duration",
    "time.step",
    "interface.exchange",
    "output.",
    "title",
    "quantities",
    "bed.quantities",
    "preset.gives",
    "preset.by_hand",
)


@dataclass(frozen=True)
class RunFolder:
    """A folder that may be used: `saved` holds the checkpoint of a run to take up again.

    Nothing is written before `take`, so that a scene refused in between leaves no trace.
    """

    path: Path
    saved: Mapping[str, Any] | None
    to_clear: bool

    def file(self, name: str) -> Path:
        return self.path / name

    def take(self, scene: Scene) -> None:
        """Make the folder, or clear what is to be overwritten, and write the scene with all defaults."""
        if self.to_clear:
            _clear(self.path)
        self.path.mkdir(parents=True, exist_ok=True)
        self.file(SCENE).write_text(dump_scene(scene))


def open_folder(path: Path, scene: Scene, *, resume: bool, overwrite: bool) -> RunFolder:
    """Look whether the folder of a run may be used or taken up.

    Raises
    ------
    LeitoError
        If it holds results and neither `resume` nor `overwrite` is given, or it belongs to
        another scene.
    """
    holds = path.is_dir() and any(path.iterdir())
    if holds and not (resume or overwrite):
        raise LeitoError(f"{path} holds a run already; go on with --resume, or start anew with --overwrite or --out")
    saved = None
    if holds and resume:
        require_same_scene(path, scene, free=FREE_TO_CHANGE)
        saved = _latest(path, scene)
    return RunFolder(path, saved, to_clear=holds and overwrite)


def _latest(path: Path, scene: Scene) -> Mapping[str, Any] | None:
    """The last state that was saved, with the step of the scene: the checkpoint, or what a failed run left."""
    found = [checkpoint.load(path / name)[0] for name in (checkpoint.NAME, BEFORE_FAILURE) if (path / name).exists()]
    if not found:
        return None
    return with_finer_step(max(found, key=_time_of), scene.time.step, scene.gravity)


def _time_of(saved: Mapping[str, Any]) -> float:
    """Simulated time [s] of a state, in grain steps of the run if it does not know its step."""
    return float(saved["model.steps_done"]) * float(saved.get(STEP, 1.0))


def _clear(path: Path) -> None:
    """Remove what a run of ours left, and nothing else."""
    for name in OURS:
        place = path / name
        if place.is_dir():
            shutil.rmtree(place)
        elif place.exists():
            place.unlink()


def require_folder(path: Path, remedy: str = "give the folder of a run") -> None:
    """Refuse what is no folder.

    Raises
    ------
    LeitoError
        With the remedy.
    """
    if not path.is_dir():
        lacks = f"{path} is a file" if path.exists() else f"{path}: there is no such folder"
        raise LeitoError(f"{lacks}; {remedy}")


def finished(path: Path, scene: Scene) -> bool:
    """Whether the run of a scene in a folder has nothing left to do."""
    if not (path / SUMMARY).exists():
        return False
    summary = json.loads((path / SUMMARY).read_text())
    # the step of the run itself: that of the scene may be left to the model
    window = summary["time_step"] * (1 if scene.interface is None else scene.interface.substeps)
    at_end = summary["simulated_seconds"] > scene.time.duration - 0.6 * window  # half of it is rounded off
    return scene.time.stop_at_rest is not None or at_end


def require_same_scene(path: Path, scene: Scene, *, free: tuple[str, ...] = ()) -> None:
    """Compare a scene, its step a number, with that of a folder, both with the defaults of this version.

    Parameters
    ----------
    free : tuple of str
        Beginnings of the keys that may differ.

    Raises
    ------
    LeitoError
        Naming the first key that differs.
    """
    try:
        old = _flat(tomllib.loads(dump_scene(_scene_of_run(path / SCENE))))
    except SceneError as error:
        raise LeitoError(f"{path} holds no {SCENE} of this version ({error}); start anew with --overwrite") from None
    new = _flat(tomllib.loads(dump_scene(scene)))
    for key in sorted(old.keys() | new.keys(), key=lambda key: (key != "preset.name", key)):
        if old.get(key) != new.get(key) and not key.startswith(free):
            raise LeitoError(
                f"{key} = {new.get(key)} differs from {old.get(key)} of the run in {path}; "
                "a run is resumed with its own scene: use another folder with --out"
            )


def _scene_of_run(path: Path) -> Scene:
    """The resolved scene of a run; one of a version without the key `structure.element` had standard cells."""
    scene = load_scene(path)
    elastic = scene.structure is not None and scene.structure.kind == "elastic"
    if elastic and "element" not in tomllib.loads(path.read_text())["structure"]:
        return load_scene(path, ["structure.element=standard"])
    return scene


def _flat(table: Any, prefix: str = "") -> dict[str, Any]:
    if isinstance(table, dict):
        items = table.items()
    elif isinstance(table, list) and table and isinstance(table[0], dict):
        items = ((str(k), item) for k, item in enumerate(table))
    else:
        return {prefix: table}
    flat: dict[str, Any] = {}
    for key, value in items:
        flat |= _flat(value, f"{prefix}.{key}" if prefix else str(key))
    return flat
