"""Cells that are too stiff for what they are used for; numbers from docs/validation/elements.md."""

from __future__ import annotations

import math

from coupled.scene import Scene
from coupled.scene.shape import Beam, Shape

INCOMPRESSIBLE = 0.45  # from here on stress at the nodes of standard cells, order 2 as well, is off by 20 % and more


def locking(scene: Scene) -> list[str]:
    """A sentence on standard cells that lock near nu = 0.5, or in bending, by how much."""
    structure = scene.structure
    if structure is None or structure.element != "standard":
        return []
    if structure.poissons_ratio > INCOMPRESSIBLE:
        return [
            f"structure.poissons_ratio = {structure.poissons_ratio:g} is near 0.5, where standard cells lock and show "
            'no stress to rely on: take quadrilaterals of order 1 with structure.element = "enhanced"'
        ]
    if structure.shape.order == 1:
        ratio = bending_stiffness_ratio(structure.shape, structure.poissons_ratio)
        enhanced = (
            "" if structure.theory == "large_strain" else 'quadrilaterals with structure.element = "enhanced" or '
        )
        return [
            f"standard cells of order 1 lock: this structure bends about {ratio:.3g} times as stiff as it should, with "
            f"frequencies {math.sqrt(ratio):.3g} times too high: take {enhanced}order = 2"
        ]
    return []


def bending_stiffness_ratio(shape: Shape, poissons_ratio: float) -> float:
    """About how many times too stiff a wall of standard cells of order 1 bends.

    Bent with the curvature c, a cell of length l has the parasitic shear strain c x, |x| <= l/2, whose mean square is
    ``c^2 l^2/12``; that the height H cannot curve costs one layer as much as if its sides were held. In n layers of
    quadrilaterals, relative to ``E' c^2 H^2/12``,

        1 + (1 - nu)/2 (l/H)^2 + ((1 - nu)^2/(1 - 2 nu) - 1)/n^2

    Triangles see the largest shear and strain of a cell in place of the linear ones, three times the mean square:
    ``1 + 3 (1 - nu)/2 (l/H)^2 + 2/n^2``. Against frequencies of beams to 3 % for quadrilaterals and to 25 % for
    triangles (tests).
    """
    if isinstance(shape, Beam):
        length, height, layers = shape.length / shape.along, shape.height, shape.across
    else:
        middle = 0.5 * (shape.outer_radius + shape.inner_radius)
        length, height = 2.0 * math.pi * middle / shape.around, shape.outer_radius - shape.inner_radius
        layers = shape.layers
    shear = 0.5 * (1.0 - poissons_ratio) * (length / height) ** 2
    if shape.cell == "triangle":
        return 1.0 + 3.0 * shear + 2.0 / layers**2
    held = (1.0 - poissons_ratio) ** 2 / (1.0 - 2.0 * poissons_ratio) - 1.0
    return 1.0 + shear + held / layers**2
