"""A ring of structured cells: the tube."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from meshes import generator
from meshes.errors import MeshError
from meshes.session import gmsh
from meshes.structure_mesh import StructureMesh

PIECES = ("free_arc", "loaded_arc", "inner")
LARGEST_SECTOR = math.radians(100.0)


def tube(
    *,
    outer_radius: float,
    inner_radius: float,
    around: int = 30,
    layers: int = 2,
    centre: tuple[float, float] = (0.0, 0.0),
    loaded_arc_degrees: float = 120.0,
    cell: str = "quadrilateral",
    order: int = 1,
    comm: MPI.Intracomm = MPI.COMM_WORLD,
) -> StructureMesh:
    """Ring between two radii [m], ``around`` x ``layers`` cells, a node at its lowest point.

    Boundaries: "outer", "inner" and "loaded_arc", the facets of "outer" that cover
    `loaded_arc_degrees` symmetrically about the top; "free_arc" is the rest of "outer". The arc
    is made of whole facets: as many as come nearest to the angle wanted (30 around and 120
    degrees: exactly 10). The polyline begins at the lowest point. G 4.2 uses 30 x 2
    quadrilaterals of order 1.

    Raises
    ------
    MeshError
        A radius, a number of cells, an angle, a cell or an order out of range.
    """
    generator.check_length("outer_radius", outer_radius)
    generator.check_length("inner_radius", inner_radius)
    if inner_radius >= outer_radius:
        raise MeshError(f"inner_radius = {inner_radius!r} must be smaller than outer_radius = {outer_radius!r}")
    generator.check_count("around", around, 6)
    generator.check_count("layers", layers, 1)
    generator.check_point("centre", centre)
    generator.check_elements(cell, order)
    loaded = _loaded_facets(around, loaded_arc_degrees)
    return generator.build(
        lambda: _draw((inner_radius, outer_radius), (around, layers), loaded, centre, (cell, order)),
        names=PIECES,
        outer=("free_arc", "loaded_arc"),
        aliases={
            "outer": ("free_arc", "loaded_arc"),
            "free_arc": ("free_arc",),
            "loaded_arc": ("loaded_arc",),
            "inner": ("inner",),
        },
        start=(float(centre[0]), float(centre[1]) - outer_radius),
        cell=cell,
        order=order,
        comm=comm,
    )


def _loaded_facets(around: int, degrees: float) -> int:
    """Number of facets of the arc: symmetric about the top, hence of the parity of `around`."""
    if not 0.0 < degrees < 360.0:
        raise MeshError(f"loaded_arc_degrees = {degrees!r} must lie between 0 and 360")
    parity = around % 2
    count = 2 * round((degrees / 360.0 * around - parity) / 2) + parity
    return min(max(count, 2 - parity), around - 2)


def _breaks(around: int, loaded: int) -> list[int]:
    """Facet numbers, counter-clockwise from the lowest point, where a sector begins or ends."""
    first = (around - loaded) // 2
    stops = [0, first, first + loaded, around]
    breaks = [0]
    for begin, end in zip(stops[:-1], stops[1:]):
        pieces = max(1, math.ceil((end - begin) / around * 2 * math.pi / LARGEST_SECTOR))
        breaks += [begin + round((end - begin) * k / pieces) for k in range(1, pieces + 1)]
    return sorted(set(breaks))


def _snap(
    radii: tuple[float, float], divisions: tuple[int, int], centre: tuple[float, float], order: int
) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """Positions to the polar grid of the ring, mid-side nodes included."""
    around, layers = divisions[0] * order, divisions[1] * order

    def snap(places: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y = (places - centre).T
        ray = np.rint(np.arctan2(y, x) / (2 * np.pi) * around + around / 4) - around / 4
        angle = ray * (2 * np.pi / around)
        ring = np.rint((np.hypot(x, y) - radii[0]) / (radii[1] - radii[0]) * layers)
        radius = radii[0] + ring * ((radii[1] - radii[0]) / layers)
        return centre + np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])

    return snap


def _point(centre: tuple[float, float], radius: float, angle: float) -> int:
    x, y = centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)
    return gmsh.model.geo.addPoint(x, y, 0.0)


def _draw(
    radii: tuple[float, float],
    divisions: tuple[int, int],
    loaded: int,
    centre: tuple[float, float],
    elements: tuple[str, int],
) -> generator.Drawing:
    """Sectors between the breaks, each a transfinite patch; sector k spans break k to k + 1."""
    geo = gmsh.model.geo
    (around, layers), (cell, order) = divisions, elements
    breaks = _breaks(around, loaded)
    first = (around - loaded) // 2
    middle = geo.addPoint(centre[0], centre[1], 0.0)
    angles = [2 * math.pi * b / around - math.pi / 2 for b in breaks[:-1]]
    inner, outer = ([_point(centre, radius, angle) for angle in angles] for radius in radii)
    spokes = [geo.addLine(i, o) for i, o in zip(inner, outer)]
    for spoke in spokes:
        geo.mesh.setTransfiniteCurve(spoke, layers + 1)
    curves: dict[str, list[int]] = {name: [] for name in PIECES}
    surfaces = []
    for k, (begin, end) in enumerate(zip(breaks[:-1], breaks[1:])):
        n = (k + 1) % len(angles)
        arcs = [geo.addCircleArc(ring[k], middle, ring[n]) for ring in (inner, outer)]
        for arc in arcs:
            geo.mesh.setTransfiniteCurve(arc, end - begin + 1)
        surfaces.append(
            generator.transfinite_surface(
                [spokes[k], arcs[1], -spokes[n], -arcs[0]],
                [inner[k], outer[k], outer[n], inner[n]],
                cell,
            )
        )
        curves["inner"].append(arcs[0])
        curves["loaded_arc" if first <= begin < first + loaded else "free_arc"].append(arcs[1])
    return generator.Drawing(
        curves=curves,
        surfaces=surfaces,
        snap=_snap(radii, divisions, centre, order),
        auxiliary=(middle,),
    )
