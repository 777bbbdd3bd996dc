"""One settled bed, made once and shared by the scenes that name it."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from coupled.output import checkpoint
from coupled.scene import Scene, dump_scene
from particles.kernels.layout import GrainArrays, PairArrays, WallArrays

BEDS = "beds"
ASKED = frozenset({"quantities", "preset"})  # of a scene, which do not shape a bed


def bed_folder(scene: Scene, runs: Path) -> Path:
    """Where the bed of a scene lives: named after the bed and a hash of all that shapes it, the layout included."""
    shaping = scene.bed.model_copy(update={"output": type(scene.bed.output)(), "title": "bed"})
    layout = " ".join(GrainArrays._fields + PairArrays._fields + WallArrays._fields)
    digest = hashlib.sha256((dump_scene(shaping, without=ASKED) + layout).encode()).hexdigest()[:10]
    return runs / BEDS / f"{Path(scene.grains.bed).stem}-{digest}"


def settled_state(folder: Path) -> dict[str, Any]:
    """Grains and contacts of a finished bed."""
    saved, _ = checkpoint.load(folder / checkpoint.NAME)
    return {name.removeprefix("particles."): array for name, array in saved.items() if name.startswith("particles.")}
