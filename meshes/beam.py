"""A rectangle of structured cells: the beam."""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from meshes import generator
from meshes.session import gmsh
from meshes.structure_mesh import StructureMesh

SIDES = ("bottom", "right", "top", "left")


def beam(
    *,
    length: float,
    height: float,
    along: int = 40,
    across: int = 2,
    origin: tuple[float, float] = (0.0, 0.0),
    cell: str = "quadrilateral",
    order: int = 1,
    comm: MPI.Intracomm = MPI.COMM_WORLD,
) -> StructureMesh:
    """Rectangle ``length`` x ``height`` [m] of ``along`` x ``across`` equal cells.

    Boundaries: "bottom", "right", "top", "left", and "outer", their union. The polyline begins at
    the lower left corner, which sits at `origin`. G 3.4 uses 40 x 2 quadrilaterals of order 1.

    Raises
    ------
    MeshError
        A length, a number of cells, a cell or an order out of range.
    """
    generator.check_length("length", length)
    generator.check_length("height", height)
    generator.check_count("along", along, 1)
    generator.check_count("across", across, 1)
    generator.check_point("origin", origin)
    generator.check_elements(cell, order)
    return generator.build(
        lambda: _draw((length, height), (along, across), origin, cell, order),
        names=SIDES,
        outer=SIDES,
        aliases={"outer": SIDES, **{side: (side,) for side in SIDES}},
        start=(float(origin[0]), float(origin[1])),
        cell=cell,
        order=order,
        comm=comm,
    )


def _draw(
    size: tuple[float, float],
    divisions: tuple[int, int],
    origin: tuple[float, float],
    cell: str,
    order: int,
) -> generator.Drawing:
    geo = gmsh.model.geo
    (x, y), (length, height) = origin, size
    corners = [
        geo.addPoint(x, y, 0.0),
        geo.addPoint(x + length, y, 0.0),
        geo.addPoint(x + length, y + height, 0.0),
        geo.addPoint(x, y + height, 0.0),
    ]
    sides = [geo.addLine(corners[k], corners[(k + 1) % 4]) for k in range(4)]
    for side, count in zip(sides, divisions * 2):
        geo.mesh.setTransfiniteCurve(side, count + 1)
    surface = generator.transfinite_surface(sides, corners, cell)
    spacing = np.array(size) / (np.array(divisions) * order)

    def snap(places: NDArray[np.float64]) -> NDArray[np.float64]:
        return origin + np.rint((places - origin) / spacing) * spacing

    return generator.Drawing(curves={name: [side] for name, side in zip(SIDES, sides)}, surfaces=[surface], snap=snap)
