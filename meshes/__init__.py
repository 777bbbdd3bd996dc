"""Shapes: gmsh or given arrays to a mesh with named boundaries and its outer boundary as plain arrays."""

from meshes.beam import beam
from meshes.errors import MeshError
from meshes.given import from_arrays, from_gmsh
from meshes.polyline import BoundaryPolyline
from meshes.structure_mesh import StructureMesh
from meshes.tube import tube

__all__ = ["BoundaryPolyline", "MeshError", "StructureMesh", "beam", "from_arrays", "from_gmsh", "tube"]
