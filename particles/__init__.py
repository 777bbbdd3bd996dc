"""Discs by the discrete element method: runs and is tested without FEniCSx."""

from particles.beds import lattice
from particles.contact import ContactModel, CoulombFriction, ElasticPlasticRolling, GlobalDamping, LinearSpringDashpot
from particles.errors import ParticleError
from particles.state import Grains
from particles.system import ContactLook, ParticleSystem, continued
from particles.timestep import source_bound
from particles.walls import Wall, box

__all__ = [
    "ContactLook",
    "ContactModel",
    "CoulombFriction",
    "ElasticPlasticRolling",
    "GlobalDamping",
    "Grains",
    "LinearSpringDashpot",
    "ParticleError",
    "ParticleSystem",
    "Wall",
    "box",
    "continued",
    "lattice",
    "source_bound",
]
