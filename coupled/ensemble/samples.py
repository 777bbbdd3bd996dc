"""The samples of an ensemble: every combination of the grid with every seed, checked before anything runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from coupled.campaign import Task
from coupled.ensemble.grid import Combination, grid
from coupled.errors import LeitoError, SceneError
from coupled.scene import Scene, load_scene
from coupled.scene.chance import seed_key


@dataclass(frozen=True, kw_only=True)
class Sample:
    """One run of an ensemble."""

    combination: Combination
    seed: int | None
    task: Task


def samples_of(
    scene: str | Path,
    count: int,
    *,
    vary: Sequence[str] = (),
    overrides: Sequence[str] = (),
    accuracy: str | None = None,
    out: Path,
    threads: int = 1,
    shared: Path | None = None,
) -> list[Sample]:
    """Every combination with the seeds ``first .. first + count - 1``, first being the scene's own.

    The seed is that of the grains, or of the bed that settles them. Folders are
    ``out/<combination>/seed_<k>``, without a combination ``out/seed_<k>``; of a scene in which nothing is random
    ``sample``.

    Raises
    ------
    LeitoError
        If one of the scenes is refused, or several seeds are asked of one in which nothing is random.
    """
    if count < 1:
        raise LeitoError(f"--samples {count} must be at least 1.")
    found = []
    for combination in grid(vary, overrides):
        sets = [*overrides, *combination.overrides]
        first = _first(scene, combination, sets, accuracy)
        place = out / combination.label if combination.values else out
        key = seed_key(first)
        if key is None:
            found.append((combination, None, first, place / "sample"))
            if count > 1:
                raise LeitoError(_nothing_random(scene, count))
            continue
        if any(key == varied for varied, _ in combination.values):
            raise LeitoError(f"--vary {key}: the seeds are varied by --samples; --set {key}=1 chooses the first.")
        for seed in range(first.first_grains.seed, first.first_grains.seed + count):
            loaded = load_scene(scene, [*sets, f"{key}={seed}"], accuracy=accuracy)
            found.append((combination, seed, loaded, place / f"seed_{seed}"))
    return [
        Sample(
            combination=combination,
            seed=seed,
            task=Task(name=str(folder.relative_to(out)), scene=loaded, folder=folder, threads=threads, shared=shared),
        )
        for combination, seed, loaded, folder in found
    ]


def _first(scene: str | Path, combination: Combination, sets: Sequence[str], accuracy: str | None) -> Scene:
    """The scene of a combination with its own seed."""
    try:
        return load_scene(scene, sets, accuracy=accuracy)
    except SceneError as error:
        if not combination.values:
            raise
        raise LeitoError(f"--vary {' '.join(combination.overrides)}: {error}") from None


def _nothing_random(scene: str | Path, count: int) -> str:
    return (
        f"--samples {count}: nothing in {scene} is random, all samples would be the same; take --samples 1, or grains "
        "on a lattice with a jitter, a spread or several sizes."
    )
