"""The time step of a scene: the one that is left to the model, and how far a step is from its limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import particles as dem
from coupled.interface.glued import BODY
from coupled.laws import contact_law
from coupled.model import Model
from coupled.scene import RowUnder, Scene, SizeClass
from particles.crowding import ALIKE

CLOSER = 10  # radii tried of a spread, in each kind of grains that the limit puts together


def with_step(scene: Scene) -> Scene:
    """The scene, its bed included, with a number where `time.step` is "auto", and for a period in steps.

    That is `time.safety` times the limit of any packing of its grains (`particles.packing_limit`):
    before the grains have come to rest there is no network whose limit could be taken, and under
    a structure it changes.

    Raises
    ------
    SceneError
        If the number does not suit the duration or the output.
    """
    bed = None if scene.bed is None else with_step(scene.bed)
    in_steps = scene.shaking is not None and scene.shaking.period_steps is not None
    if scene.time.step != "auto" and bed is scene.bed and not in_steps:
        return scene
    tables = scene.model_dump(exclude_none=True)
    if bed is not None:
        tables["bed"] = bed
    if scene.time.step == "auto":
        tables["time"]["step"] = tables["time"].pop("safety") * _packing_limit(scene)
    if in_steps:
        tables["shaking"]["period"] = tables["shaking"].pop("period_steps") * tables["time"]["step"]
    return Scene.model_validate(tables)


def damping_of(scene: Scene) -> dem.GlobalDamping | None:
    """The global damping of a scene."""
    given = scene.damping
    if given is None:
        return None
    return dem.GlobalDamping(translational=given.translational, rotational=given.rotational)


def _packing_limit(scene: Scene) -> float:
    """Limit of any packing of the grains of a scene [s], from one of each kind."""
    return dem.packing_limit(
        _sample(scene), contact_law(scene), damping=damping_of(scene), scheme=scene.time.integrator
    )


def _sample(scene: Scene) -> dem.Grains:
    """A free grain of each size, and two neighbours of each body of prescribed ones; facets count as walls."""
    table, interface = scene.first_grains, scene.interface
    radius = np.concatenate([_radii(size) for size in table.sizes])
    density = np.full(len(radius), table.density)
    radius = np.append(radius, [intruder.radius for intruder in scene.intruders])
    density = np.append(density, [intruder.density for intruder in scene.intruders])
    sample = dem.Grains.discs(np.zeros((len(radius), 2)), radius, density)
    if interface is not None and interface.kind == "glued":
        spacing = interface.smallest_spacing(scene.structure.shape)
        sample = _neighbours(sample, spacing, 0.5 * (interface.diameter or spacing), BODY)
    for number, row in enumerate(scene.rows):
        if isinstance(row, RowUnder):
            spacing = interface.smallest_spacing(scene.structure.shape)
        else:
            spacing = math.dist(row.start, row.end) / max(row.count - 1, 1) or 2.0 * row.radius
        sample = _neighbours(sample, spacing, row.radius, BODY + 1 + number)
    return sample


def _radii(size: SizeClass) -> NDArray[np.float64]:
    """Radii [m] of a class, so close to each other that every kind of the limit has its smallest and largest."""
    steps = math.ceil(CLOSER * math.log(size.largest / size.smallest) / ALIKE)
    return np.geomspace(size.smallest, size.largest, 1 + steps)


def _neighbours(grains: dem.Grains, spacing: float, radius: float, body: int) -> dem.Grains:
    return grains.with_prescribed([[0.0, 0.0], [spacing, 0.0]], radius, body)


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
