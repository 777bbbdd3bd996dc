"""What chance there is in a scene, and the key that draws another sample of it."""

from __future__ import annotations

from coupled.scene.grains import Grains
from coupled.scene.scene import Scene


def seed_key(scene: Scene) -> str | None:
    """Key of the seed that lays a scene's grains out, in its bed if it stands on one.

    None where it changes nothing: without grains, on a lattice of equal grains without jitter, and for grains
    that are listed with their radii.
    """
    prefix, here = "", scene
    while here.bed is not None:
        prefix, here = f"{prefix}bed.", here.bed
    grains = here.grains
    return f"{prefix}grains.seed" if isinstance(grains, Grains) and _drawn(grains) else None


def _drawn(grains: Grains) -> bool:
    """Whether radii, their order or places are drawn."""
    if any(size.spread > 0.0 for size in grains.sizes):
        return True
    shuffled = len({size.radius for size in grains.sizes}) > 1
    return grains.layout == "lattice" and (shuffled or grains.jitter > 0.0)
