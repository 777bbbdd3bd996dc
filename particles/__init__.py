"""Discs by the discrete element method: runs and is tested without FEniCSx."""

from particles.beds import lattice
from particles.contact import (
    ConstantTorqueRolling,
    Contact,
    ContactModel,
    ContactTable,
    CoulombFriction,
    ElasticPlasticRolling,
    GlobalDamping,
    HertzSpringDashpot,
    LinearSpringDashpot,
    Material,
    MindlinFriction,
)
from particles.crowding import packing_limit
from particles.errors import ParticleError
from particles.facets import Facets
from particles.look import ContactLook
from particles.network import StiffnessNetwork, stiffness_network
from particles.shaking import Shaking
from particles.sample import sample_limit
from particles.snapshot import Snapshot
from particles.stability import StepLimit, sharp_limit
from particles.state import Grains
from particles.system import ParticleSystem, continued
from particles.timestep import source_bound
from particles.walls import Wall, box

__all__ = [
    "ConstantTorqueRolling",
    "Contact",
    "ContactLook",
    "ContactModel",
    "ContactTable",
    "CoulombFriction",
    "ElasticPlasticRolling",
    "Facets",
    "GlobalDamping",
    "Grains",
    "HertzSpringDashpot",
    "LinearSpringDashpot",
    "Material",
    "MindlinFriction",
    "ParticleError",
    "ParticleSystem",
    "Shaking",
    "Snapshot",
    "StepLimit",
    "StiffnessNetwork",
    "Wall",
    "box",
    "continued",
    "lattice",
    "packing_limit",
    "sample_limit",
    "sharp_limit",
    "source_bound",
    "stiffness_network",
]
