"""`make validate`: the source's shaken boxes, M 4, in ensembles, and what they say beside the source's words.

Makes (or takes up) the ensembles in `runs/validation/shaken` and writes `docs/validation/shaken.md` with pictures. All
finished samples there are used; the environment variable SHAKEN_SAMPLES says how many of each case are made, 0 for
none.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from shaken_cases import CASES, GAMMAS, LONG_CASE, RUNS, Ascent, ascent_of, made
from shaken_pictures import draw, draw_rolls
from shaken_words import LONGEST, STILL, Found, Statement, at_top, fall_time, interval, risen_by_ten, statements

from coupled.campaign.statistics import Interval, confidence
from coupled.ensemble.ensemble import run_ensemble
from coupled.ensemble.samples import samples_of
from coupled.measuring.record import Record

DOCS = Path(__file__).parents[2] / "docs" / "validation"
SAMPLES = int(os.environ.get("SHAKEN_SAMPLES", "2"))  # 28 runs each, a minute of one core per run
STEP_SEEDS = 6
STEP_SCENE = (  # wide and high enough for the intruder, 30 periods
    "grains.sizes.0.count=400", "box.width=15.0", "box.height=60.0", "shaking.gamma=1.5", "time.duration=148.58541",
    "quantities.1.start=109.0", "output.frames_per_second=0.0", "output.figures=false",
)  # fmt: skip
STEPS = {"auto": "chosen", "6e-4": "about a quarter", "1.5811388e-4": "the source's"}
PAGE = """# The shaken boxes of Martins 2021, chapter 4

Written by `make validate`.

2500 discs of diameter 1 (+- 2.5 %) and one of diameter 5 that starts in the middle of the bed, gravity 1, for
200 periods, and 1000 without friction; the scenes `shaken_walls`, `shaken_smooth_walls`, `shaken_no_friction`,
`shaken_periodic`. Lengths are mean diameters. Values are means over samples, which differ in their seeds, with the
95 % interval of the mean by Student's t where there are several; (n) is the number of samples.

## Who rises, who sinks

Heights are means over two periods, because the bed may answer the shaking in twice its period: the swing is the
mean change of height from one period to the next, at one phase, over the last fifty. Rises are from the first
ten periods to those before the 100th and the 200th. The surface of the bed at rest is dashed; the intruder is
at the top where its upper edge comes within its radius of that.

| case | Gamma | rise in 100 periods | in 200 | risen by 10 after | at the top after | swing | seeds |
|---|---|---|---|---|---|---|---|
{rows}

{lacking}![shaken_heights.png](shaken_heights.png)
{pictures}

## Beside the source's words

A rise counts beyond the intruder's radius, 2.5, within 200 periods. A statement holds ("yes") or fails ("no")
where the whole 95 % interval does; otherwise it is open. With one sample the number itself decides, which is an
indication alone. Which of two cases rises faster is told by the mean height, over that of the first ten periods,
until the first of the two is at the top, for samples of one seed, whose grains lie alike at first.

| case | the source | here | value | agrees |
|---|---|---|---|---|
{words}

{verdict}

The source's public program, an older snapshot, differs from these scenes, which have the thesis' physics: one
dashpot for all contacts, attraction on separation, Coulomb's limit on the elastic part of the normal force
alone, walls without a velocity of their own in their contacts, a bed still bouncing when shaking starts, a lid.
Nothing has been tuned here.

{sinking}

## Convection

Grains in the middle over those at the sides, displacement per period in the same shaking, Gamma = {gamma}:
{rolls}.

{convection}

## Step

Ours is 0.8 of the limit of any packing, some 16 times the source's. Rise of the intruder among 400 grains in a
box 15 wide at Gamma = 1.5, from the first ten periods to the 20th to 30th, {seeds} seeds of each step:

| step | rise | less that of the chosen step |
|---|---|---|
{steps}

## Large deviations of the rise

Not from these ensembles: once the intruder is at the top its rises have another distribution, and there are too
few samples. [Many small boxes](rises.md) tell it for a stage of the rise, with its symmetry and what a Gaussian
leaves open.

## A film

`leito run brazil_nut && leito animate runs/brazil_nut`:

![A large grain rises through shaken ones](../pictures/brazil_nut.gif)
"""


def row(title: str, gamma: str, ascents: Sequence[Ascent]) -> str:
    """One line of the table."""

    def times(values: list[float | None]) -> str:
        known = [value for value in values if value is not None]
        mean = f"{confidence(known).mean:.0f}" if known else "-"
        return mean + (f" ({len(known)} of {len(values)})" if len(values) > 1 else "")

    cells = (
        title,
        gamma,
        interval([ascent.climbed(100.0) for ascent in ascents]),
        interval([ascent.climbed(200.0) for ascent in ascents]),
        times([risen_by_ten(ascent) for ascent in ascents]),
        times([at_top(ascent) for ascent in ascents]),
        f"{confidence([ascent.swing for ascent in ascents]).mean:.1f}",
        ", ".join(str(ascent.seed) for ascent in ascents),
    )
    return f"| {' | '.join(cells)} |"


def lacking_of(found: Found) -> str:
    """The cases of which no sample has been made yet."""
    lacks = [case.title for case in CASES if case.name not in found]
    return f"No sample has been made yet of: {'; '.join(lacks)}.\n\n" if lacks else ""


def verdict_of(told: Sequence[Statement]) -> str:
    """What agrees and what does not, in a sentence or two."""
    count = {word: [one for one in told if one.verdict == word] for word in ("yes", "no", "open")}
    text = (
        f"Of {len(told)} statements {len(count['yes'])} hold, {len(count['no'])} fail, {len(count['open'])} are open."
    )
    for one in count["no"]:
        text += f'\n\n**Differs**, {one.case.replace("_", " ")}: "{one.source}"; {one.what}: {interval(one.values)}.'
    return text


def sinking(found: Found) -> str:
    """How the intruder moves without friction."""
    told = []
    for gamma, ascents in found.get(LONG_CASE, {}).items():
        rises = [ascent.climbed(LONGEST) for ascent in ascents]
        down, up = sum(rise < -STILL for rise in rises), sum(rise > STILL for rise in rises)
        falls = [fall for ascent in ascents if (fall := fall_time(ascent)) is not None]
        exponential = (
            f" (in {len(falls)} the height over that at the bottom falls to 1/e in {confidence(falls).mean:.0f} "
            "periods, by a line through its logarithm)"
            if falls
            else ""
        )
        told.append(f"{gamma}: {down} of {len(rises)} down{exponential}, {up} up")
    if not told:
        return ""
    return f"Without friction, moved by more than the radius within 1000 periods, by Gamma: {'; '.join(told)}."


def rises_by_step() -> dict[str, list[float]]:
    """The rise of small samples with several steps, seed by seed."""
    samples = samples_of(
        "shaken_walls", STEP_SEEDS, vary=[f"time.step={','.join(STEPS)}"], overrides=STEP_SCENE, out=RUNS / "steps",
        shared=RUNS / "steps",
    )  # fmt: skip
    results, _ = run_ensemble(samples, out=RUNS / "steps", resume=True, progress=False)
    rises: dict[str, list[float]] = {}
    for result in results:
        ((_, step),) = result.sample.combination.values
        assert not result.outcome.message, result.outcome
        ascent = ascent_of(Record(result.sample.task.folder), result.sample.seed)
        rises.setdefault(step, []).append(ascent.climbed(30.0))
    return rises


def step_rows(rises: dict[str, list[float]]) -> list[str]:
    """Lines of their table."""
    rows = []
    for step, values in rises.items():
        apart = [value - chosen for value, chosen in zip(values, rises["auto"], strict=True)]
        written = f"{STEPS[step]}{'' if step == 'auto' else f', {step}'}"
        rows.append(f"| {written} | {told(confidence(values))} | {'' if step == 'auto' else told(confidence(apart))} |")
    return rows


def told(found: Interval) -> str:
    """With the digits of a small rise."""
    return f"{found.mean:+.2f} +- {found.half_width:.2f}"


def write(found: Found, steps: list[str]) -> list[Statement]:
    """Draw, and write the page; nothing in it is typed by hand but the source's own words."""
    DOCS.mkdir(exist_ok=True)
    pictures, (convection, rolls), held = draw(found, DOCS), draw_rolls(found, DOCS), statements(found)
    titles = {case.name: case.title for case in CASES}
    lines = [row(titles[name], gamma, ascents) for name, kinds in found.items() for gamma, ascents in kinds.items()]
    words = [
        f"| {titles[one.case]} | {one.source} | {one.what} | {interval(one.values)} | {one.verdict} |" for one in held
    ]
    page = PAGE.format(
        rows="\n".join(lines), lacking=lacking_of(found), words="\n".join(words), verdict=verdict_of(held),
        sinking=sinking(found),
        pictures="\n".join(f"![{name}]({name})" for name in pictures[1:]),
        gamma=GAMMAS[-1],
        rolls=", ".join(f"{titles[name]} {roll}" for name, roll in rolls.items()),
        convection="\n".join(f"![{name}]({name})" for name in convection), seeds=STEP_SEEDS, steps="\n".join(steps),
    )  # fmt: skip
    (DOCS / "shaken.md").write_text(page)
    return held


@pytest.mark.validate
def test_shaken_boxes_of_the_source() -> None:
    found: dict[str, dict[str, list[Ascent]]] = {}
    for count in range(min(1, SAMPLES), SAMPLES + 1):  # one sample of every case, then the next ones
        found = {case.name: ascents for case in CASES if (ascents := made(case, count))}
    rises = rises_by_step()
    held = write(found, step_rows(rises))
    assert held
    for step in list(STEPS)[1:]:
        apart = confidence([value - chosen for value, chosen in zip(rises[step], rises["auto"], strict=True)])
        assert apart.low < 0.0 < apart.high, (step, rises)
    for kinds in found.values():
        for ascents in kinds.values():
            for ascent in ascents:
                # the springs' energy is followed to the integrator's order; the source's own program has no ledger
                assert abs(ascent.record.history["ledger_relative_error"][-1]) < 0.01, ascent.record.folder
