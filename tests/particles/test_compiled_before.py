"""All code that steps need is there before the first of them, so that the clock of a run does not see the compiler."""

from __future__ import annotations

import subprocess
import sys

import pytest

SCRIPT = """
import sys
from numba.core.dispatcher import Dispatcher
import particles.kernels as kernels
from particles import ContactModel, CoulombFriction, LinearSpringDashpot, ParticleSystem, box, lattice

def versions():
    found = {}
    for name, module in list(sys.modules.items()):
        if name.startswith(kernels.__name__):
            for value in vars(module).values():
                if isinstance(value, Dispatcher):
                    found[f"{value.__module__}.{value.__name__}"] = len(value.overloads)
    return found

law = ContactModel(
    normal=LinearSpringDashpot(stiffness=1e5, damping=5.0),
    tangential=CoulombFriction(stiffness=5e3, friction=0.5, damping=1.0),
)
grains = lattice([(4e-3, 30), (5e-3, 30)], density=1600.0, width=0.1, jitter=0.5)
options = {"walls": box(0.1, 0.5), "gravity": (0.0, -9.81), "precision": sys.argv[1], "scheme": sys.argv[2]}
system = ParticleSystem(grains, law, time_step=4e-5, **options)
system.advance(0)
system.energies()
before, lists = versions(), system.rebuilds
system.advance(4000)
system.energies()
assert system.rebuilds > lists, "no new list was made"
print(*sorted(name for name, count in versions().items() if count != before.get(name, 0)))
"""


@pytest.mark.parametrize(("precision", "scheme"), [("float32", "leapfrog"), ("float64", "velocity_verlet")])
def test_steps_and_new_lists_load_no_code(precision, scheme):
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, precision, scheme], capture_output=True, text=True, check=True, timeout=300
    )
    assert done.stdout.split() == []
