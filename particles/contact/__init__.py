"""Contact laws of discs: parameters with their meaning. The arithmetic is in `particles.kernels.laws`."""

from particles.contact.damping import GlobalDamping
from particles.contact.model import ContactModel
from particles.contact.normal import LinearSpringDashpot
from particles.contact.rolling import ElasticPlasticRolling
from particles.contact.tangential import CoulombFriction

__all__ = ["ContactModel", "CoulombFriction", "ElasticPlasticRolling", "GlobalDamping", "LinearSpringDashpot"]
