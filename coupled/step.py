"""The time step of a scene: the one that is left to the model, and how far a step is from its limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import particles as dem
from coupled.limits_before import coupling_limit_of, packing_limit_of, settled_limit_of
from coupled.model import Model
from coupled.scene import Scene
from coupled.scene.knobs import plain


def with_step(scene: Scene) -> Scene:
    """The scene, its bed included, with numbers in place of factors (`plain`), of "auto" steps and of periods in steps.

    An "auto" step is `time.safety` times the limit of any packing of its grains (`particles.packing_limit`), as before
    the grains have come to rest there is no network whose limit could be taken, and under a structure it changes; or
    `time.step_fraction` times that of a settled sample of them, and of the coupling (`limits_before`).

    Raises
    ------
    SceneError
        If the number does not suit the duration or the output.
    """
    scene = plain(scene)
    bed = None if scene.bed is None else with_step(scene.bed)
    in_steps = scene.shaking is not None and scene.shaking.period_steps is not None
    if scene.time.step != "auto" and bed is scene.bed and not in_steps:
        return scene
    tables = scene.model_dump(exclude_none=True)
    if bed is not None:
        tables["bed"] = bed
    if scene.time.step == "auto":
        tables["time"]["step"] = _chosen(scene, tables["time"])
    if in_steps:
        tables["shaking"]["period"] = tables["shaking"].pop("period_steps") * tables["time"]["step"]
    return Scene.model_validate(tables)


def _chosen(scene: Scene, time: dict[str, Any]) -> float:
    """The step [s]; the shares are taken out of the table of the time."""
    fraction = time.pop("step_fraction", None)
    if fraction is None:
        return time.pop("safety") * packing_limit_of(scene)
    step = fraction * settled_limit_of(scene)
    return min(step, fraction * coupling_limit_of(scene, step))


@dataclass(frozen=True, kw_only=True)
class StepLimits:
    """A time step and its limits [s]; infinite without free grains.

    `source` is the source's bound (C = 0.5), `single` the limit of one contact, `packing` that of any packing,
    `network` that of the present contacts.
    """

    chosen: float
    source: float
    single: float
    packing: float
    network: dem.StepLimit

    @property
    def of_network(self) -> float:
        """The step over the limit of the present contacts."""
        return self.chosen / self.network.step

    @property
    def of_packing(self) -> float:
        """The step over the limit of any packing."""
        return self.chosen / self.packing


def limits_of(model: Model) -> StepLimits | None:
    """How far the grains' step is from its limits now; None without free grains, and on all ranks but the first."""
    system = model.particles
    if system is None or system.grains.n_free == 0:
        return None
    return StepLimits(
        chosen=system.time_step,
        source=dem.source_bound(system.grains, system.contact),
        single=dem.source_bound(system.grains, system.contact, factor=2.0),
        packing=dem.packing_limit(system.grains, system.contact, damping=system.damping, scheme=system.scheme),
        network=dem.sharp_limit(system),
    )
