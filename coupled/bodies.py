"""The structure of a scene: its mesh, its body, its interface."""

from __future__ import annotations

import numpy as np
from mpi4py import MPI

import meshes
import structure as fem
from coupled.exchange.limit import ITERATED, exchange_limit
from coupled.interface.door import Interface
from coupled.interface.facets import FacetInterface
from coupled.interface.glued import GluedGrains
from coupled.loads import loads_of
from coupled.scene import Beam, Scene
from coupled.scene.structure import Structure as StructureTable


def mesh_of(scene: Scene, comm: MPI.Intracomm, centroid: tuple[float, float]) -> meshes.StructureMesh:
    """The mesh of a scene's structure around its centroid [m]."""
    shape = scene.structure.shape
    options = {"cell": shape.cell, "order": shape.order, "comm": comm}
    if isinstance(shape, Beam):
        corner = (centroid[0] - shape.length / 2, centroid[1] - shape.height / 2)
        return meshes.beam(
            length=shape.length, height=shape.height, along=shape.along, across=shape.across, origin=corner, **options
        )
    return meshes.tube(
        outer_radius=shape.outer_radius,
        inner_radius=shape.inner_radius,
        around=shape.around,
        layers=shape.layers,
        centre=centroid,
        **options,
    )


def interface_of(scene: Scene, mesh: meshes.StructureMesh) -> Interface:
    """The interface of a scene on its mesh."""
    table = scene.interface
    if table.kind == "facets":
        return FacetInterface(mesh.outer_polyline, boundaries=table.boundaries, closest=_smallest_diameter(scene))
    return GluedGrains(
        mesh.outer_polyline,
        per_facet=table.grains_per_facet(scene.structure.shape),
        boundaries=table.boundaries,
        diameter=table.diameter,
        mean_velocity=table.velocity == "mean",
        couple=table.couple,
    )


def _smallest_diameter(scene: Scene) -> float | None:
    """Of the grains that may meet the structure [m]; None without any."""
    radii = [row.radius for row in scene.rows]
    if scene.first_grains is not None:
        radii.append(scene.first_grains.smallest_radius)
    radii += [intruder.radius for intruder in scene.intruders]
    return 2.0 * min(radii) if radii else None


def body_of(scene: Scene, mesh: meshes.StructureMesh, centroid: tuple[float, float]) -> fem.Structure:
    """The structure of a scene on its mesh, whose centroid [m] point loads refer to."""
    table = scene.structure
    step = scene.time.step * (1 if scene.interface is None else scene.interface.substeps)
    if table.kind == "rigid":
        return fem.PrescribedRigid(mesh, path=np.array(table.path.points), time_step=step)
    loads = loads_of(table.loads, mesh, centroid)
    if table.kind == "free_rigid":
        return fem.FreeRigid(mesh, density=table.density, time_step=step, loads=loads)
    body = fem.ElasticStructure(
        mesh,
        material=fem.PlaneStrain(
            youngs_modulus=table.youngs_modulus, poissons_ratio=table.poissons_ratio, density=table.density
        ),
        time_step=step,
        damping=None
        if table.rayleigh is None
        else fem.Rayleigh(mass_factor=table.rayleigh.mass_factor, stiffness_factor=table.rayleigh.stiffness_factor),
        scheme=scheme_of(table),
        loads=loads,
        element=table.element,
        theory=table.theory,
    )
    body.require_resolved()
    if table.initial is not None:
        body.release_from_mode(table.initial.mode, table.initial.amplitude)
    return body


def scheme_of(table: StructureTable) -> fem.Scheme:
    """The scheme of time integration of an elastic structure."""
    if table.generalised_alpha is not None:
        return fem.GeneralizedAlpha(spectral_radius=table.generalised_alpha.spectral_radius)
    if table.hht is not None:
        return fem.HilberHughesTaylor(alpha=table.hht.alpha)
    return fem.Newmark(beta=table.newmark.beta, gamma=table.newmark.gamma)


def stable_ratio(scene: Scene) -> float:
    """The stiffness ratio up to which the exchange of a scene is stable on fixed partners."""
    if scene.interface.exchange == "iterated":
        return ITERATED
    scheme = scheme_of(scene.structure) if scene.structure.kind == "elastic" else fem.Newmark()
    return exchange_limit(scheme, scene.interface.substeps)
