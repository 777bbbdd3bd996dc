"""The theory of this name on a body."""

from __future__ import annotations

from typing import get_args

from structure.discrete import DiscreteBody
from structure.elements import ElementName
from structure.errors import StructureError
from structure.material import PlaneStrain, Rayleigh
from structure.schemes import Newmark, Scheme
from structure.theories.corotational import CorotationalTheory
from structure.theories.large_strain import LargeStrainTheory
from structure.theories.linear import LinearTheory
from structure.theories.theory import Theory, TheoryName


def theory_of(
    name: TheoryName,
    body: DiscreteBody,
    material: PlaneStrain,
    *,
    element: ElementName | None,
    damping: Rayleigh | None,
    scheme: Scheme,
    time_step: float,
) -> Theory:
    """Build the theory that is asked for.

    Raises
    ------
    StructureError
        The name is not known, or the theory is not for this element or scheme.
    """
    if name == "linear":
        return LinearTheory(body, material, element=element, damping=damping, scheme=scheme, time_step=time_step)
    if name not in get_args(TheoryName):
        raise StructureError(f"theory = {name!r} is not known: use one of {', '.join(get_args(TheoryName))}")
    if scheme != Newmark():
        raise StructureError(
            f"scheme = {scheme!r} is for theory = 'linear': theory = '{name}' has a step that keeps energy and "
            "angular momentum, Newmark's (1/4, 1/2) for small motion; leave the scheme out"
        )
    kind = {"corotational": CorotationalTheory, "large_strain": LargeStrainTheory}[name]
    return kind(body, material, element=element, damping=damping, time_step=time_step)
