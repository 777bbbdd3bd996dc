"""The page of the long run, and its picture."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from textwrap import fill

import matplotlib

matplotlib.use("Agg")  # no screen is needed

import matplotlib.pyplot as plt
import numpy as np
from long_numbers import Floats, LongRun
from long_run import AT, CHECKPOINTS, FRAMES, LAST, PERIOD, PERIODS, ROWS, RUN, SETTLING, STEP, sizes
from matplotlib.axes import Axes

MEGABYTE = 1e6
FILES = ("history.csv", "frames", "grains.xdmf", "checkpoint.h5", "log.txt")
PAGE = """# Ten million steps

Written by `make validate`.

The scene `shaken_walls` (2501 grains, Gamma = {gamma}) at the source's step, {step}, through `leito run`: {settling}
steps of settling and {periods} periods of {period} steps, {last} in all. A second process looks at it from outside,
every 15 s.

## Memory

Resident memory of the process is {begun:.1f} MB at a tenth of the way and {ended:.1f} MB at the end, {highest:.1f} MB
at most; a line through its second half rises by {slope:.1f} kB in a million steps.

## Drift

| periods | 1 to 100 | 101 to 200 | 201 to 300 | 301 to 400 |
|---|---|---|---|---|
{drifts}

The first five are the largest magnitudes there, of rows at every quarter of a period. Exact is the closed form with
the fractions that the binary numbers of step, period and start are; where the floor turns, a shift in time moves it
by the square of that: the lower points of the picture. The ledger's error is that of the integrator. The others are
means over twice a period, as the bed answers in twice its period, with their 95 % interval: they change with the bed,
in which the intruder rises. Contact lists are made anew {lists_first:.0f} times in a period until 99 % of the way,
{lists_last:.0f} times since.

## Files

| file | asked for | at the end | size | in a million steps |
|---|---|---|---|---|
{files}

## Stopped at 99 %

The folder was copied while the run went on, when the checkpoint of step {at} was there: the checkpoint first, then
the rest. `leito run --resume` has taken the copy to the end, in {resumed:.1f} MB at most. History, frames and last
state: {same}. (A process that has to compile the kernels
first holds more memory than one that finds them compiled.)

## Speed

{speed}

![long_run.png](long_run.png)
"""


def write(folder: Path, same: bool) -> LongRun:
    """Draw, and write the page; nothing in it is typed by hand."""
    run = LongRun()
    draw(run, folder / "long_run.png")
    (folder / "long_run.md").write_text(PAGE.format(**_plain(run), drifts=_drifts(run), files=_files(run), same=(
        "the same bits as of the run that was never stopped" if same else "**not the same** as of the run itself"
    )))  # fmt: skip
    return run


def _plain(run: LongRun) -> dict[str, str | float]:
    samples = run.samples
    lists = run.lists()
    return {
        "gamma": run.gamma, "step": STEP, "settling": SETTLING, "periods": PERIODS, "period": PERIOD, "last": LAST,
        "begun": run.begun / MEGABYTE, "ended": samples["resident"][-1] / MEGABYTE, "at": AT, "speed": _speed(run),
        "highest": samples["highest"].max() / MEGABYTE, "slope": round(run.memory_slope * 1e3, 1) + 0.0,
        "resumed": run.resumed["highest"].max() / MEGABYTE, "lists_first": lists[0], "lists_last": lists[1],
    }  # fmt: skip


def _drifts(run: LongRun) -> str:
    """Lines of the table of drifts."""
    largest = {
        "ledger, error over the energy turned over": run.history["ledger_relative_error"],
        "momentum, sum of forces over that of magnitudes": run.history["momentum_residual"],
        "floor, from exact arithmetic": run.floor_error,
        "round-off of the time, times the largest velocity of the floor": run.round_off,
        "floor at the ends of periods, from its lowest point": np.where(run.ends, run.history["floor_y"], 0.0),
    }
    hundreds = range(PERIODS // 100)
    lines = [
        (name, *(f"{np.abs(values[run.rows(hundred)]).max():.1e}" for hundred in hundreds))
        for name, values in largest.items()
    ]
    means = {
        "work of floor and walls in a period": run.work,
        "contacts": partial(run.mean, "contacts"),
        "height of the intruder": partial(run.mean, "intruder_y"),
    }
    for name, of in means.items():
        found = [of(hundred) for hundred in hundreds]
        lines.append((name, *(f"{one.mean:.1f} +- {one.half_width:.1f}" for one in found)))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _files(run: LongRun) -> str:
    """Lines of the table of files."""
    asked = {
        "history.csv": (f"a row in {ROWS} steps: {LAST // ROWS + 1}", f"{len(run.steps)} rows"),
        "frames": (f"one in {FRAMES}: {LAST // FRAMES + 1} and the last", f"{sizes(RUN)['frame_count']} frames"),
        "grains.xdmf": ("their index", ""),
        "checkpoint.h5": (f"one in {CHECKPOINTS}, the last is kept", "one"),
        "log.txt": ("", ""),
    }
    held, lines = sizes(RUN), []
    for name in FILES:
        rise = np.polyfit(run.samples["step"], run.samples[name], 1)[0]
        cells = (name, *asked[name], f"{held[name] / 1e3:.1f} kB", f"{rise * 1e3:+.1f} kB")
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _speed(run: LongRun) -> str:
    """As measured, with what else the machine did."""
    rows, summary = run.samples, run.summary
    grains, cpu, wall = summary["free_grains"], summary["cpu_seconds"], summary["stepping_seconds"]
    done = LAST * grains / 1e6
    return fill(
        f"{done / cpu:.1f} million steps of a grain in a second of the processor, {cpu / 60:.0f} minutes of it, on one "
        f"thread. The machine was {'loaded' if wall > 1.1 * cpu else 'otherwise quiet'}: the steps took "
        f"{wall / 60:.0f} minutes, {done / wall:.1f} millions in a second, under a mean load of "
        f"{rows['load'].mean():.1f} on two cores, this run included.",
        width=118,
    )


def draw(run: LongRun, path: Path) -> None:
    """Memory, residuals, phase and files against the millions of steps."""
    figure, ((memory, residual), (phase, files)) = plt.subplots(2, 2, figsize=(11.0, 7.0), layout="constrained")
    samples, millions, rows = run.samples, run.samples["step"] / 1e6, run.steps / 1e6
    memory.plot(millions, samples["resident"] / MEGABYTE, color="#1f5a94", label="resident")
    memory.plot(millions, samples["anonymous"] / MEGABYTE, color="#e09f3e", label="of it in no file")
    again = run.resumed
    memory.plot(again["step"] / 1e6, again["resident"] / MEGABYTE, "o", ms=4, color="#c1440e", label="resumed at 99 %")
    memory.set_ylim(0.0, None)
    memory.set_title("memory of the process [MB]")
    _residuals(run, residual, rows)
    after = run.steps > SETTLING
    phase.semilogy(
        rows[after], np.abs(run.floor_error[after]), ".", ms=2, color="#1f5a94", label="floor, from the closed form"
    )
    phase.semilogy(
        rows[after], run.round_off[after], color="#c1440e", lw=1.0, label="its largest velocity, eps of the time"
    )
    phase.set_title("drift of the phase [diameters]")
    for name, colour in zip(FILES[:-1], ("#1f5a94", "#e09f3e", "#2a9d8f", "#c1440e"), strict=True):
        files.semilogy(millions, np.where(samples[name] > 0, samples[name], np.nan) / 1e3, color=colour, label=name)
    files.set_title("files [kB]")
    for axes in (memory, residual, phase, files):
        axes.set_xlabel("steps [millions]")
        axes.grid(alpha=0.25)
        axes.legend(fontsize=8, loc="lower left" if axes is memory else "best")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _residuals(run: LongRun, axes: Axes, rows: Floats) -> None:
    error, momentum = run.history["ledger_relative_error"], run.history["momentum_residual"]
    axes.semilogy(rows[1:], np.abs(error[1:]), color="#1f5a94", label="energy ledger, over the energy turned over")
    shown = momentum > 0.0
    axes.semilogy(rows[shown], momentum[shown], ".", ms=2, color="#e09f3e", label="momentum")
    axes.set_title("residuals [-]")
