"""What each feature costs: the reference bed with one feature at a time beside the same bed without it.

Every pair starts from the same moment, the settled bed, with a step so small that contacts neither open nor
leave their list: only the work differs. Times are those of the processor, which other processes hardly
touch. Runs take turns; a cost is the median over the rounds of the difference between two neighbours in
time, with its quartiles beside it. Where these enclose zero there is nothing to be seen.
"""

import dataclasses
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import beds
import interfaces
import numpy as np
from bare_grains import BareGrains

from particles import (
    ContactTable,
    ElasticPlasticRolling,
    GlobalDamping,
    Grains,
    HertzSpringDashpot,
    LinearSpringDashpot,
    MindlinFriction,
    ParticleSystem,
    Shaking,
    Wall,
    box,
    continued,
)
from particles.history import history_of

STEP = 1e-6  # [s]
STEPS, ROUNDS = 100, 15
FULL, ABSENT = "rolling resistance", "all features absent"

SPRING = dataclasses.replace(beds.NORMAL_ALONE, normal=LinearSpringDashpot(stiffness=beds.NORMAL.stiffness))
UNDAMPED = dataclasses.replace(beds.FRICTION, damping=0.0)
SLIDING = dataclasses.replace(beds.WITHOUT_ROLLING, tangential=UNDAMPED)
MEAN_OVERLAP = 2e-6  # [m], at which Hertz's spring is as stiff as the linear one
HERTZ = dataclasses.replace(
    beds.WITHOUT_ROLLING,
    normal=HertzSpringDashpot(stiffness=beds.NORMAL.stiffness / MEAN_OVERLAP**0.5, restitution=0.4),
)
MINDLIN = dataclasses.replace(HERTZ, tangential=MindlinFriction(stiffness_ratio=0.05, damping_ratio=0.1, friction=0.8))
DRAG = GlobalDamping(translational=0.1, rotational=0.1)
DASHPOT = dataclasses.replace(beds.FULL, rolling=ElasticPlasticRolling(friction=0.2, damping_ratio=0.1))


class Case(NamedTuple):
    """A feature and what it stands beside; `make` gives the bed with it."""

    name: str
    beside: str | None
    make: Callable[[], Any]


class Cost(NamedTuple):
    """Of one feature, in ns per grain and step: the whole, what the feature adds, its quartiles, its share [%]."""

    feature: str
    beside: str | None
    whole: float
    added: float
    low: float
    high: float
    percent: float
    bytes_per_contact: float | None = None


def system(contact: Any, **options: Any) -> ParticleSystem:
    """The settled bed under some laws and options."""
    saved = beds.reference()
    given = {"walls": box(beds.WIDTH, beds.HEIGHT), "gravity": beds.GRAVITY, "ledger": False, "time_step": STEP}
    return continued(saved, Grains.from_saved(saved), contact, **(given | options))


def cases() -> list[Case]:
    """All features of the grains alone, each beside what it is added to."""
    left, right, floor = box(beds.WIDTH, beds.HEIGHT)
    moving = [left, right, Wall(point=floor.point, normal=floor.normal, velocity=(0.0, 0.01), name="floor")]
    shaken, shaking = dataclasses.replace(floor, shaken=True), Shaking(amplitude=1e-6, period=0.1)
    table = ContactTable([[beds.FULL, beds.FULL], [beds.FULL, beds.FULL]])
    return [
        Case("normal spring alone", None, lambda: system(SPRING)),
        Case("normal dashpot", "normal spring alone", lambda: system(beds.NORMAL_ALONE)),
        Case("friction", "normal dashpot", lambda: system(SLIDING)),
        Case("tangential dashpot", "friction", lambda: system(beds.WITHOUT_ROLLING)),
        Case(FULL, "tangential dashpot", lambda: system(beds.FULL)),
        Case("rolling dashpot", FULL, lambda: system(DASHPOT)),
        Case("Hertz's spring", "tangential dashpot", lambda: system(HERTZ)),
        Case("Mindlin's friction", "Hertz's spring", lambda: system(MINDLIN)),
        Case("no walls", FULL, lambda: system(beds.FULL, walls=[])),
        Case("moving walls", FULL, lambda: system(beds.FULL, walls=moving)),
        Case("shaken floor", FULL, lambda: system(beds.FULL, walls=[left, right, shaken], shaking=shaking)),
        Case("periodic in x", "no walls", lambda: system(beds.FULL, walls=[], period=(beds.WIDTH, None))),
        Case("table of materials", FULL, lambda: system(table)),
        Case("velocity Verlet", FULL, lambda: system(beds.FULL, scheme="velocity_verlet")),
        Case("single precision", FULL, lambda: system(beds.FULL, precision="float32")),
        Case("ledger", FULL, lambda: system(beds.FULL, ledger=True)),
        Case("global damping", "ledger", lambda: system(beds.FULL, ledger=True, damping=DRAG)),
        Case("180 glued grains", FULL, lambda: _pressed("glued")),
        Case("30 facets", FULL, lambda: _pressed("facets")),
    ]


def _pressed(kind: str) -> ParticleSystem:
    return interfaces.pressed(beds.reference(), kind)


class Turn:
    """One bed that takes its turns, always from the same moment."""

    def __init__(self, made: ParticleSystem) -> None:
        self.made = made
        made.time_step = STEP
        made.advance(1)
        self._moment = made.snapshot()

    def __call__(self) -> float:
        """Time of one step of one grain [ns]."""
        self._moment.rewind()
        before, begin = self.made.rebuilds, time.thread_time()
        self.made.advance(STEPS)
        spent = time.thread_time() - begin
        if self.made.rebuilds != before:
            raise RuntimeError("a new contact list was made in a measured run: take a smaller step")
        return 1e9 * spent / (STEPS * self.made.grains.n_free)

    @property
    def bytes_per_contact(self) -> float:
        """What a listed pair remembers."""
        kept = sum(array.nbytes for array in history_of(self.made.list.pairs))
        return kept / len(self.made.list.pairs.partner)


def rounds_of(turns: dict[str, Callable[[], float]], rounds: int) -> dict[str, np.ndarray]:
    """Times of all, turn by turn, after one round unrecorded."""
    taken: dict[str, list[float]] = {name: [] for name in turns}
    for count in range(rounds + 1):
        for name, turn in turns.items():
            spent = turn()
            if count:
                taken[name].append(spent)
    return {name: np.array(values) for name, values in taken.items()}


def paired(name: str, beside: str | None, taken: dict[str, np.ndarray], memory: float | None = None) -> Cost:
    """The cost of a feature out of rounds in which it stood beside another run."""
    whole = float(np.median(taken[name]))
    if beside is None:
        return Cost(name, None, whole, whole, *np.quantile(taken[name], [0.25, 0.75]).tolist(), 0.0, memory)
    added = taken[name] - taken[beside]
    low, middle, high = np.quantile(added, [0.25, 0.5, 0.75]).tolist()
    return Cost(name, beside, whole, middle, low, high, 100.0 * middle / float(np.median(taken[beside])), memory)


def of_grains(rounds: int = ROUNDS, chosen: Sequence[Case] | None = None) -> list[Cost]:
    """Features of the grains."""
    chosen = cases() if chosen is None else chosen
    turns = {case.name: Turn(case.make()) for case in chosen}
    taken = rounds_of(turns, rounds)
    return [paired(case.name, case.beside, taken, turns[case.name].bytes_per_contact) for case in chosen]


def beside_bare(rounds: int = ROUNDS) -> Cost:
    """Grains with a normal law alone beside sixty lines in which nothing else can exist, to the same positions."""
    ours = Turn(system(beds.NORMAL_ALONE))
    bare = BareGrains(ours.made)

    def plain() -> float:
        nonlocal bare
        ours._moment.rewind()
        bare = BareGrains(ours.made)
        begin = time.thread_time()
        bare.advance(STEPS)
        return 1e9 * (time.thread_time() - begin) / (STEPS * len(bare.x))

    taken = rounds_of({"bare": plain, "ours": ours}, rounds)
    apart = max(np.abs(ours.made.grains.x - bare.x).max(), np.abs(ours.made.grains.y - bare.y).max())
    if apart > 1e-12 * beds.WIDTH:
        raise RuntimeError(f"both ways should lead to the same place, they end {apart:.2g} m apart")
    return paired("ours", "bare", taken)._replace(feature=ABSENT, beside="bare loop")


def costs(rounds: int = ROUNDS) -> list[Cost]:
    """All that this module measures."""
    return [*of_grains(rounds), beside_bare(rounds)]


def ratios(found: Iterable[Cost]) -> dict[str, float]:
    """What the goals ask of: the normal law alone over the full one, the ledger, and features that are absent."""
    of = {cost.feature: cost for cost in found}
    return {
        "normal_only_over_full": of["normal dashpot"].whole / of[FULL].whole,
        "ledger_overhead": of["ledger"].percent / 100.0,
        "absent_features": of[ABSENT].percent / 100.0,
    }
