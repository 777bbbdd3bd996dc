"""What a shape hands to the structure: the mesh, its names and its outer boundary."""

from __future__ import annotations

from dataclasses import dataclass

import dolfinx
import numpy as np
from numpy.typing import NDArray

from meshes.polyline import BoundaryPolyline


@dataclass(frozen=True, kw_only=True)
class StructureMesh:
    """A meshed shape with named boundaries.

    "Original" numbering is that of the generator: it does not depend on the number of ranks, and
    the arrays below are the same on every rank.

    Attributes
    ----------
    domain : dolfinx.mesh.Mesh
        The distributed mesh, geometric dimension 2.
    facet_tags : dolfinx.mesh.MeshTags
        Tags of the boundary facets.
    boundaries : dict
        Name of a boundary -> tags of its facets. "outer" contains every outer facet.
    outer_polyline : BoundaryPolyline
        The outer boundary, counter-clockwise.
    outer_nodes : (n_b,)
        Original number of the node under each point of the polyline.
    points : (n, 2)
        Reference positions [m] of all nodes in original order.
    cells : (m, k)
        Original numbers of the nodes of each cell, in VTK order.
    cell : str
        "quadrilateral" or "triangle".
    order : int
        Order of the elements, 1 or 2.
    """

    domain: dolfinx.mesh.Mesh
    facet_tags: object
    boundaries: dict[str, tuple[int, ...]]
    outer_polyline: BoundaryPolyline
    outer_nodes: NDArray[np.int64]
    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    cell: str
    order: int
