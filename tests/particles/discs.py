"""Systems used by several tests.

Every combination of features compiles anew, so the tests share two: the normal spring alone, and
the full law with global damping. A feature a test does not want has a zero coefficient there.
"""

from typing import Any

import numpy as np

from particles import (
    ContactModel,
    CoulombFriction,
    ElasticPlasticRolling,
    GlobalDamping,
    Grains,
    LinearSpringDashpot,
    ParticleSystem,
    Wall,
)

FLOOR = Wall(point=(0.0, 0.0), normal=(0.0, 1.0), name="floor")


def normal_only(
    grains: Grains, *, k_n: float, c_n: float = 0.0, may_pull: bool = False, **options: Any
) -> ParticleSystem:
    """Discs with the normal spring and dashpot alone: they do not turn."""
    return ParticleSystem(
        grains, ContactModel(normal=LinearSpringDashpot(stiffness=k_n, damping=c_n, may_pull=may_pull)), **options
    )


def full_law(
    grains: Grains,
    *,
    k_n: float,
    k_t: float,
    mu: float,
    c_n: float = 0.0,
    c_t: float = 0.0,
    mu_r: float = 0.0,
    eta_r: float = 0.0,
    k_r: float | None = None,
    alpha_t: float = 0.0,
    alpha_r: float = 0.0,
    **options: Any,
) -> ParticleSystem:
    """Discs with every law; those with a zero coefficient do nothing."""
    model = ContactModel(
        normal=LinearSpringDashpot(stiffness=k_n, damping=c_n),
        tangential=CoulombFriction(stiffness=k_t, damping=c_t, friction=mu),
        rolling=ElasticPlasticRolling(friction=mu_r, damping_ratio=eta_r, stiffness=k_r),
    )
    return ParticleSystem(grains, model, damping=GlobalDamping(translational=alpha_t, rotational=alpha_r), **options)


def resting_disc(
    *, radius: float, mass: float, gravity: float, k_n: float, vx: float = 0.0, spin: float = 0.0
) -> Grains:
    """One disc on the floor y = 0 with the overlap that carries its weight."""
    height = radius - mass * gravity / k_n
    return Grains.discs([[0.0, height]], radius, mass / (np.pi * radius**2), velocity=[[vx, 0.0]], spin=spin)


def by_number(system: ParticleSystem, *names: str) -> list[np.ndarray]:
    """State arrays in the order the grains had at the beginning."""
    order = np.argsort(system.grains.number)
    return [getattr(system.grains, name)[order] for name in names]


def packing(
    n: int, *, seed: int, ratio: float = 3.0, smallest: float = 1e-3, squeeze: float = 0.9, speed: float = 0.1
) -> tuple[Grains, float, float]:
    """Random overlapping discs on a jittered lattice; returns them with the width and height they fill.

    Radii lie between `smallest` and `ratio` times it, equal area in every class; `squeeze` < 1
    scales the lattice below the mean diameter, so that most neighbours overlap.
    """
    rng = np.random.default_rng(seed)
    radius = smallest * rng.uniform(ratio**-2.0, 1.0, n) ** -0.5
    pitch = squeeze * 2.0 * radius.mean()
    columns = int(np.sqrt(n))
    place = np.arange(n)
    position = pitch * (np.column_stack([place % columns, place // columns]) + 0.5)
    position += 0.2 * pitch * rng.uniform(-1.0, 1.0, (n, 2))
    velocity, spin = speed * rng.standard_normal((n, 2)), speed / smallest * rng.standard_normal(n)
    grains = Grains.discs(position, radius, 1600.0, velocity=velocity, spin=spin)
    return grains, pitch * columns, pitch * (n // columns)


def balance(system: ParticleSystem) -> float:
    """Stored energies and losses less works [J/m]; constant."""
    return sum(-value if name.startswith("work") else value for name, value in system.energies().items())


def losses(system: ParticleSystem) -> dict[str, float]:
    return {name[5:]: value for name, value in system.energies().items() if name.startswith("loss")}


def only(channel: str, system: ParticleSystem, *, share: float) -> float:
    """The loss of one channel, when the others together are below a share of it."""
    found = losses(system)
    loss = found.pop(channel)
    assert sum(abs(other) for other in found.values()) < share * loss
    return loss
