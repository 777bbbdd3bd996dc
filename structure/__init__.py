"""Structures: elastic by finite elements, rigid along a path, or rigid and free."""

from structure.boundary import agreed_force, withhold_force
from structure.elastic import ElasticStructure
from structure.errors import StepError, StructureError
from structure.loads.load import BodyForce, BoundaryLoad, PointLoad, Pressure
from structure.loads.schedules import Constant, Ramp, Sine, Table
from structure.material import PlaneStrain, Rayleigh
from structure.protocol import Structure
from structure.results import StructureEnergies, StructureFields, StructurePeaks
from structure.rigid.free import FreeRigid
from structure.rigid.prescribed import PrescribedRigid
from structure.schemes import GeneralizedAlpha, HilberHughesTaylor, Newmark, Scheme
from structure.solvers.options import set_solver_options, solver_options, unused_solver_options
from structure.theories.validity import beyond_meaning, departures

__all__ = [
    "BodyForce",
    "BoundaryLoad",
    "Constant",
    "ElasticStructure",
    "FreeRigid",
    "GeneralizedAlpha",
    "HilberHughesTaylor",
    "Newmark",
    "PlaneStrain",
    "PointLoad",
    "Pressure",
    "PrescribedRigid",
    "Ramp",
    "Rayleigh",
    "Scheme",
    "Sine",
    "Structure",
    "StructureEnergies",
    "StepError",
    "StructureError",
    "StructureFields",
    "StructurePeaks",
    "Table",
    "agreed_force",
    "beyond_meaning",
    "departures",
    "set_solver_options",
    "solver_options",
    "unused_solver_options",
    "withhold_force",
]
