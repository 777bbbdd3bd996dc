"""The states that are measured: settled beds, copies of them side by side, falling grains, a heap.

The reference is a bed of 15 000 discs of radius 2.2, 2.0 and 1.8 mm in a box 1.2 m wide. Beds of
other sizes are as deep: the small one is narrower, the large ones are copies of the reference side
by side, springs included, with the walls between them taken out, settled a little more.
Settled states are kept in runs/bench under a name that changes with the code of the particles.
"""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import particles
from particles import (
    ContactModel,
    CoulombFriction,
    ElasticPlasticRolling,
    GlobalDamping,
    Grains,
    LinearSpringDashpot,
    ParticleSystem,
    Wall,
    box,
    continued,
    lattice,
    source_bound,
)
from particles.beds import rest_ratio

State = Mapping[str, np.ndarray]

ROOT = Path(__file__).parents[1]
CACHE = ROOT / "runs" / "bench"
DENSITY, GRAVITY = 1600.0, (0.0, -9.81)
WIDTH, HEIGHT = 1.2, 10.0
SIZES = ((2.2e-3, 3750), (2.0e-3, 7500), (1.8e-3, 3750))
TIME_STEP = 1e-5
SETTLING_FACTOR = 0.88  # of the bound of the source
REST = 1e-7  # mean kinetic energy over m g d

DRAG = GlobalDamping(translational=10.0, rotational=10.0)  # shortens the settling
NORMAL = LinearSpringDashpot(stiffness=1.98e6, damping=99.31)
FRICTION = CoulombFriction(stiffness=9.91e4, damping=15.90, friction=0.8)
ROLLING = ElasticPlasticRolling(friction=0.2)
FULL = ContactModel(normal=NORMAL, tangential=FRICTION, rolling=ROLLING)
WITHOUT_ROLLING = ContactModel(normal=NORMAL, tangential=FRICTION)
NORMAL_ALONE = ContactModel(normal=NORMAL)


def code_digest() -> str:
    """Changes with any source file of the particles."""
    digest = hashlib.sha256()
    for source in sorted(Path(particles.__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:12]


def cached(name: str, make: Any) -> State:
    """The state `name`, made at the first request."""
    CACHE.mkdir(parents=True, exist_ok=True)
    place = CACHE / f"{name}-{code_digest()}.npz"
    if not place.exists():
        for stale in CACHE.glob(f"{name}-*.npz"):
            stale.unlink()
        np.savez(place, **make())
    with np.load(place) as stored:
        return dict(stored)


def settle(system: ParticleSystem, longest: float) -> State:
    """Let grains come to rest, at most `longest` [s] of their time."""
    while system.time < longest:
        system.advance(500)
        if system.time > 0.3 and rest_ratio(system.grains, GRAVITY, system.energies()["kinetic"]) < REST:
            break
    return system.state()


def from_lattice(sizes: Sequence[tuple[float, int]], width: float, contact: ContactModel = FULL) -> State:
    """A bed of mixed sizes settled in a box."""
    grains = lattice(sizes, DENSITY, width=width, spacing=1.0, jitter=1.0)
    return settle(_settling(grains, width, contact), 1.0)


def _settling(grains: Grains, width: float, contact: ContactModel = FULL) -> ParticleSystem:
    return ParticleSystem(
        grains, contact, time_step=SETTLING_FACTOR * source_bound(grains, FULL), walls=box(width, HEIGHT),
        gravity=GRAVITY, damping=DRAG, ledger=False,
    )  # fmt: skip


def reference() -> State:
    """`settle15k`: 15 000 discs."""
    return cached("settle15k", lambda: from_lattice(SIZES, WIDTH))


def reference_without_rolling() -> State:
    """As many discs settled without rolling resistance: the reference would collapse without it."""
    return cached("settle15k_without_rolling", lambda: from_lattice(SIZES, WIDTH, WITHOUT_ROLLING))


def thousand() -> State:
    """1000 discs in a box of a fifteenth of the width."""
    return cached("settle1k", lambda: from_lattice([(r, count // 15) for r, count in SIZES], WIDTH / 15))


def thousand_without_rolling() -> State:
    """As many settled without rolling resistance."""
    sizes = [(r, count // 15) for r, count in SIZES]
    return cached("settle1k_without_rolling", lambda: from_lattice(sizes, WIDTH / 15, WITHOUT_ROLLING))


def equal() -> State:
    """8000 equal discs of radius 1 mm."""
    return cached("equal", lambda: from_lattice([(1e-3, 8000)], BIMODAL_WIDTH))


LARGE, SMALL, PITCH = 20e-3, 1e-3, 57e-3
BIMODAL_WIDTH = 5 * PITCH


def bimodal() -> State:
    """20 discs of radius 20 mm on a lattice, 8000 of 1 mm in the gaps: half the area in each size."""

    def make() -> State:
        column, row = np.meshgrid(np.arange(5), np.arange(4))
        large = PITCH * (np.column_stack([column.ravel(), row.ravel()]) + 0.5)
        fine = np.arange(SMALL, 4.2 * PITCH, 2.05 * SMALL)
        small = np.column_stack([axis.ravel() for axis in np.meshgrid(fine[fine < BIMODAL_WIDTH - SMALL], fine)])
        clear = np.hypot(*(small[:, None] - large[None]).T).min(axis=0) > LARGE + SMALL
        small = small[clear][:8000]
        radius = np.repeat([LARGE, SMALL], [len(large), len(small)])
        return settle(_settling(Grains.discs(np.vstack([large, small]), radius, DENSITY), BIMODAL_WIDTH), 1.0)

    return cached("bimodal20", make)


def side_by_side(saved: State, copies: int, contact: ContactModel = FULL) -> ParticleSystem:
    """A bed `copies` times as wide, its contacts with their springs, rested for a little while."""
    n = int(saved["grains.n_free"])
    wide = {name: np.tile(array, copies) for name, array in saved.items() if name.startswith("grains.") and array.ndim}
    which = np.repeat(np.arange(copies), n)
    wide["grains.x"] = wide["grains.x"] + WIDTH * which
    wide["grains.number"] = np.arange(n * copies)
    wide["grains.n_free"] = np.array(n * copies)
    slots = len(saved["pairs.partner"])
    for group, owner, offset in (("pairs", "partner", slots), ("walls", "grain", len(saved["walls.grain"]))):
        wide |= {key: saved[key] for key in saved if key.startswith(f"{group}.")}
        for name in (owner, "wall", "spring", "moment"):
            if f"{group}.{name}" in saved:
                wide[f"{group}.{name}"] = np.tile(saved[f"{group}.{name}"], copies)
        shift = n * np.repeat(np.arange(copies), offset)
        wide[f"{group}.{owner}"] = (wide[f"{group}.{owner}"] + shift).astype(np.int32)
    starts = saved["pairs.start"][:-1] + slots * np.arange(copies)[:, None]
    wide["pairs.start"] = np.append(starts.ravel(), slots * copies)
    resting = continued(
        wide, Grains.from_saved(wide), contact, time_step=TIME_STEP, walls=box(WIDTH * copies, HEIGHT), gravity=GRAVITY,
        damping=DRAG, ledger=False,
    )  # fmt: skip
    resting.advance(100)
    return resting


def system_of(
    saved: State,
    *,
    contact: ContactModel = FULL,
    width: float = WIDTH,
    walls: Sequence[Wall] | None = None,
    ledger: bool = False,
    threads: int = 1,
) -> ParticleSystem:
    """The settled state under the laws that are timed, at the reference step."""
    return continued(
        saved, Grains.from_saved(saved), contact, time_step=TIME_STEP, walls=walls or box(width, HEIGHT),
        gravity=GRAVITY, ledger=ledger, threads=threads,
    )  # fmt: skip


def falling(threads: int = 1) -> ParticleSystem:
    """15 000 discs, apart by a third of a diameter, on their way down at 1 m/s, 5 cm/s unlike."""
    grains = lattice(SIZES, DENSITY, width=WIDTH, spacing=1.3, jitter=1.0)
    grains.y += 0.3
    rng = np.random.default_rng(2)
    grains.vx[:] = 0.05 * rng.standard_normal(len(grains))
    grains.vy[:] = -1.0 + 0.05 * rng.standard_normal(len(grains))
    return ParticleSystem(
        grains, FULL, time_step=TIME_STEP, walls=box(WIDTH, HEIGHT), gravity=GRAVITY, ledger=False, threads=threads
    )


def twenty_five() -> ParticleSystem:
    """25 discs lying on a floor."""
    return system_of(cached("settle25", lambda: from_lattice([(2e-3, 25)], 0.04)), width=0.04)
