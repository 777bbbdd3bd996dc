"""The contact features of one scene, checked together, for one material or a table of several."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from particles.contact.normal import HertzSpringDashpot, LinearSpringDashpot
from particles.contact.rolling import ConstantTorqueRolling, ElasticPlasticRolling
from particles.contact.tangential import CoulombFriction, MindlinFriction
from particles.errors import ParticleError
from particles.kernels.laws.response import Laws
from particles.kernels.laws.rolling import DampedRolling
from particles.kernels.laws.rolling import ElasticPlasticRolling as ElasticPlastic

NormalLaw: TypeAlias = LinearSpringDashpot | HertzSpringDashpot
TangentialLaw: TypeAlias = CoulombFriction | MindlinFriction
RollingLaw: TypeAlias = ElasticPlasticRolling | ConstantTorqueRolling


@dataclass(frozen=True, kw_only=True)
class ContactModel:
    """What two touching grains, or a grain and a wall, do to each other.

    A feature that is None is not modelled and not compiled: without friction there is no
    tangential spring and no spin.

    Raises
    ------
    ParticleError
        If rolling resistance is asked for without friction, or with a spring that would follow
        a tangential stiffness that changes with the overlap.
    """

    normal: NormalLaw
    tangential: TangentialLaw | None = None
    rolling: RollingLaw | None = None

    def __post_init__(self) -> None:
        if self.rolling is not None and self.tangential is None:
            raise ParticleError("rolling resistance needs friction: give the contact model a tangential law as well")
        changes = isinstance(self.normal, HertzSpringDashpot) and isinstance(self.tangential, MindlinFriction)
        if changes and isinstance(self.rolling, ElasticPlasticRolling) and self.rolling.stiffness is None:
            raise ParticleError(
                "the rolling spring cannot follow Mindlin's stiffness, which changes with the overlap: "
                "give the rolling stiffness outright"
            )

    @property
    def spins(self) -> bool:
        """Whether grains turn."""
        return self.tangential is not None

    @property
    def rolls(self) -> bool:
        """Whether contacts remember a rolling moment."""
        return isinstance(self.rolling, ElasticPlasticRolling)

    @property
    def damps_rolling(self) -> bool:
        """Whether a part of the rolling moment is not stored."""
        return self.rolling is not None and not (self.rolls and self.rolling.damping_ratio == 0.0)

    @property
    def materials(self) -> int:
        """Number of materials told apart."""
        return 1

    def models_of(self, materials: Iterable[int]) -> Iterator["ContactModel"]:
        """The laws between some materials and all others."""
        yield self

    def numbers(self) -> Laws:
        parts = (self.normal, self.tangential, self.rolling)
        return Laws(*(None if part is None else part.numbers() for part in parts))


class ContactTable:
    """Contact laws by pairs of materials.

    Parameters
    ----------
    rows : (m, m) nested sequence of ContactModel
        ``rows[a][b]`` is the law between materials a and b; symmetric. `Grains.material` and
        `Wall.material` are the numbers a and b.

    Raises
    ------
    ParticleError
        If the table is not square and symmetric, or two entries are of different kinds: all pairs
        share the features, not their numbers. Where a feature is to do nothing, give zero friction.
    """

    def __init__(self, rows: Sequence[Sequence[ContactModel]]) -> None:
        self.rows = tuple(tuple(row) for row in rows)
        self.materials = len(self.rows)
        if not self.rows or any(len(row) != self.materials for row in self.rows):
            raise ParticleError("a table of contact laws needs as many columns as rows")
        for a, row in enumerate(self.rows):
            for b, model in enumerate(row):
                if model != self.rows[b][a]:
                    raise ParticleError(f"the contact laws of materials {a}, {b} and {b}, {a} differ: make them equal")
        self.spins, self.rolls = self._shared("spins"), self._shared("rolls")
        self.damps_rolling = any(model.damps_rolling for model in self.models())
        self._numbers = _stacked([[self._with_dashpot(model.numbers()) for model in row] for row in self.rows])

    def _with_dashpot(self, laws: Laws) -> Laws:
        """A rolling spring with a dashpot of zero where other pairs have one."""
        if self.damps_rolling and isinstance(laws.rolling, ElasticPlastic):
            return laws._replace(rolling=DampedRolling(*laws.rolling, 0.0))
        return laws

    def _shared(self, feature: str) -> bool:
        found = {getattr(model, feature) for model in self.models()}
        if len(found) > 1:
            raise ParticleError(
                f"the contact laws of the materials differ in kind ({feature}): use zeros instead of None"
            )
        return found.pop()

    def models(self) -> Iterator[ContactModel]:
        """The laws of all pairs of materials."""
        yield from self.models_of(range(self.materials))

    def models_of(self, materials: Iterable[int]) -> Iterator[ContactModel]:
        """The laws between some materials and all others."""
        for a in materials:
            yield from self.rows[a]

    def numbers(self) -> Laws:
        return self._numbers


Contact: TypeAlias = ContactModel | ContactTable


def _stacked(table: list[list[Any]]) -> Any:
    """One law whose numbers are (m, m) arrays, out of a table of laws of one kind."""
    first = table[0][0]
    kinds = {type(entry) for row in table for entry in row}
    if len(kinds) > 1:
        names = " and ".join(sorted(kind.__name__ for kind in kinds))
        raise ParticleError(f"the contact laws of the materials are of different kinds ({names}): choose one")
    if first is None:
        return None
    if isinstance(first, tuple):
        return type(first)(*(_stacked([[entry[k] for entry in row] for row in table]) for k in range(len(first))))
    if isinstance(first, bool):
        if len({entry for row in table for entry in row}) > 1:
            raise ParticleError("either all pairs of materials may pull or none")
        return first
    return np.array(table, float)
