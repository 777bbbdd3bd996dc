"""A settled bed for LAMMPS: a data file and the commands of an input script."""

from collections.abc import Mapping
from pathlib import Path

import beds
import numpy as np

SKIN = 3e-4  # of the lists of LAMMPS and LIGGGHTS [m]; a bed at rest never uses it up


def write_data(saved: Mapping[str, np.ndarray], width: float, place: Path) -> None:
    """Discs as LAMMPS spheres: it computes m = 4/3 pi r^3 rho, so rho is given as 3/(4 r) of ours."""
    radius = saved["grains.radius"]
    write_atoms(saved, width, beds.DENSITY * 3.0 / (4.0 * radius), place, "Atoms # sphere")


def write_atoms(
    saved: Mapping[str, np.ndarray], width: float, density: np.ndarray, place: Path, heading: str = "Atoms"
) -> None:
    """The format of both codes: number, type, diameter, density, x, y, z."""
    rows = [
        f"{i + 1} 1 {2.0 * r:.17g} {d:.17g} {x:.17g} {y:.17g} 0.0"
        for i, (x, y, r, d) in enumerate(
            zip(saved["grains.x"], saved["grains.y"], saved["grains.radius"], density, strict=True)
        )
    ]
    head = (
        f"settled bed\n\n{len(rows)} atoms\n1 atom types\n\n-0.01 {width + 0.01} xlo xhi\n"
        f"-0.01 0.6 ylo yhi\n-0.01 0.01 zlo zhi\n\n{heading}\n\n"
    )
    place.write_text(head + "\n".join(rows) + "\n")


def granular() -> tuple[str, str]:
    """`pair granular` with our law, rolling included; and the same between discs and walls.

    Its rolling spring works on the rolled length R_r theta, so that k_r = k_t R_r^2 is k_t there.
    """
    normal, friction, rolling = beds.NORMAL, beds.FRICTION, beds.ROLLING
    law = (
        f"hooke {normal.stiffness} {normal.damping} tangential linear_history {friction.stiffness} "
        f"{friction.damping / normal.damping} {friction.friction} "
        f"rolling sds {friction.stiffness} 0.0 {rolling.friction} damping velocity limit_damping"
    )
    return f"pair_style granular\npair_coeff * * {law}", f"granular {law}"


def hooke_history(mass: float) -> tuple[str, str]:
    """`gran/hooke/history`: no rolling; its dashpots are per effective mass, that of a mean pair."""
    normal, friction = beds.NORMAL, beds.FRICTION
    half = 0.5 * mass
    law = (
        f"{normal.stiffness} {friction.stiffness} {normal.damping / half} {friction.damping / half} "
        f"{friction.friction} 1 limit_damping"
    )
    return f"pair_style gran/hooke/history {law}\npair_coeff * *", f"hooke/history {law}"


def commands(style: tuple[str, str], width: float, data: Path) -> list[str]:
    """The input script up to the first run."""
    pair, wall = style
    return [
        "units si", "dimension 2", "atom_style sphere", "boundary f f p", "newton off",
        "comm_modify vel yes", f"neighbor {SKIN} bin", "neigh_modify delay 0 every 1 check yes",
        f"read_data {data}", *pair.split("\n"), f"timestep {beds.TIME_STEP}",
        "fix move all nve/sphere disc", "fix plane all enforce2d",
        f"fix weight all gravity {-beds.GRAVITY[1]} vector 0 -1 0",
        f"fix sides all wall/gran {wall} xplane 0.0 {width}",
        f"fix floor all wall/gran {wall} yplane 0.0 NULL",
        "thermo 1000000",
    ]  # fmt: skip
