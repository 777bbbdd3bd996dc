"""What a scene does not model is not in its compiled loop: no call, no root, no memory."""

import re

import numba
import numpy as np
import pytest

from particles import (
    ContactModel,
    CoulombFriction,
    ElasticPlasticRolling,
    Grains,
    LinearSpringDashpot,
    ParticleSystem,
)
from particles.history import history_of
from particles.kernels.forces import pair_forces

NORMAL = LinearSpringDashpot(stiffness=1e5, damping=1.0)
FRICTION = CoulombFriction(stiffness=5e3, friction=0.5)
ROLLING = ElasticPlasticRolling(friction=0.1)
LAWS = {
    "normal": ContactModel(normal=NORMAL),
    "friction": ContactModel(normal=NORMAL, tangential=FRICTION),
    "rolling": ContactModel(normal=NORMAL, tangential=FRICTION, rolling=ROLLING),
}


def system(law: ContactModel, *, ledger: bool = False) -> ParticleSystem:
    """Two discs that touch."""
    grains = Grains.discs([[0.0, 0.0], [3.9e-3, 0.0]], 2e-3, 1600.0)
    made = ParticleSystem(grains, law, time_step=1e-6, ledger=ledger)
    made._rebuild()
    return made


def compiled(law: ContactModel) -> str:
    """The loop over pairs as LLVM leaves it for a law."""
    made = system(law)
    arguments = (0, made._arrays(), made.list.pairs, law.numbers(), None, None, 1e-6)
    fresh = numba.njit(error_model="numpy")(pair_forces.py_func)
    fresh.compile(tuple(numba.typeof(argument) for argument in arguments))
    (code,) = fresh.inspect_llvm().values()
    return code


def calls(code: str, name: str) -> int:
    return len(re.findall(rf"call .*@{name}", code))


def test_a_normal_law_calls_nothing_and_takes_one_root() -> None:
    """One square root, for the distance. The time since a birth calls `hypot` where a spring remembers, and the
    distance of the step before is a second root where it is asked for."""
    code, rubbing = compiled(LAWS["normal"]), compiled(LAWS["friction"])
    assert calls(code, "hypot") == 0
    assert calls(code, "llvm.sqrt") == 1
    assert calls(rubbing, "hypot") > 0


@pytest.mark.parametrize(
    ("name", "ledger", "numbers"),
    [("normal", False, 0), ("friction", False, 1), ("rolling", False, 2), ("normal", True, 2), ("rolling", True, 4)],
)
def test_a_pair_remembers_what_its_laws_need(name: str, ledger: bool, numbers: int) -> None:
    """A force of friction, a moment of rolling; with a ledger two dashpots of the step before."""
    pairs = system(LAWS[name], ledger=ledger).list.pairs
    assert len(pairs.partner) == 1
    assert sum(len(array) for array in history_of(pairs)) == numbers


def test_without_friction_nothing_turns_and_no_torque_is_left() -> None:
    """Torques of a bed with friction are gone where a system without it takes over its grains: no step writes them."""
    grains = Grains.discs([[0.0, 0.0], [3.9e-3, 0.0]], 2e-3, 1600.0, spin=[3.0, -1.0])
    grains.torque[:] = 1.0
    made = ParticleSystem(grains, LAWS["normal"], time_step=1e-6)
    made.advance(100)
    assert np.array_equal(grains.torque, [0.0, 0.0])
    assert np.array_equal(grains.omega, [3.0, -1.0])
    assert made.energies()["rotational"] == 0.0
