"""A settled bed for LIGGGHTS: a data file and the commands of an input script.

`hooke/stiffness` with absolute dashpots and no tension, `history` for friction and `epsd2` for
rolling are our law with the same coefficients: k_r = k_t R_r^2, no rolling dashpot. In two
dimensions its particles are discs: m = pi r^2 rho, I = m r^2 / 2. What differs is that its walls
are one fix each, and that the dashpot of friction is added below the limit without a second cut.
"""

from collections.abc import Mapping
from pathlib import Path

import beds
import lammps_deck
import numpy as np

LAW = "model hooke/stiffness tangential history rolling_friction epsd2"
SETTINGS = "tangential_damping on absolute_damping on limitForce on"


def write_data(saved: Mapping[str, np.ndarray], width: float, place: Path) -> None:
    """Discs of our density."""
    lammps_deck.write_atoms(saved, width, np.full(len(saved["grains.x"]), beds.DENSITY), place)


def commands(width: float, data: Path) -> list[str]:
    """The input script up to the first run."""
    normal, friction, rolling = beds.NORMAL, beds.FRICTION, beds.ROLLING
    coefficients = {
        "kn": normal.stiffness, "kt": friction.stiffness, "gamman_abs": normal.damping,
        "gammat_abs": friction.damping, "coefficientFriction": friction.friction,
        "coefficientRollingFriction": rolling.friction,
    }  # fmt: skip
    walls = {"left": "xplane 0.0", "right": f"xplane {width}", "floor": "yplane 0.0"}
    return [
        "units si", "dimension 2", "atom_style granular", "boundary f f p", "newton off",
        "communicate single vel yes", f"read_data {data}", f"neighbor {lammps_deck.SKIN} bin",
        "neigh_modify delay 0 every 1 check yes",
        *(f"fix {name} all property/global {name} peratomtypepair 1 {value}" for name, value in coefficients.items()),
        f"pair_style gran {LAW} {SETTINGS}", "pair_coeff * *", f"timestep {beds.TIME_STEP}",
        "fix move all nve/sphere", "fix plane all enforce2d",
        f"fix weight all gravity {-beds.GRAVITY[1]} vector 0 -1 0",
        *(f"fix {name} all wall/gran {LAW} primitive type 1 {plane} {SETTINGS}" for name, plane in walls.items()),
        "thermo 1000000",
    ]  # fmt: skip
