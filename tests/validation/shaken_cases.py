"""The cases of the source's shaken box, their samples, and the height of the intruder in each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import cumulative_trapezoid

from coupled.campaign.folders import is_done
from coupled.ensemble.ensemble import run_ensemble
from coupled.ensemble.samples import Sample, samples_of
from coupled.measuring.record import Floats, Record
from coupled.measuring.rises import height_over_floor

RUNS = Path(__file__).parents[2] / "runs" / "validation" / "shaken"
GAMMAS = ("0.9", "1.1", "1.3")
ALL_GAMMAS = (*GAMMAS, "1.5")  # the source speaks of the strongest shaking where walls are rough
LIGHT, HEAVY = "intruders.0.density=0.1061033", "intruders.0.density=0.9549297"  # a third and three times 1/pi
LONGER = (  # 200 periods and a frame in ten of them, too
    "shaking.period=4.743416", "time.duration=978.68", "quantities.1.start=741.51", "output.frames_per_second=0.02108185",
)  # fmt: skip
LONG_CASE = "no_friction_long"
LONG = ("time.duration=3982.847", "output.frames_per_second=0.0")  # 1000 periods
MOST = 50  # seeds looked for
WINDOW = 10  # periods over which a height is averaged


@dataclass(frozen=True, kw_only=True)
class Case:
    """A scene with overrides, shaken at each of `gammas`; `name` is its folder."""

    name: str
    title: str
    scene: str
    overrides: tuple[str, ...] = ()
    gammas: tuple[str, ...] = GAMMAS


CASES = (
    Case(name="walls", title="rough walls", scene="shaken_walls", gammas=ALL_GAMMAS),
    Case(
        name="walls_light",
        title="rough walls, light intruder",
        scene="shaken_walls",
        overrides=(LIGHT,),
        gammas=ALL_GAMMAS,
    ),
    Case(
        name="walls_heavy",
        title="rough walls, heavy intruder",
        scene="shaken_walls",
        overrides=(HEAVY,),
        gammas=ALL_GAMMAS,
    ),
    Case(name="smooth_walls", title="smooth walls", scene="shaken_smooth_walls"),
    Case(name="no_friction", title="no friction", scene="shaken_no_friction"),
    Case(
        name=LONG_CASE,
        title="no friction, 1000 periods",
        scene="shaken_no_friction",
        overrides=LONG,
        gammas=ALL_GAMMAS,
    ),
    Case(name="periodic_25000", title="periodic, 25 000 steps", scene="shaken_periodic"),
    Case(name="periodic_30000", title="periodic, 30 000 steps", scene="shaken_periodic", overrides=LONGER),
)


@dataclass(frozen=True, kw_only=True)
class Ascent:
    """The intruder of one sample.

    Attributes
    ----------
    record : Record
    seed : int
    periods : (k,)
        Middles of windows of two periods since the shaking began: the bed may answer the shaking in twice its period.
    height : (k,)
        Mean height of the centre over the moving floor in each.
    swing : float
        Mean change of height from one period to the next, at one phase of the shaking, in the last fifty.
    surface : float
        Highest grain where the shaking begins.
    """

    record: Record
    seed: int
    periods: Floats
    height: Floats
    swing: float
    surface: float

    def near(self, period: float) -> float:
        """Mean height over the `WINDOW` periods before one."""
        chosen = (self.periods > period - WINDOW) & (self.periods < period)
        return float(self.height[chosen].mean())

    def climbed(self, period: float) -> float:
        """Height there over that of the first `WINDOW` periods."""
        return self.near(period) - self.near(WINDOW)

    def mean_rise(self, until: float) -> float:
        """Mean height up to a period over that of the first `WINDOW` periods."""
        return float(self.height[self.periods <= until].mean()) - self.near(WINDOW)


def ascent_of(record: Record, seed: int) -> Ascent:
    """Means over two periods by the integral of the height between exact times."""
    shaken, time = record.shaken, record.history["time"]
    height = height_over_floor(record, "intruder")
    rows = record.history["time"][-1] - np.median(np.diff(time)) * 0.5  # a run ends at a whole step near its duration
    periods = 2 * round((rows - shaken.start) / (2.0 * shaken.period))
    edges = np.minimum(shaken.start + shaken.period * np.arange(0, periods + 1, 2), time[-1])
    sums = np.interp(edges, time, cumulative_trapezoid(height, time, initial=0.0))
    at_phase = np.interp(shaken.start + shaken.period * np.arange(max(0, periods - 50), periods), time, height)
    return Ascent(
        record=record,
        seed=seed,
        periods=np.arange(1.0, periods, 2.0),
        height=np.diff(sums) / np.diff(edges),
        swing=float(np.abs(np.diff(at_phase)).mean()),
        surface=float(np.interp(shaken.start, time, record.history["highest_grain"])),
    )


def asked(case: Case, count: int) -> list[Sample]:
    """The first `count` samples of each Gamma, and all others whose runs are finished."""
    vary = [f"shaking.gamma={','.join(case.gammas)}"]
    folder = RUNS / case.name
    held = [int(place.parent.name.removeprefix("seed_")) for place in folder.glob("*/seed_*/summary.json")]
    most = min(max([count, *held]), MOST)
    if most == 0:
        return []
    found = samples_of(case.scene, most, vary=vary, overrides=case.overrides, out=folder, shared=folder)
    return [sample for sample in found if sample.seed <= count or is_done(sample.task)]


def made(case: Case, count: int) -> dict[str, list[Ascent]]:
    """Make what is missing, and return the intruder's paths by Gamma."""
    samples = asked(case, count)
    if not samples:
        return {}
    results, _ = run_ensemble(samples, out=RUNS / case.name, resume=True, progress=False)
    failed = [(result.sample.task.name, result.outcome.message) for result in results if result.outcome.message]
    assert not failed, failed
    paths: dict[str, list[Ascent]] = {}
    for sample in sorted(samples, key=lambda sample: sample.seed):
        ((_, gamma),) = sample.combination.values
        paths.setdefault(gamma, []).append(ascent_of(Record(sample.task.folder), sample.seed))
    return paths


def paired(left: Sequence[Ascent], right: Sequence[Ascent]) -> list[tuple[Ascent, Ascent]]:
    """Samples of one seed: their grains lie alike at first."""
    others = {path.seed: path for path in right}
    return [(path, others[path.seed]) for path in left if path.seed in others]
