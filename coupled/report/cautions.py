"""What a user should know of a run before it starts and while it runs."""

from __future__ import annotations

import math
from collections.abc import Mapping

from coupled.bodies import stable_ratio
from coupled.build import WARNED_SHARE, Built
from coupled.laws import interface_spring
from coupled.loads import unresolved_schedules
from coupled.report.locking import locking
from coupled.scene import Scene
from coupled.step import StepLimits, limits_of
from structure import ElasticStructure, beyond_meaning, departures, unused_solver_options

ENOUGH_DAMPING = 0.1  # of critical: with it no sub-cycled exchange of the map grows below its limit
FEW_UNKNOWNS = 10_000  # up to here the lowest mode takes a fraction of a second


def before(built: Built, limits: StepLimits | None = None) -> list[str]:
    """Sentences on the time step, the coupling and the damping of a scene; `limits` are found if not given."""
    scene, said = built.scene, []
    limits = limits or limits_of(built.model)
    if limits is not None and limits.of_network > 1.0:
        said.append(
            f"time.step is {limits.of_network:.2f} times {limits.network.step:.3g} s, the limit of the present "
            'contacts: their fastest mode grows unless it opens them; take a smaller step, or "auto"'
        )
    elif built.stable_dt_ratio > 1.0:
        said.append(
            f"time.step is {built.stable_dt_ratio:.2f} times the source's bound 0.5 sqrt(m/k): watch the energy ledger"
        )
    if scene.interface is not None and built.stiffness_ratio > WARNED_SHARE * stable_ratio(scene):
        said.append(
            f"stiffness ratio r = {built.stiffness_ratio:.2f} of the coupling is close to or above "
            f"{stable_ratio(scene):.4g}, the limit on fixed partners: take a smaller time.step"
        )
    if scene.interface is not None and scene.interface.exchange == "lagged" and built.stiffness_ratio > 0.0:
        said.append(
            'interface.exchange = "lagged" takes k dt from every dashpot of the interface, which is unstable where '
            'that is more than it has; "predicted" does not'
        )
    damping = getattr(built.model.structure, "damping", None)  # an elastic structure alone may have it
    if damping is not None and damping.overdamped_above < math.inf:
        said.append(_overdamped(built.model.structure))
    if unused := unused_solver_options():
        said.append(f"no solver of this scene knows the PETSc option {', '.join(unused)}: look at its spelling")
    if scene.structure is not None:
        said += unresolved_schedules(scene.structure.loads, built.model.window)
        said += _braked(built) + _walls_alone(scene)
    return said + _resonance(built) + _never_shaken(scene) + locking(scene)


def _resonance(built: Built) -> list[str]:
    """A sentence on windows too long for light grains without dashpots; numbers from docs/validation/stability.md."""
    interface, system = built.scene.interface, built.model.particles
    if interface is None or interface.exchange == "iterated" or interface.substeps == 1 or not built.stiffness_ratio:
        return []
    if system is None or not system.grains.n_free:
        return []
    k, c = interface_spring(built.scene, built.contact, system.grains, built.model.interface.radius)
    mass = float(system.grains.mass[: system.grains.n_free].min())
    half_period, damping = math.pi * math.sqrt(mass / (2.0 * k)), c / math.sqrt(2.0 * k * mass)
    if built.model.window <= half_period or damping >= ENOUGH_DAMPING:
        return []
    return [
        f"interface.substeps = {interface.substeps} makes windows of {built.model.window:.3g} s, longer than half a "
        f"period of the lightest grain between two contacts ({half_period:.3g} s), and their damping is {damping:.2g} "
        f'of critical: below {ENOUGH_DAMPING:g} windows may feed such grains; take fewer, or exchange = "iterated"'
    ]


def _braked(built: Built) -> list[str]:
    """A sentence on Rayleigh's mass factor, where it stops every motion within a step."""
    table = built.scene.structure.rayleigh
    if table is None or table.mass_factor * built.model.window <= 2.0:
        return []
    return [
        f"structure.rayleigh.mass_factor = {table.mass_factor:g} 1/s brakes every motion, also that of the whole body, "
        f"within a step of {built.model.window:.3g} s: what moves then follows its loads at once"
    ]


def _walls_alone(scene: Scene) -> list[str]:
    """A sentence on walls that have no grain to hold."""
    if scene.grains is not None or scene.box is None or not scene.box.walls:
        return []
    return ["box.walls hold free grains, and there are none: the structure goes through them"]


def _never_shaken(scene: Scene) -> list[str]:
    """A sentence on walls that would shake after the end of the run."""
    if scene.shaking is None or scene.shaking.start < scene.time.duration:
        return []
    return [
        f"shaking.start = {scene.shaking.start:g} is not before the end of the run, time.duration = "
        f"{scene.time.duration:g}: nothing shakes"
    ]


def _overdamped(body: ElasticStructure) -> str:
    """A sentence on Rayleigh's stiffness factor, with the lowest mode where that is found at once."""
    limit = body.damping.overdamped_above
    hertz = limit / (2 * math.pi)
    said = f"Rayleigh's stiffness_factor over-damps every mode above {limit:.4g} rad/s ({hertz:.4g} Hz)"
    if 2 * len(body.mesh.points) > FEW_UNKNOWNS:
        return said
    lowest = float(body.frequencies(1)[0])
    if lowest > hertz:
        modes = f"all modes of this structure, whose lowest is at {lowest:.4g} Hz"
        return f"{said}: {modes}: it creeps back instead of swinging"
    return f"{said}; the lowest of this structure is at {lowest:.4g} Hz"


def beyond_theory(built: Built, numbers: Mapping[str, float]) -> dict[str, str]:
    """Sentences, by quantity, on numbers of an observation that leave the theory in use."""
    structure = built.scene.structure
    if structure is None or structure.theory is None:
        return {}
    return departures(structure.theory, numbers)


def beyond_meaning_of_theory(built: Built, numbers: Mapping[str, float]) -> str | None:
    """A sentence on an observation so far outside the theory in use that going on means nothing."""
    structure = built.scene.structure
    if structure is None or structure.theory is None:
        return None
    return beyond_meaning(structure.theory, numbers)


def beyond_exchange(built: Built, numbers: Mapping[str, float]) -> dict[str, str]:
    """A sentence, by quantity, where the closed contacts are stiffer than the exchange bears on fixed partners."""
    ratio = numbers.get("stiffness_ratio", 0.0)
    limit = stable_ratio(built.scene) if built.model.interface is not None else math.inf
    if ratio <= limit:
        return {}
    step = built.scene.time.step
    return {
        "stiffness_ratio": f"the contacts that are closed now have the stiffness ratio r = {ratio:.3g}, above "
        f"{limit:.4g}, the limit on fixed partners ({built.stiffness_ratio:.3g} was expected): watch the interface "
        f"residual, or take time.step = {step * limit / ratio:.2g} s"
    }
