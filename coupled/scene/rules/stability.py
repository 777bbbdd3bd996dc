"""The rules of the time step: a number not above the true limit of a single contact, or left to the model."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from coupled.scene.refusal import refusal

if TYPE_CHECKING:
    from coupled.scene.scene import Scene


def check_step(scene: Scene) -> None:
    """Refuse a step above ``2/omega`` of the smallest grain on one spring.

    Normal: ``omega^2 = k_n/m``. Tangential, a disc free to spin: ``omega^2 = k_t (1/m + r^2/I)
    = 3 k_t/m``. Rolling: ``omega^2 = k_r/I`` with ``I = m r^2/2``. These are necessary bounds: a
    grain with several contacts needs a smaller step, and so the source recommends a quarter,
    ``0.5 sqrt(m_min/k_n)`` (G 2.1.2). Without free grains there is no such limit. The stiffness
    of a recipe is known only once it is evaluated, so such a scene is checked when it is built.
    """
    grains, contact = scene.first_grains, scene.contact
    _check_auto(scene)
    _check_global_damping(scene)
    if grains is None or contact is None or contact.normal_stiffness is None:
        return
    mass = min([grains.smallest_mass, *(intruder.mass for intruder in scene.intruders)])
    radius = min([grains.smallest_radius, *(intruder.radius for intruder in scene.intruders)])
    limits = {"2 sqrt(m_min/k_n)": 2 * math.sqrt(mass / contact.normal_stiffness)}
    if contact.tangential_stiffness is not None:
        limits["2 sqrt(m_min/(3 k_t))"] = 2 * math.sqrt(mass / (3 * contact.tangential_stiffness))
    if contact.rolling_stiffness is not None:
        inertia = mass * radius**2 / 2
        limits["2 sqrt(I_min/k_r)"] = 2 * math.sqrt(inertia / contact.rolling_stiffness)
    formula, limit = min(limits.items(), key=lambda item: item[1])
    if scene.time.least_step > limit:
        raise refusal(
            "time.step",
            scene.time.step,
            f"is above the stability limit {formula} = {limit:.3g} s of the smallest grain on one "
            f"contact; choose at most {limit / 4:.3g} s",
        )


def _check_global_damping(scene: Scene) -> None:
    """``v += -alpha dt v`` must not turn velocities about."""
    if scene.damping is None:
        return
    for name in ("translational", "rotational"):
        value = getattr(scene.damping, name)
        if value * scene.time.least_step >= 1.0:
            raise refusal(
                f"damping.{name}",
                value,
                f"takes more than all of a velocity within time.step = {scene.time.step:g} s; choose less than "
                f"{0.1 / scene.time.step:.3g} 1/s, or a smaller step",
            )


def _check_auto(scene: Scene) -> None:
    time = scene.time
    if time.step == "auto" and scene.first_grains is None:
        raise refusal("time.step", "auto", "needs free grains, whose contacts set the limit; give a number in s")
    if time.step != "auto" and time.safety is not None:
        raise refusal("time.safety", time.safety, 'belongs to time.step = "auto"; remove it, or let the step be that')
    if time.step_fraction is not None and time.step != "auto":
        raise refusal(
            "time.step_fraction",
            time.step_fraction,
            'belongs to time.step = "auto"; remove it, or let the step be that; time.refinement divides a given step',
        )
    if time.step_fraction is not None and time.safety is not None:
        raise refusal("time.safety", time.safety, "is given together with time.step_fraction; keep one")
    if time.refinement is not None and time.step == "auto":
        raise refusal(
            "time.refinement", time.refinement, 'divides a given step; with step = "auto" give time.step_fraction'
        )
