"""Impossible parameters are refused in one sentence that says which, what, and what is allowed."""

from collections.abc import Callable

import numpy as np
import pytest

from particles import (
    ContactModel,
    CoulombFriction,
    ElasticPlasticRolling,
    GlobalDamping,
    Grains,
    LinearSpringDashpot,
    ParticleError,
    ParticleSystem,
    Wall,
    box,
    lattice,
)
from particles.contact import recipe
from particles.timestep import require_stable

NAN = float("nan")
NORMAL = LinearSpringDashpot(stiffness=1e5)
MODEL = ContactModel(normal=NORMAL)


def disc() -> Grains:
    return Grains.discs([[0.0, 0.0]], 1e-3, 1600.0)


def coinciding() -> None:
    grains = Grains.discs([[0.0, 0.0], [0.1, 0.1], [0.1, 0.1]], 1e-3, 1600.0)
    ParticleSystem(grains, MODEL, time_step=1e-6, ledger=False).start()


BAD: dict[str, tuple[Callable[[], object], str]] = {
    "stiffness zero": (lambda: LinearSpringDashpot(stiffness=0.0), "normal stiffness = 0 must be greater than 0"),
    "stiffness nan": (lambda: LinearSpringDashpot(stiffness=NAN), "normal stiffness = nan must be a finite number"),
    "dashpot": (lambda: LinearSpringDashpot(stiffness=1.0, damping=-1.0), "normal damping = -1 must be at least 0"),
    "tangential": (lambda: CoulombFriction(stiffness=-2.0, friction=0.1), "tangential stiffness = -2 must be greater"),
    "friction": (lambda: CoulombFriction(stiffness=1.0, friction=-0.1), "friction = -0.1 must be at least 0"),
    "rolling": (lambda: ElasticPlasticRolling(friction=-0.1), "rolling friction = -0.1 must be at least 0"),
    "rolling stiffness": (
        lambda: ElasticPlasticRolling(friction=0.1, stiffness=0.0), "rolling stiffness = 0 must be greater than 0"),
    "global damping": (lambda: GlobalDamping(rotational=-1.0), "rotational damping = -1 must be at least 0"),
    "rolling alone": (
        lambda: ContactModel(normal=NORMAL, rolling=ElasticPlasticRolling(friction=0.1)),
        "rolling resistance needs friction"),
    "radius": (lambda: Grains.discs([[0, 0], [1, 1]], [1.0, -1.0], 1.0), "radius of grain 1 = -1 must be positive"),
    "position": (lambda: Grains.discs([[0, NAN]], 1.0, 1.0), "y of grain 0 is not a finite number"),
    "density": (lambda: Grains.discs([[0, 0]], 1.0, 0.0), "grain mass = 0 must be greater than 0"),
    "time step": (lambda: ParticleSystem(disc(), MODEL, time_step=0.0), "time step = 0 must be greater than 0"),
    "no grain": (
        lambda: ParticleSystem(Grains.discs(np.zeros((0, 2)), 1.0, 1.0), MODEL, time_step=1e-6),
        "needs at least one grain"),
    "threads": (lambda: ParticleSystem(disc(), MODEL, time_step=1e-6, threads=0), "threads = 0 must be at least 1"),
    "coinciding": (coinciding, "grains 1 and 2 have the same centre: move one of them"),
    "step too large": (lambda: require_stable(disc(), MODEL, 1.0), "time step 1 s is above the limit .* take at most"),
    "step too large for dashpots": (
        lambda: require_stable(
            Grains.discs([[0, 0], [3, 0]], 1.0, 1.0),
            ContactModel(normal=LinearSpringDashpot(stiffness=1.0, damping=10.0)), 0.5),
        "time step 0.5 s is above m_eff/c_n = 0.15708 s, in which the normal dashpot .* take at most 0.015708 s"),
    "wall normal": (lambda: Wall(point=(0.0, 0.0), normal=(0.0, 0.0)), "wall normal must not be zero"),
    "wall point": (lambda: Wall(point=(NAN, 0.0), normal=(0.0, 1.0)), "wall point = nan must be a finite number"),
    "box": (lambda: box(-1.0, 1.0), "box width = -1 must be greater than 0"),
    "box side": (lambda: box(1.0, 1.0, ["top"]), "box side 'top' must be one of left, right, floor, lid"),
    "lattice too wide": (lambda: lattice([(1.0, 3)], 1.0, width=1.0), "does not fit in a box 1 m wide"),
    "lattice spacing": (
        lambda: lattice([(0.1, 3)], 1.0, width=1.0, spacing=0.5), "lattice spacing = 0.5 must be at least 1"),
    "jitter": (lambda: lattice([(0.1, 3)], 1.0, width=1.0, jitter=2.0), "jitter = 2 must lie between 0 and 1"),
    "restitution": (
        lambda: recipe.damping_from_restitution(restitution=1.5, effective_mass=1.0, stiffness=1.0, may_pull=False),
        "restitution = 1.5 must lie between 1e-12 and 1"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_refused_in_one_sentence(name: str) -> None:
    make, sentence = BAD[name]
    with pytest.raises(ParticleError, match=sentence) as refusal:
        make()
    assert "\n" not in str(refusal.value)


def test_run_that_leaves_the_finite_numbers_is_stopped() -> None:
    grains = Grains.discs([[0.0, 0.0], [1.9e-3, 0.0]], 1e-3, 1600.0)
    system = ParticleSystem(grains, ContactModel(normal=LinearSpringDashpot(stiffness=1e5)), time_step=1e-6)
    system.advance(2)
    system.grains.vx[0] = NAN
    with pytest.raises(ParticleError, match="left the finite numbers: the run is unstable"):
        system.advance(10)
