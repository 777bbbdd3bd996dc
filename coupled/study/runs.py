"""Running settings: scenes of the samples, folders, what a refused one becomes."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Sequence
from pathlib import Path

from coupled.campaign import Outcome, Task, run_all
from coupled.errors import Interrupted, LeitoError, is_sentence
from coupled.scene import Scene, dump_scene
from coupled.step import with_step
from coupled.study.judging.measure import came_to
from coupled.study.settings.seeds import seed_key
from coupled.study.settings.setting import Load, Ran, Setting

RUNS = "runs"


class Runner:
    """Runs settings of one scene and collects what they came to.

    A run's folder carries a hash of its scene and threads: a setting that was run before is found again, whatever
    it was called, and one of a changed scene is never taken for it.

    Parameters
    ----------
    load : function
    folder : Path
        Of the study.
    seeds : tuple
        Of the samples; empty without chance.
    jobs : int, optional
        Runs side by side; as many as cores allow by default.
    progress : bool
    """

    def __init__(self, load: Load, folder: Path, seeds: tuple[int, ...], jobs: int | None, progress: bool) -> None:
        self._load, self._folder, self._seeds, self._jobs, self._progress = load, folder, seeds, jobs, progress
        self._base: list[Path] = []
        self._known: dict[str, Path] = {}

    def run(self, settings: Sequence[Setting]) -> list[Ran]:
        """Run settings, each with all seeds, those with equal threads side by side.

        Raises
        ------
        Interrupted
            After Ctrl-C, when every run has written its checkpoint.
        """
        tasks: dict[str, list[Task]] = {}
        refused: dict[str, str] = {}
        for setting in settings:
            try:
                tasks[setting.name] = self._tasks(setting)
            except (LeitoError, ValueError) as error:
                if not is_sentence(error):
                    raise
                refused[setting.name] = str(error)
        outcomes = self._outcomes([task for group in tasks.values() for task in group])
        rans = []
        for setting in settings:
            if setting.name in refused:
                rans.append(Ran(setting=setting, status="refused", message=refused[setting.name]))
                continue
            group = [outcomes[task.folder] for task in tasks[setting.name]]
            if setting.role == "base":
                self._base = [outcome.task.folder for outcome in group]
            rans.append(came_to(setting, group, self._base if setting.speed_only else None))
        return rans

    def _tasks(self, setting: Setting) -> list[Task]:
        """One task per seed."""
        seeds = self._seeds or (None,)
        scenes = [self._sample(setting, seed) for seed in seeds]
        return [self._task(setting, scene, seed) for scene, seed in zip(scenes, seeds, strict=True)]

    def _sample(self, setting: Setting, seed: int | None) -> Scene:
        key = seed_key(self._load())
        changes = setting.changes if seed is None else (*setting.changes, f"{key}={seed}")
        resolved = with_step(self._load(changes, setting.accuracy))
        return resolved.model_copy(update={"preset": None})  # settings of equal numbers are one run

    def _task(self, setting: Setting, scene: Scene, seed: int | None) -> Task:
        shaping = scene.model_copy(update={"title": "", "quantities": ()})
        digest = hashlib.sha256(f"{dump_scene(shaping)}{setting.threads}".encode()).hexdigest()[:8]
        slug = re.sub(r"[^A-Za-z0-9.]+", "_", setting.name).strip("_")[:60]
        number = "" if seed is None else f"-seed{seed}"
        folder = self._folder / RUNS / f"{slug}{number}-{digest}"
        if digest not in self._known:
            self._known[digest] = next((self._folder / RUNS).glob(f"*-{digest}"), folder)
        return Task(name=f"{setting.name}{number}", scene=scene, folder=self._known[digest], threads=setting.threads)

    def _outcomes(self, tasks: Sequence[Task]) -> dict[Path, Outcome]:
        found: dict[Path, Outcome] = {}
        cores = os.cpu_count() or 1
        for threads in sorted({task.threads for task in tasks}):
            group = {task.folder: task for task in tasks if task.threads == threads}
            workers = min(self._jobs or cores, max(1, cores // threads))
            for outcome in run_all(list(group.values()), workers=workers, progress=self._progress):
                found[outcome.task.folder] = outcome
            if any(outcome.status == "stopped" for outcome in found.values()):
                raise Interrupted(f"the study is stopped; go on with --resume, what is done in {self._folder} is kept")
        return found
