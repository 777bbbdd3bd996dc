"""What a user should know of a run before it starts and while it runs."""

from __future__ import annotations

import math
from collections.abc import Mapping

from coupled.build import WARNED_SHARE, Built, stable_ratio
from coupled.step import StepLimits, limits_of
from structure import departures


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
        limit = damping.overdamped_above
        hertz = limit / (2 * math.pi)
        said.append(f"Rayleigh's stiffness_factor over-damps every mode above {limit:.4g} rad/s ({hertz:.4g} Hz)")
    return said


def beyond_theory(built: Built, numbers: Mapping[str, float]) -> dict[str, str]:
    """Sentences, by quantity, on numbers of an observation that leave the theory in use."""
    structure = built.scene.structure
    if structure is None or structure.theory is None:
        return {}
    return departures(structure.theory, numbers)
