"""Axes of the grains' time step."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from grain_scenes import MASS, RADIUS, discs
from trials import Axis, Finished, Measured, Trial

from coupled.output import checkpoint
from coupled.output.folder import SCENE
from coupled.running.restep import COUNTERS
from coupled.running.run import run_scene
from coupled.scene import Scene, dump_scene

STIFFNESS = 1e6
OVERLAP = 0.01 * RADIUS  # of all contacts of the row
STEPS = 5000
ROUND_OFF = 1e-6  # of the largest displacement: places are some 1e9 round-offs of it


def pressed_row(share: float) -> Trial:
    """Three discs pressed between two fixed ones; the middle one is pushed."""
    matrix = STIFFNESS / MASS * (2 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1))
    omega2, modes = np.linalg.eigh(matrix)
    step = share * 2.0 / np.sqrt(omega2[-1])
    speed = 1e-4 * OVERLAP / step
    pitch = 2 * RADIUS - OVERLAP
    x = pitch * np.array([1.0, 2.0, 3.0])
    places = [[place, 0.0, speed if k == 1 else 0.0, 0.0] for k, place in enumerate(x)]
    ends = [{"start": [end, 0.0], "end": [end, 0.0], "count": 1, "radius": RADIUS} for end in (0.0, 4 * pitch)]
    contact = {"normal_stiffness": STIFFNESS}
    scene = discs(places, contact=contact, step=step, duration=STEPS * step, rows=ends)

    def check(run: Finished) -> list[Measured]:
        turn = np.arccos(1.0 - 0.5 * omega2 * step**2)  # of each mode in a step of the leapfrog
        moved = modes @ (modes[1] * speed * step * np.sin(STEPS * turn) / np.sin(turn))
        largest = speed * step / np.abs(np.sin(turn)).min()
        off = np.abs(run.grains("x") - x - moved).max()
        return [
            Measured(
                what="displacement off its closed form, of the largest",
                value=off / largest,
                expected=0.0,
                allowed=ROUND_OFF,
            )
        ]

    return Trial(scene=scene, check=check)


STEP, GRAVITY = 1e-4, 9.81


def falling(steps: float, *, output: dict[str, float] | None = None) -> dict[str, Any]:
    """A disc that falls freely for a number of steps, which need not be whole."""
    contact = {"normal_stiffness": STIFFNESS}
    scene = discs([0.0, 0.0, 0.0, 0.0], contact=contact, step=STEP, duration=steps * STEP, gravity=[0.0, -GRAVITY])
    return scene if output is None else scene | {"output": output}


def fallen(steps: int) -> float:
    """Height [m] of the leapfrog after whole steps."""
    return -0.5 * GRAVITY * (steps * STEP) ** 2


def height_is(run: Finished, expected: float) -> Measured:
    value = float(run.grains("y")[0])
    return Measured(what="height [m]", value=value, expected=expected, allowed=1e-12 * abs(expected))


def lasting(steps: float) -> Trial:
    """A duration in steps."""
    return Trial(scene=falling(steps), check=lambda run: [height_is(run, fallen(round(steps)))])


def written(name: str, of: Callable[[Finished], int]) -> Callable[[float], Trial]:
    """Trials of an output key whose interval is given in steps; `of` counts what was written."""

    def trial(interval: float) -> Trial:
        steps = 40
        given = 1.0 / (interval * STEP) if name == "frames_per_second" else interval * STEP
        scene = falling(steps, output={"history_interval": steps * STEP} | {name: given})

        def check(run: Finished) -> list[Measured]:
            whole = max(1, round(min(interval, steps)))
            expected = 1 + -(-steps // whole)
            return [
                Measured(what=f"number written for {name}", value=of(run), expected=expected, allowed=0.0),
                height_is(run, fallen(steps)),
            ]

        return Trial(scene=scene, check=check)

    return trial


def taken_up(done: int) -> Trial:
    """A run of so many steps is taken up for 1000 more, a row every 100."""
    first, more, rows = 10, 1000, 100
    scene = falling(done + more, output={"history_interval": rows * STEP, "checkpoint_interval": more * STEP})

    def prepare(out: Path) -> None:
        begun = Scene.model_validate({"title": "begun"} | falling(first) | {"output": {"figures": False}})
        run_scene(begun, out=out, threads=1, progress=False)
        state, title = checkpoint.load(out / checkpoint.NAME)
        for name in COUNTERS:
            if name in state:
                state[name].ravel()[0] = done
        for path in out.iterdir():
            if path.is_file():
                path.unlink()
        checkpoint.save(out / checkpoint.NAME, state, scene=title)
        (out / SCENE).write_text(dump_scene(begun))

    def check(run: Finished) -> list[Measured]:
        times = run.history["time"] / STEP
        between = float(np.diff(times).min())
        return [
            height_is(run, fallen(first + more)),
            Measured(
                what="steps between rows", value=between, expected=rows, allowed=1e-9 + 4 * np.spacing(float(done))
            ),
            Measured(what="steps at the last row", value=float(times[-1]) - done, expected=more, allowed=0.5),
        ]

    return Trial(scene=scene, check=check, prepare=prepare, arguments=("--resume",))


INTERVALS = (1e-300, 0.1, 0.4, 1.0, 1.4, 3.0, 40.0, 41.0, 1e9, 1e300)
AXES = (
    Axis(
        part="Grains",
        name="Time step over the sharp limit",
        text="Three discs pressed between two fixed ones, the middle one pushed by 1e-4 of the overlap in a step, 5000 "
        "steps. Right: places against the leapfrog's own solution of the three modes.",
        values=(0.01, 0.1, 0.3, 0.7, 0.9, 0.99, 0.999, 1.001, 1.01, 1.1, 1.3, 1.8, 2.0, 3.0),
        trial=pressed_row,
        quick={0.01: "right", 0.99: "right", 1.01: "stopped", 3.0: "refused"},
        sharpen=1.02,
    ),
    Axis(
        part="Grains",
        name="Duration in steps",
        text="A disc falls freely. Right: its height after the nearest whole number of steps.",
        values=(-1.0, 0.0, 1e-9, 0.4, 0.6, 1.0, 1.4, 2.7, 1e3, 1e5),
        trial=lasting,
        quick={0.0: "refused", 0.6: "refused", 1.0: "right", 2.7: "right"},
    ),
    Axis(
        part="Grains",
        name="Interval of rows in steps",
        text="A disc falls freely for 40 steps. Right: its height, and the number of rows.",
        values=INTERVALS,
        trial=written("history_interval", lambda run: len(run.history["time"])),
        quick={0.1: "refused", 1e9: "right"},
    ),
    Axis(
        part="Grains",
        name="Interval of frames in steps",
        text="The same. Right: its height, and the number of frames.",
        values=INTERVALS,
        trial=written("frames_per_second", lambda run: len(list((run.folder / "frames").glob("grains.*.h5")))),
        quick={0.1: "refused", 1.0: "right", 1e9: "right"},
    ),
    Axis(
        part="Grains",
        name="Steps done before",
        text="A falling disc is taken up at that step for 1000 more. Right: its height, and the times of its rows.",
        values=(1000, 10**6, 10**9, 10**12, 10**14, 10**15, 10**17, 10**18),
        trial=taken_up,
        quick={10**9: "right"},
        show=lambda value: f"{value:.0e}",
    ),
)
