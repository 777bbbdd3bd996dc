"""Rules of the theory of an elastic structure: what goes with one that is not linear."""

from __future__ import annotations

from coupled.scene.refusal import refusal
from coupled.scene.schemes import SCHEMES, Newmark
from coupled.scene.structure import Structure


def check_theory(structure: Structure) -> None:
    """Check that scheme and element go with the theory."""
    theory = structure.theory
    if theory in (None, "linear"):
        return
    for name in SCHEMES:
        scheme = getattr(structure, name)
        if scheme is not None and scheme != Newmark():
            raise refusal(
                f"structure.{name}",
                scheme.model_dump(),
                f'is for structure.theory = "linear"; remove it: "{theory}" has a step that keeps energy and angular '
                "momentum, which for small motion is Newmark's with beta = 0.25, gamma = 0.5",
            )
    if theory == "large_strain" and structure.element == "enhanced":
        raise refusal(
            "structure.element",
            "enhanced",
            'enhances small strains and does not go with structure.theory = "large_strain"; give "standard", with '
            "order = 2 of the shape where it bends",
        )
