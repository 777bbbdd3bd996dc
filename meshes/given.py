"""Meshes from outside: arrays, or a file that gmsh reads."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import ArrayLike, NDArray

from meshes import generator
from meshes.errors import MeshError
from meshes.kinds import Kind
from meshes.polyline import trace
from meshes.session import gmsh, session
from meshes.soundness import counter_clockwise, free_sides, kind_of, outer_sides
from meshes.structure_mesh import StructureMesh

CELL_TYPES = {"triangle": {1: 2, 2: 9}, "quadrilateral": {1: 3, 2: 10}}  # gmsh's numbers, by order
LINE_TYPES = {1: 1, 2: 8}
NODES_OF_TYPE = {2: 3, 3: 4, 9: 6, 10: 9}
OUTER = "outer"
FLAT = 1e-9  # of the size: how far nodes may leave the plane


def from_arrays(
    points: ArrayLike,
    cells: ArrayLike,
    *,
    boundaries: Mapping[str, ArrayLike] | None = None,
    comm: MPI.Intracomm = MPI.COMM_WORLD,
) -> StructureMesh:
    """Mesh of given points and cells; the same arrays on every rank.

    The outer boundary is found and begins at its lowest point, of several at the leftmost. Order 2 has
    mid-side nodes, quadrilaterals also one in the middle. Cells that all run clockwise are turned round.

    Parameters
    ----------
    points : (n, 2)
        Positions [m].
    cells : (m, k)
        Nodes of each cell, from 0, in VTK order (gmsh's); k = 3 or 6: triangles of order 1 or 2; 4 or
        9: quadrilaterals.
    boundaries : name -> (f, 2)
        End nodes of the edges of each named boundary. "outer" is there without asking.

    Raises
    ------
    MeshError
        Arrays that do not fit; a point without a cell or two at one place; cells that are inverted, folded,
        flat or overlapping; several pieces; a boundary that touches or crosses itself; a named edge
        that is not on the boundary or has a name already.
    """
    points, cells = _table("points", points, float), _table("cells", cells, None)
    if not np.issubdtype(cells.dtype, np.integer):
        raise MeshError(f"cells of type {cells.dtype} must be integers, the numbers of points from 0")
    kind = kind_of(points, cells)
    cells = counter_clockwise(points, cells.astype(np.int64), kind)
    sides = free_sides(points, cells, kind)
    outer = outer_sides(points, sides)
    names = _names(sides, outer, boundaries or {})
    tags, tagged = _tags(outer, names)
    loop = {name: sides[outer & (names == name)] for name in np.unique(names[outer])}
    start = _lowest(points[sides[outer, 0]])

    def model() -> generator.Plain:
        _fill(points, cells, sides, tags, kind)
        return generator.Plain(points, cells, *trace(points, loop, start))

    return generator.shared(model, boundaries=tagged, cell=kind.cell, order=kind.order, comm=comm)


def from_gmsh(path: str | Path, *, comm: MPI.Intracomm = MPI.COMM_WORLD) -> StructureMesh:
    """Mesh of a file that gmsh reads (.msh and others), with the named physical curves as boundaries.

    Of the nodes those of cells are taken. See `from_arrays`.

    Raises
    ------
    MeshError
        No such file, none that gmsh reads, no cells or of several kinds, a mesh that is not plane; and
        what `from_arrays` refuses.
    """
    found: tuple | MeshError | None = None
    if comm.rank == 0:
        try:
            with session():
                found = _read(Path(path))
        except MeshError as error:
            found = error
    found = comm.bcast(found, root=0)
    if isinstance(found, MeshError):
        raise found
    points, cells, boundaries = found
    return from_arrays(points, cells, boundaries=boundaries, comm=comm)


def _table(name: str, rows: ArrayLike, kind: type | None) -> NDArray[Any]:
    try:
        return np.array(rows, dtype=kind)
    except ValueError:
        raise MeshError(
            f"{name} must be numbers in rows of one length: cells of one kind, edges of two nodes"
        ) from None


def _names(
    sides: NDArray[np.int64], outer: NDArray[np.bool_], boundaries: Mapping[str, ArrayLike]
) -> NDArray[np.object_]:
    """Name of each side, "outer" where none is given."""
    row = {frozenset(ends): number for number, ends in enumerate(sides[:, :2].tolist())}
    names = np.full(len(sides), OUTER, dtype=object)
    for name, given in boundaries.items():
        if not isinstance(name, str):
            raise MeshError(f"boundary {name!r} must have a name: give it a string")
        edges = _table(f"boundary '{name}'", given, None)
        if edges.ndim != 2 or edges.shape[1] != 2 or not np.issubdtype(edges.dtype, np.integer) or not len(edges):
            raise MeshError(f"boundary '{name}' of shape {edges.shape} must be (f, 2) end nodes of edges, at least one")
        numbers = [row.get(frozenset(edge)) for edge in edges.tolist()]
        for edge, number in zip(edges.tolist(), numbers, strict=True):
            if number is None:
                raise MeshError(
                    f"boundary '{name}' has the edge {tuple(edge)}, which is no side of a cell on the boundary"
                )
            if name != OUTER and names[number] not in (OUTER, name):
                raise MeshError(f"the edge {tuple(edge)} is on '{names[number]}' and on '{name}': give it one name")
        if name != OUTER:
            names[numbers] = name
        elif set(numbers) != set(np.flatnonzero(outer).tolist()):
            raise MeshError(
                f"boundary 'outer' has {len(set(numbers))} edges and is not the whole outer loop of {outer.sum()}: "
                "give it another name, or leave it out as it is found"
            )
    return names


def _tags(outer: NDArray[np.bool_], names: NDArray[np.object_]) -> tuple[NDArray[np.int64], dict[str, tuple[int, ...]]]:
    """Tag of each side, and the tags of each name: one on the outer loop, one around holes."""
    order = {name: number for number, name in enumerate(dict.fromkeys(names.tolist()))}
    tags = np.array([2 * order[name] for name in names]) + np.where(outer, 1, 2)
    tagged = {name: tuple(np.unique(tags[names == name]).tolist()) for name in order if name != OUTER}
    return tags, {OUTER: tuple(np.unique(tags[outer]).tolist()), **tagged}


def _lowest(points: NDArray[np.float64]) -> tuple[float, float]:
    """The lowest of points (n, 2), of those at one height, to nine digits of the size, the leftmost."""
    height = points[:, 1] - points[:, 1].min()
    low = points[height <= 1e-9 * np.ptp(points, axis=0).max()]
    x, y = low[np.argmin(low[:, 0])].tolist()
    return x, y


def _fill(
    points: NDArray[np.float64], cells: NDArray[np.int64], sides: NDArray[np.int64], tags: NDArray[np.int64], kind: Kind
) -> None:
    """Put nodes, cells and tagged sides into the current gmsh model."""
    model = gmsh.model
    model.addDiscreteEntity(2, 1)
    flat = np.column_stack([points, np.zeros(len(points))])
    model.mesh.addNodes(2, 1, np.arange(1, len(points) + 1), flat.ravel())
    model.mesh.addElementsByType(1, CELL_TYPES[kind.cell][kind.order], [], (cells + 1).ravel())
    model.addPhysicalGroup(2, [1], 1)
    for tag in np.unique(tags).tolist():
        model.addDiscreteEntity(1, tag)
        model.mesh.addElementsByType(tag, LINE_TYPES[kind.order], [], (sides[tags == tag] + 1).ravel())
        model.addPhysicalGroup(1, [tag], tag)


def _read(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64], dict[str, NDArray[np.int64]]]:
    """Points, cells and named edges of a file."""
    if not path.is_file():
        raise MeshError(f"{path} is no file: give the path of a mesh")
    try:
        gmsh.open(str(path))
    except Exception as error:  # gmsh raises plain ones
        raise MeshError(f"{path} is not read by gmsh: {error}") from None
    kinds, _, nodes = gmsh.model.mesh.getElements(2)
    if len(kinds) != 1 or kinds[0] not in NODES_OF_TYPE:
        names = [gmsh.model.mesh.getElementProperties(kind)[0] for kind in kinds]
        raise MeshError(
            f"{path} has cells of the kinds {names}: one kind is needed, triangles or quadrilaterals of order 1 or 2 "
            "(with a node in the middle)"
        )
    numbers, places, _ = gmsh.model.mesh.getNodes()
    used, cells = np.unique(np.asarray(nodes[0], dtype=np.int64), return_inverse=True)
    order = np.argsort(numbers)
    places = places.reshape(-1, 3)[order[np.searchsorted(numbers[order], used)]]
    if np.ptp(places[:, 2]) > FLAT * np.ptp(places, axis=0).max():
        raise MeshError(f"{path} is not plane: z runs from {places[:, 2].min():g} to {places[:, 2].max():g}")
    return places[:, :2].copy(), cells.reshape(-1, NODES_OF_TYPE[kinds[0]]), _named_edges(path, used)


def _named_edges(path: Path, used: NDArray[np.int64]) -> dict[str, NDArray[np.int64]]:
    """End nodes, as indices into the sorted node numbers `used`, of the edges of each physical curve."""
    found: dict[str, NDArray[np.int64]] = {}
    for dimension, group in gmsh.model.getPhysicalGroups(1):
        name = gmsh.model.getPhysicalName(dimension, group) or str(group)
        edges = [np.zeros((0, 2), dtype=np.int64)]
        for curve in gmsh.model.getEntitiesForPhysicalGroup(dimension, group):
            kinds, _, nodes = gmsh.model.mesh.getElements(1, curve)
            for kind, own in zip(kinds, nodes, strict=True):
                per_edge = gmsh.model.mesh.getElementProperties(kind)[3]
                edges.append(np.asarray(own, dtype=np.int64).reshape(-1, per_edge)[:, :2])
        ends = np.vstack(edges)
        if not np.isin(ends, used).all():
            raise MeshError(
                f"{path}: the physical curve '{name}' has nodes that belong to no cell: mesh it with the surface"
            )
        found[name] = np.searchsorted(used, ends)
    return found
