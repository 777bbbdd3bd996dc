"""Limits of the grains' step that a scene has before anything in it is at rest: of packings, and of the coupling."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

import particles as dem
from coupled.bodies import body_of, interface_of, mesh_of, stable_ratio
from coupled.interface.door import stiffness_ratio
from coupled.interface.glued import BODY
from coupled.laws import contact_law, damping_of, interface_spring
from coupled.scene import RowUnder, Scene, SizeClass
from coupled.scene.materials import intruder_materials
from particles.crowding import ALIKE

CLOSER = 10  # radii tried of a spread, in each kind of grains that the limit of any packing puts together
OF_SPREAD = 5  # radii in a sample that stand for a spread
INSIDE = 1.0 - 1e-4  # what the power iteration for the ratio leaves open


def packing_limit_of(scene: Scene) -> float:
    """Limit of any packing of the grains of a scene [s], from one of each kind."""
    return _packing_limit(scene, _one_of_each(scene))


def settled_limit_of(scene: Scene) -> float:
    """Limit of a settled sample of the free grains [s], with the law among all of theirs that has the smallest.

    What intruders take of the limit of any packing, they take of this one. Hertz's spring has no limit but at an
    overlap: there it is the limit of any packing.
    """
    table, law = scene.first_grains, contact_law(scene)
    laws = {law} if isinstance(law, dem.ContactModel) else set(law.rows[0])
    if any(isinstance(model.normal, dem.HertzSpringDashpot) for model in laws):
        return packing_limit_of(scene)
    share = 1.0
    if scene.intruders:
        share = min(1.0, _packing_limit(scene, _kinds(scene, True)) / _packing_limit(scene, _kinds(scene, False)))
    sizes = [entry for size in table.sizes for entry in _entries(size)]
    options: dict[str, Any] = {"damping": damping_of(scene), "scheme": scene.time.integrator}
    return share * min(dem.sample_limit(sizes, table.density, model, **options).step for model in laws)


def _packing_limit(scene: Scene, grains: dem.Grains) -> float:
    return dem.packing_limit(grains, contact_law(scene), damping=damping_of(scene), scheme=scene.time.integrator)


def _entries(size: SizeClass) -> list[tuple[float, int]]:
    """Radii [m] and counts of a class, a spread as some radii of equal shares."""
    if size.spread == 0.0:
        return [(size.radius, size.count)]
    return [(float(radius), size.count) for radius in np.linspace(size.smallest, size.largest, OF_SPREAD)]


def coupling_limit_of(scene: Scene, step: float) -> float:
    """The step [s] at which the stiffness ratio of the coupling is at its limit; infinite where no body gives way.

    ``r(H) = (H^2 k + 2 H c) lambda`` of a window H, with lambda from the ratio at some `step` [s].
    """
    structure, interface = scene.structure, scene.interface
    if structure is None or interface is None or structure.kind == "rigid":
        return math.inf
    tried = scene.model_copy(update={"time": scene.time.model_copy(update={"step": step})})
    centre = (0.0, 0.0)
    mesh = mesh_of(tried, MPI.COMM_SELF, centre)
    body, door = body_of(tried, mesh, centre), interface_of(tried, mesh)
    k, c = interface_spring(scene, contact_law(scene), _one_of_each(scene), door.radius)
    window = step * interface.substeps
    ratio = stiffness_ratio(door.operator, k, c, window, body.acceleration_by)
    limit = interface.largest_stiffness_ratio or stable_ratio(scene)
    share = limit * (window**2 * k + 2.0 * window * c) / ratio  # H^2 k + 2 H c at the limit
    return INSIDE * (math.sqrt(c**2 + k * share) - c) / k / interface.substeps


def _one_of_each(scene: Scene) -> dem.Grains:
    """A free grain of each size, and two neighbours of each body of prescribed ones; facets count as walls."""
    sample, interface = _kinds(scene, True), scene.interface
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


def _kinds(scene: Scene, with_intruders: bool) -> dem.Grains:
    """A free grain of each size, if there are any, and the intruders."""
    table, intruders = scene.first_grains, scene.intruders if with_intruders else ()
    radius = np.concatenate([np.zeros(0), *(_radii(size) for size in (table.sizes if table else ()))])
    density = np.full(len(radius), table.density if table else 0.0)
    radius = np.append(radius, [intruder.radius for intruder in intruders])
    density = np.append(density, [intruder.density for intruder in intruders])
    material = np.append(np.zeros(len(radius) - len(intruders), int), intruder_materials(scene)[: len(intruders)])
    return dem.Grains.discs(np.zeros((len(radius), 2)), radius, density, material=material)


def _radii(size: SizeClass) -> NDArray[np.float64]:
    """Radii [m] of a class, so close to each other that every kind of the limit has its smallest and largest."""
    steps = math.ceil(CLOSER * math.log(size.largest / size.smallest) / ALIKE)
    return np.geomspace(size.smallest, size.largest, 1 + steps)


def _neighbours(grains: dem.Grains, spacing: float, radius: float, body: int) -> dem.Grains:
    return grains.with_prescribed([[0.0, 0.0], [spacing, 0.0]], radius, body)
