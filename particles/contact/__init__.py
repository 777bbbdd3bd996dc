"""Contact laws of discs: parameters with their meaning. The arithmetic is in `particles.kernels.laws`."""

from particles.contact.damping import GlobalDamping
from particles.contact.material import Material
from particles.contact.model import Contact, ContactModel, ContactTable
from particles.contact.normal import HertzSpringDashpot, LinearSpringDashpot
from particles.contact.rolling import ConstantTorqueRolling, ElasticPlasticRolling
from particles.contact.tangential import CoulombFriction, MindlinFriction

__all__ = [
    "ConstantTorqueRolling",
    "Contact",
    "ContactModel",
    "ContactTable",
    "CoulombFriction",
    "ElasticPlasticRolling",
    "GlobalDamping",
    "HertzSpringDashpot",
    "LinearSpringDashpot",
    "Material",
    "MindlinFriction",
]
