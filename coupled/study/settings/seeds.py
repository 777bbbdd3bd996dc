"""The seeds of a scene: what chance there is in it, and how a sample of it is asked for."""

from __future__ import annotations

from coupled.errors import LeitoError
from coupled.scene import Scene, chance

FEW = 20  # grains: with fewer, a lattice tells more of its order than of chance
SAMPLES = 5  # Student's t at 95 % is then 2.8 standard errors


def seed_key(scene: Scene) -> str | None:
    """Key of the seed of a scene's grains, or of its bed's; None without chance, and with too few grains for it."""
    key = chance.seed_key(scene)
    return None if key is None or scene.first_grains.count < FEW else key


def seeds_of(scene: Scene, samples: int | None) -> tuple[int, ...]:
    """Seeds of the samples of every setting; none where nothing is left to chance.

    Raises
    ------
    LeitoError
        If samples are asked for and there is no chance.
    """
    if samples is not None and samples < 1:
        raise LeitoError(f"--seeds {samples}: must be at least 1; several tell chance from error")
    if seed_key(scene) is None:
        if samples is not None and samples > 1:
            raise LeitoError(
                f"--seeds {samples}: the scene lays no grains out by chance, all samples would be the same; leave "
                "--seeds out"
            )
        return ()
    first = scene.first_grains.seed
    return tuple(range(first, first + (samples or SAMPLES)))
