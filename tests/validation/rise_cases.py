"""Small shaken boxes in which many rises of an intruder are counted, and what is measured of them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coupled.campaign.statistics import Interval, confidence
from coupled.ensemble.ensemble import run_ensemble
from coupled.ensemble.samples import samples_of
from coupled.measuring.record import Floats, Record
from coupled.measuring.rises import LargeDeviations, Periods, Rise, rise_of
from coupled.measuring.samples import Group
from particles.measures import RateFunction, Resampling, WindowMoments, rate_function, usual_edges

RUNS = Path(__file__).parents[2] / "runs" / "validation" / "rises"
PERIOD, START = 3.952847, 30.0
RADIUS = 2.5
SMALL = (  # three intruders wide
    "grains.sizes.0.count=400", "box.width=15.0", "box.height=60.0", "quantities=absent",
    "output.frames_per_second=0.0", "output.figures=false",
)  # fmt: skip
QUARTERS = 4  # of a stage


@dataclass(frozen=True, kw_only=True)
class Case:
    """A scene with overrides, run for `length` periods; `name` is its folder.

    The stage is the periods `first` to `last`, the same in every sample: whether a window counts does not depend on
    where the intruder is.
    """

    name: str
    title: str
    scene: str
    overrides: tuple[str, ...]
    samples: int
    length: int
    first: int
    last: int

    @property
    def stage(self) -> Periods:
        """Its periods, at the quietest phase."""
        return Periods(first=self.first, last=self.last, phase=None)


CASES = (
    Case(
        name="walls", title="rough walls, Gamma = 1.5", scene="shaken_walls", samples=120, length=60, first=10, last=42,
        overrides=("shaking.gamma=1.5", "intruders.0.y=9.0"),
    ),
    Case(
        name="periodic", title="periodic sides, Gamma = 1.3", scene="shaken_periodic", samples=48, length=220, first=20,
        last=116, overrides=("shaking.gamma=1.3",),
    ),
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Measured:
    """A case, its records, the rise in its stage and in all periods, and that at phase 0 in the stage."""

    case: Case
    records: tuple[Record, ...]
    stage: Rise
    whole: Rise
    at_zero: Rise

    @property
    def found(self) -> LargeDeviations:
        """Of the stage."""
        return self.stage.deviations

    @property
    def rises(self) -> Floats:
        """Of the stage, (samples, periods)."""
        return np.array([sample.rise for sample in self.stage.samples])

    def curves(self) -> dict[int, RateFunction]:
        """Histograms by length, in bins of a third of the deviation of windows of that length."""
        lengths = self.found.lengths
        sampling = Resampling(sequences=tuple(self.rises), longest=lengths[-1], whole=True)
        return {n: rate_function(sampling, n, usual_edges(sampling, n)) for n in lengths}

    @property
    def surface(self) -> float:
        """Mean height of the highest grain where the shaking begins."""
        tops = [np.interp(START, record.history["time"], record.history["highest_grain"]) for record in self.records]
        return float(np.mean(tops))

    @property
    def at_top(self) -> int:
        """Samples whose intruder has its upper edge within its radius of that in the stage."""
        return sum(float(sample.value.max()) > self.surface - 2.0 * RADIUS for sample in self.stage.samples)

    def quarters(self) -> list[Interval]:
        """Mean rise per period in each quarter of the stage, over the samples."""
        return [confidence(part.mean(axis=1)) for part in np.array_split(self.rises, QUARTERS, axis=1)]

    def turn(self) -> Interval:
        """Mean rise per period in the second half of the stage less that in the first, sample by sample."""
        early, late = np.array_split(self.rises, 2, axis=1)
        return confidence(late.mean(axis=1) - early.mean(axis=1))

    def between(self) -> tuple[float, float]:
        """Variance of the rise of a whole stage between the samples, per period, and half width.

        Independent samples alone: what the windows must come to if they are long enough.
        """
        total = self.rises.sum(axis=1)
        value = float(total.var(ddof=1)) / self.rises.shape[1]
        excess = float(np.mean((total - total.mean()) ** 4) / total.var() ** 2) - 3.0
        return value, 1.96 * value * float(np.sqrt(max(2.0 + excess, 0.5) / len(total)))

    def feedback(self, n: int = 4) -> tuple[float, float]:
        """Change of the rise per period with the height at which a window of n begins, and half width.

        A line through all windows side by side; whole samples make its interval.
        """
        heights = np.array([sample.value for sample in self.stage.samples])[:, ::n]
        rise, start = np.diff(heights, axis=1) / n, heights[:, :-1] - heights[:, :-1].mean()
        spread = float((start**2).sum())
        slope = float((start * rise).sum()) / spread
        left = rise - rise.mean() - slope * start
        return slope, 1.96 * float(np.sqrt(((start * left).sum(axis=1) ** 2).sum())) / spread


def grown(feedback: float, n: int) -> float:
    """Variance per period of a walk over n periods, over that of a single one, whose drift changes with its place.

    ``dz = (v + b z) dt + s dW``: ``(exp(2 b n) - 1)/(2 b n)``, b = `feedback`.
    """
    return float(np.expm1(2.0 * feedback * n) / (2.0 * feedback * n))


def measured(case: Case) -> Measured:
    """Make the samples that are missing, and measure all."""
    samples = samples_of(
        case.scene, case.samples, out=RUNS / case.name, shared=RUNS / case.name,
        # the last look may be late in its period
        overrides=[*SMALL, f"time.duration={START + (case.length + 0.95) * PERIOD:.6g}", *case.overrides],
    )  # fmt: skip
    results, _ = run_ensemble(samples, out=RUNS / case.name, resume=True, progress=False)
    failed = [(result.sample.task.name, result.outcome.message) for result in results if result.outcome.message]
    assert not failed, failed
    group = Group(case.title, tuple(Record(sample.task.folder) for sample in samples))
    stage = rise_of(group, "intruder", case.stage)
    all_of_it = Periods(first=case.first, last=case.length, phase=stage.phase)
    return Measured(
        case=case,
        records=group.records,
        stage=stage,
        whole=rise_of(group, "intruder", all_of_it),
        at_zero=rise_of(group, "intruder", Periods(first=case.first, last=case.last)),
    )


def beyond(curve: RateFunction, moments: WindowMoments) -> tuple[int, int]:
    """Bins whose bars do not reach the Gaussian of the same mean and variance, and bins with bars."""
    known = np.isfinite(curve.rate) & (curve.half_width > 0.0)
    gap = np.abs(curve.rate - moments.gaussian_rate(curve.v))[known]
    return int((gap > curve.half_width[known]).sum()), int(known.sum())
