"""The contact features of one scene, checked together."""

from dataclasses import dataclass

from particles.contact.normal import LinearSpringDashpot
from particles.contact.rolling import ElasticPlasticRolling
from particles.contact.tangential import CoulombFriction
from particles.errors import ParticleError


@dataclass(frozen=True, kw_only=True)
class ContactModel:
    """What two touching grains, or a grain and a wall, do to each other.

    A feature that is None is not modelled and not compiled: without friction there is no
    tangential spring and no spin.

    Raises
    ------
    ParticleError
        If rolling resistance is asked for without friction.
    """

    normal: LinearSpringDashpot
    tangential: CoulombFriction | None = None
    rolling: ElasticPlasticRolling | None = None

    def __post_init__(self) -> None:
        if self.rolling is not None and self.tangential is None:
            raise ParticleError("rolling resistance needs friction: give the contact model a tangential law as well")

    @property
    def spins(self) -> bool:
        """Whether grains turn."""
        return self.tangential is not None

    @property
    def rolls(self) -> bool:
        """Whether contacts carry a rolling moment."""
        return self.rolling is not None
