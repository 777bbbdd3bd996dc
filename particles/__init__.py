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
from particles.errors import ParticleError
from particles.state import Grains
from particles.system import ContactLook, ParticleSystem, continued
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
    "GlobalDamping",
    "Grains",
    "HertzSpringDashpot",
    "LinearSpringDashpot",
    "Material",
    "MindlinFriction",
    "ParticleError",
    "ParticleSystem",
    "Wall",
    "box",
    "continued",
    "lattice",
    "source_bound",
]
