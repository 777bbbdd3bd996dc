"""What to change about a run that has failed, with numbers."""

from __future__ import annotations

import math

from coupled.bodies import stable_ratio
from coupled.build import Built
from coupled.running.sign import Sign
from coupled.step import StepLimits, limits_of

SHARE_OF_LIMIT = 0.8  # of the limit of the contacts, to be on the safe side of those to come
WANTED_OVERLAP = 0.1  # of the smaller radius
OTHERS = {
    "deformation": "give the structure smaller loads or gentler impacts, a larger youngs_modulus, or a theory that "
    "goes farther",
    "wall": "keep the structure inside, by [[rows]] of fixed grains along the wall, other loads or a shorter duration, "
    "or leave the wall out of box.walls",
    "inside": "start with the structure clear of the grains; with glued grains leave no gaps between them and no "
    'boundary without, or take interface.kind = "facets"',
}


def smaller_step(built: Built, limits: StepLimits | None, largest: float = 1.0) -> float:
    """A whole fraction [s] of the time step, at most half of it, within the limits of any packing and of the coupling.

    A whole one, so that the run can be taken up with it. Of any packing, as that of the present
    contacts falls where more are made. `limits` are those of the grains, if there are any; `largest` is a limit of
    another kind, over the present step.
    """
    step = built.scene.time.step
    wanted = min(0.5, SHARE_OF_LIMIT * largest) * step
    if limits is not None and not limits.of_packing <= 1.0:
        wanted = min(wanted, SHARE_OF_LIMIT * limits.packing)
    if built.scene.interface is not None and built.stiffness_ratio > 0.0:
        wanted = min(wanted, SHARE_OF_LIMIT * step * stable_ratio(built.scene) / built.stiffness_ratio)
    return step / math.ceil(step / wanted * (1.0 - 1e-9))


def remedy(built: Built, sign: Sign) -> str:
    """What to change, in words that follow "to change"; the model stands before the sign. On rank 0."""
    if sign.remedy in OTHERS:
        return OTHERS[sign.remedy]
    limits, interface = limits_of(built.model), built.scene.interface
    stable = limits is None or limits.of_network <= 1.0
    if sign.remedy == "contact" and stable:
        deepest = built.model.particles.look().deepest
        stiffer = math.ceil((max(deepest, 0.5) / WANTED_OVERLAP) ** 2)
        return (
            f"make the contact about {stiffer} times as stiff, so that grains overlap by {WANTED_OVERLAP:g} of a "
            f"radius, with a time.step {math.sqrt(stiffer):.2g} times shorter"
        )
    said = f"take time.step = {smaller_step(built, limits, sign.largest_step):.6g} s"
    if not stable:
        said += f" (the limit of the present contacts is {limits.network.step:.3g} s)"
    if interface is None or sign.remedy not in ("exchange", "structure"):
        return said
    if interface.exchange == "lagged":
        said = f'take interface.exchange = "predicted", as "lagged" takes k dt from every dashpot, or {said}'
    if built.stiffness_ratio > stable_ratio(built.scene):
        said += f" (r = {built.stiffness_ratio:.3g} of the coupling should be below {stable_ratio(built.scene):.4g})"
        if interface.substeps > 1:
            said += ", or fewer interface.substeps"
    if interface.exchange == "iterated" and sign.remedy == "exchange":
        said += ", or allow more interface.iterations"
    return said
