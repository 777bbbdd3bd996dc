"""Structures: elastic by finite elements, rigid along a path, or rigid and free."""

from structure.elastic import ElasticStructure
from structure.errors import StructureError
from structure.free_rigid import FreeRigid
from structure.loads import BodyForce, BoundaryLoad, PointLoad
from structure.material import PlaneStrain, Rayleigh
from structure.newmark import Newmark
from structure.prescribed import PrescribedRigid
from structure.protocol import Structure
from structure.results import StructureEnergies, StructureFields, StructurePeaks

__all__ = [
    "BodyForce",
    "BoundaryLoad",
    "ElasticStructure",
    "FreeRigid",
    "Newmark",
    "PlaneStrain",
    "PointLoad",
    "PrescribedRigid",
    "Rayleigh",
    "Structure",
    "StructureEnergies",
    "StructureError",
    "StructureFields",
    "StructurePeaks",
]
