"""From a drawn shape to a StructureMesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from meshes.errors import MeshError
from meshes.polyline import BoundaryPolyline, trace
from meshes.session import gmsh, gmshio, session
from meshes.structure_mesh import StructureMesh

CELLS = ("quadrilateral", "triangle")


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """A shape drawn in the current gmsh model, ready to be meshed.

    `curves` maps a boundary name to the curves on it; outer curves run counter-clockwise.
    `surfaces` are transfinite patches. `snap` maps node positions (n, 2), which gmsh places to
    about 1e-8, to the exact ones. `auxiliary` points carry no node of the mesh.
    """

    curves: dict[str, list[int]]
    surfaces: list[int]
    snap: Callable[[NDArray[np.float64]], NDArray[np.float64]]
    auxiliary: tuple[int, ...] = ()


class Plain(NamedTuple):
    """What is the same on every rank: nodes, cells, and the outer boundary with the nodes under it."""

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    polyline: BoundaryPolyline
    outer_nodes: NDArray[np.int64]


def transfinite_surface(curves: list[int], corners: list[int], cell: str, arrangement: str = "AlternateLeft") -> int:
    """Structured patch inside the closed loop of `curves`; returns the surface."""
    surface = gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(curves)])
    gmsh.model.geo.mesh.setTransfiniteSurface(surface, arrangement, corners)
    if cell == "quadrilateral":
        gmsh.model.geo.mesh.setRecombine(2, surface)
    return surface


def build(
    draw: Callable[[], Drawing],
    *,
    names: tuple[str, ...],
    outer: tuple[str, ...],
    aliases: dict[str, tuple[str, ...]],
    start: tuple[float, float],
    cell: str,
    order: int,
    comm: MPI.Intracomm,
) -> StructureMesh:
    """Draw and mesh on rank 0, distribute, and name the boundaries.

    Parameters
    ----------
    draw
        Draws the shape in the current gmsh model; called on rank 0 only.
    names
        Names of the tagged boundary pieces; the k-th gets tag k + 1.
    outer
        Pieces of the outer loop.
    aliases
        Public boundary name -> the pieces that form it.
    start
        Where the outer polyline begins.
    """
    tag = {name: number for number, name in enumerate(names, start=1)}
    return shared(
        lambda: _generate(draw(), tag, outer, start, order),
        boundaries={public: tuple(tag[p] for p in pieces) for public, pieces in aliases.items()},
        cell=cell,
        order=order,
        comm=comm,
    )


def shared(
    model: Callable[[], Plain], *, boundaries: dict[str, tuple[int, ...]], cell: str, order: int, comm: MPI.Intracomm
) -> StructureMesh:
    """Distribute a model that rank 0 makes in gmsh.

    Parameters
    ----------
    model
        Fills the current gmsh model with a mesh whose boundaries are tagged; called on rank 0 only.
    boundaries
        Name of a boundary -> tags of its facets.
    """
    if comm.rank == 0:
        with session():
            plain = model()
            comm.bcast(plain, root=0)
            domain, facet_tags = _distribute(comm)
    else:
        plain = comm.bcast(None, root=0)
        domain, facet_tags = _distribute(comm)
    return StructureMesh(
        domain=domain,
        facet_tags=facet_tags,
        boundaries=boundaries,
        outer_polyline=plain.polyline,
        outer_nodes=plain.outer_nodes,
        points=plain.points,
        cells=plain.cells,
        cell=cell,
        order=order,
    )


def _generate(
    drawing: Drawing,
    tag: dict[str, int],
    outer: tuple[str, ...],
    start: tuple[float, float],
    order: int,
) -> Plain:
    """Mesh the drawing on this rank."""
    gmsh.model.geo.synchronize()
    for name, number in tag.items():
        gmsh.model.addPhysicalGroup(1, drawing.curves[name], number)
    gmsh.model.addPhysicalGroup(2, drawing.surfaces, 1)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 0)
    gmsh.model.mesh.generate(2)
    if order == 2:
        gmsh.model.mesh.setOrder(2)
    if drawing.auxiliary:
        gmsh.model.mesh.clear([(0, point) for point in drawing.auxiliary])
        gmsh.model.mesh.renumberNodes()
    _snap(drawing.snap)
    places = gmshio.extract_geometry(gmsh.model)
    points = np.empty((len(places), 2))  # of the plain type: gmsh's own is unknown to mpi4py
    points[:] = places[:, :2]
    cells = np.vstack([_connectivity(2, surface) for surface in drawing.surfaces])
    edges = {name: np.vstack([_connectivity(1, curve) for curve in drawing.curves[name]]) for name in outer}
    return Plain(points, cells, *trace(points, edges, start))


def _snap(snap: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> None:
    """Move every node of the model to its exact place."""
    places = gmshio.extract_geometry(gmsh.model)
    places[:, :2] = snap(places[:, :2])
    for number, place in enumerate(places, start=1):
        gmsh.model.mesh.setNode(number, place, [])


def _connectivity(dimension: int, entity: int) -> NDArray[np.int64]:
    """Zero-based nodes of the elements of one gmsh entity, gmsh order (VTK's up to order 2)."""
    kinds, _, nodes = gmsh.model.mesh.getElements(dimension, entity)
    assert len(kinds) == 1, "a transfinite patch has one kind of element"
    per_element = gmsh.model.mesh.getElementProperties(kinds[0])[3]
    return np.asarray(nodes[0], dtype=np.int64).reshape(-1, per_element) - 1


def _distribute(comm: MPI.Intracomm) -> tuple:
    """The current gmsh model of rank 0 as a distributed mesh with facet tags."""
    domain, _, facet_tags = gmshio.model_to_mesh(gmsh.model, comm, 0, gdim=2)[:3]
    return domain, facet_tags


def check_elements(cell: str, order: int) -> None:
    """Refuse a cell or an order that is not offered."""
    if cell not in CELLS:
        raise MeshError(f"cell = {cell!r} is not known: use 'quadrilateral' or 'triangle'")
    if order not in (1, 2):
        raise MeshError(f"order = {order!r} is not offered: use 1 or 2")


def check_count(name: str, value: int, least: int) -> None:
    """Refuse a number of divisions below `least` or not an integer."""
    if not isinstance(value, (int, np.integer)) or value < least:
        raise MeshError(f"{name} = {value!r} must be an integer of at least {least}")


def check_length(name: str, value: float) -> None:
    """Refuse a length that is not finite and positive."""
    if not np.isfinite(value) or value <= 0:
        raise MeshError(f"{name} = {value!r} must be a finite length above 0 (metres)")


def check_point(name: str, value: tuple[float, float]) -> None:
    """Refuse anything but two finite coordinates."""
    if np.shape(value) != (2,) or not np.all(np.isfinite(value)):
        raise MeshError(f"{name} = {value!r} must be two finite coordinates (x, y) in metres")
