"""From a typed scene to the objects that are advanced. Strings become objects here and nowhere else."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

import particles as dem
from coupled.bodies import body_of, interface_of, mesh_of, stable_ratio
from coupled.errors import LeitoError
from coupled.exchange.iterated import Iteration
from coupled.interface.closed_ratio import ClosedRatio
from coupled.interface.door import Interface, longest_window, stiffness_ratio
from coupled.interface.glued import BODY, GluedGrains
from coupled.laws import contact_law, damping_of, interface_spring
from coupled.layout import box_walls, laid_out, shaking_of
from coupled.model import Model
from coupled.scene import RowUnder, Scene, SettledGrains
from coupled.scene.materials import GRAINS, STRUCTURE, intruder_materials, materials
from coupled.step import with_step
from particles.timestep import require_stable

WARNED_SHARE = 0.95  # of the stable ratio

Saved = Mapping[str, NDArray[Any]]


@dataclass(frozen=True)
class Built:
    """A model with what the run and the check want to know of it."""

    model: Model
    scene: Scene
    contact: dem.Contact | None
    stiffness_ratio: float
    stable_dt_ratio: float


def build(scene: Scene, *, bed: Saved | None = None, threads: int = 1, comm: MPI.Intracomm = MPI.COMM_WORLD) -> Built:
    """Make the model of a scene.

    Parameters
    ----------
    scene : Scene
    bed : mapping, optional
        State of the settled grains, for a scene that names a bed.
    threads : int
        For the grains.
    comm : MPI communicator
        The structure lives on all ranks, the grains on rank 0.

    Raises
    ------
    LeitoError, MeshError, StructureError, ParticleError
        One sentence, when the parts do not go together.
    """
    scene = with_step(scene)
    contact = None if scene.contact is None else contact_law(scene)
    free = _free_grains(scene, bed) if comm.rank == 0 else None
    body, interface = None, None
    if scene.structure is not None:
        centroid = _placement(scene, free, comm)
        mesh = mesh_of(scene, comm, centroid)
        body = body_of(scene, mesh, centroid)
        if scene.interface is not None:
            interface = interface_of(scene, mesh)
    system = None
    if comm.rank == 0 and (free is not None or scene.rows):
        system = _particles(scene, free, interface, contact, bed, threads)
    model = Model(
        particles=system,
        structure=body,
        interface=interface,
        substeps=1 if scene.interface is None else scene.interface.substeps,
        lagged=scene.interface is not None and scene.interface.exchange == "lagged",
        iteration=_iteration(scene),
        time_step=scene.time.step,
    )
    ratio = _stiffness_ratio(scene, model, contact, comm)
    model.closed_ratio = _closed_ratio(scene, model, contact)
    model.followed = _followed(scene)
    dt_ratio = scene.time.step / dem.source_bound(system.grains, contact) if system is not None else 0.0
    return Built(model, scene, contact, ratio, comm.bcast(dt_ratio, root=0))


def _free_grains(scene: Scene, bed: Saved | None) -> dem.Grains | None:
    if scene.grains is None:
        return None
    if isinstance(scene.grains, SettledGrains):
        if bed is None:
            raise LeitoError(f'grains.bed = "{scene.grains.bed}" has not been settled: run that scene first')
        settled = dem.Grains.from_saved(bed)
        for number, material in zip(_followed(scene), intruder_materials(scene), strict=True):
            settled.material[settled.number == number] = material  # the bed may tell others apart
        return settled
    return laid_out(scene)


def _followed(scene: Scene) -> tuple[int, ...]:
    """Numbers of the intruders: they come after all other free grains."""
    if not scene.intruders:
        return ()
    first = scene.first_grains.count
    return tuple(range(first, first + len(scene.intruders)))


def _placement(scene: Scene, free: dem.Grains | None, comm: MPI.Intracomm) -> tuple[float, float]:
    """Centroid of the structure; `on_bed`: lowered until its interface touches."""
    place, shape = scene.structure.placement, scene.structure.shape
    if place.y != "on_bed":
        return (place.x, place.y + place.gap)
    height = None
    if comm.rank == 0:
        top = float(np.max(free.y[: free.n_free] + free.radius[: free.n_free])) if free is not None else 0.0
        above = (place.x, top + 2.0 * shape.half_extent[1])
        fall = interface_of(scene, mesh_of(scene, MPI.COMM_SELF, above)).fall_onto(free)
        height = above[1] - fall + place.gap
    return (place.x, comm.bcast(height, root=0))


def _particles(
    scene: Scene,
    free: dem.Grains | None,
    interface: Interface | None,
    contact: dem.Contact,
    bed: Saved | None,
    threads: int,
) -> dem.ParticleSystem:
    grains = free if free is not None else dem.Grains.discs(np.zeros((0, 2)), np.zeros(0), 1.0)
    of = materials(scene).index
    facets = None
    if interface is not None:
        grains = interface.enter(grains, of(STRUCTURE))
        facets = interface.facets(of(STRUCTURE))
    for number, row in enumerate(scene.rows):
        places = _row_places(scene, row, interface)
        grains = grains.with_prescribed(places, row.radius, BODY + 1 + number, material=of(row.name or GRAINS))
    require_stable(grains, contact, scene.time.step)
    options = {
        "time_step": scene.time.step,
        "walls": box_walls(scene),
        "shaking": shaking_of(scene, BODY + 1),
        "period": (None, None) if scene.box is None else scene.box.period,
        "scheme": scene.time.integrator,
        "precision": "float64" if scene.grains is None else scene.grains.precision,
        "skin_factor": 1.0 if scene.grains is None else scene.grains.skin_factor,
        "facets": facets,
        "gravity": scene.gravity,
        "threads": threads,
        "damping": damping_of(scene),
    }
    if isinstance(scene.grains, SettledGrains):
        system = dem.continued(bed, grains, contact, **options)
    else:
        system = dem.ParticleSystem(grains, contact, **options)
    bodies = grains.bodies()
    for number, row in enumerate(scene.rows):
        if not isinstance(row, RowUnder):
            system.set_velocity(bodies[BODY + 1 + number], np.array(row.velocity))
    return system


def _row_places(scene: Scene, row: Any, interface: Interface | None) -> NDArray[np.float64]:
    if not isinstance(row, RowUnder):
        return np.linspace(row.start, row.end, row.count)
    if interface is None:
        raise LeitoError(f'rows under "{row.under}" need a structure above: add the table [interface]')
    per_facet = scene.interface.grains_per_facet(scene.structure.shape)
    own = GluedGrains(interface.polyline, per_facet=per_facet, boundaries=(row.under,))
    standoff = interface.radius if math.isfinite(interface.radius) else 0.0
    return own.reference - np.array([0.0, standoff + row.radius])


def _iteration(scene: Scene) -> Iteration | None:
    table = scene.interface
    if table is None or table.exchange != "iterated":
        return None
    asked = {"tolerance": table.tolerance, "most": table.iterations}
    return Iteration(**{name: value for name, value in asked.items() if value is not None})


def _closed_ratio(scene: Scene, model: Model, contact: dem.Contact | None) -> ClosedRatio | None:
    """The watch over r; None for what no force moves."""
    interface, body = model.interface, model.structure
    if interface is None or scene.structure.kind == "rigid":
        return None
    grains = None if model.particles is None else model.particles.grains
    spring = partial(interface_spring, scene, contact, grains, interface.radius)
    return ClosedRatio(interface, body, spring=spring, window=model.window, limit=stable_ratio(scene))


def _stiffness_ratio(scene: Scene, model: Model, contact: dem.Contact | None, comm: MPI.Intracomm) -> float:
    """The coupling's r; refused above the scheme's limit."""
    interface = model.interface
    if interface is None:
        return 0.0
    spring = None
    if model.particles is not None:
        spring = interface_spring(scene, contact, model.particles.grains, interface.radius)
    spring = comm.bcast(spring, root=0)
    ratio = stiffness_ratio(interface.operator, *spring, model.window, model.structure.acceleration_by)
    limit = scene.interface.largest_stiffness_ratio or stable_ratio(scene)
    if ratio > limit:
        longest = longest_window(ratio, *spring, model.window, limit)
        instead = "fewer interface.substeps, "
        if scene.interface.exchange != "iterated":
            instead += 'interface.exchange = "iterated", '
        raise LeitoError(
            f"stiffness ratio r = {ratio:.3g} of the coupling is above {limit:.4g}, where the exchange is "
            f"unstable: take time.step at most {0.95 * longest / model.substeps:.2g} s, {instead}"
            "or raise interface.largest_stiffness_ratio knowingly"
        )
    return ratio
