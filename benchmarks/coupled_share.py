"""What exchange and structure cost beside the grains: the tube of G 4.2.1, one structural step per grain step."""

import os
import statistics
from collections.abc import Mapping, Sequence

import beds

from coupled.build import build
from coupled.model import Model
from coupled.scene import load_scene

PRESSED = ["structure.loads.0.schedule.over=0.1"]  # five times as fast as the scene
INTO = 2500  # steps, to the full load
PARTS = ("grains", "structure", "exchange")


def pressed(saved: beds.State, threads: int, options: Sequence[str] = ()) -> Model:
    """The tube, pressed into a settled bed."""
    model = build(load_scene("elastic_tube", [*PRESSED, *options]), bed=saved, threads=threads).model
    model.advance(INTO)
    return model


def shares(model: Model, steps: int, rounds: int) -> dict[str, float]:
    """Seconds per step of each part: medians over rounds of `steps`."""
    taken: dict[str, list[float]] = {name: [] for name in PARTS}
    for _ in range(rounds):
        before = dict(model.seconds)
        model.advance(steps)
        for name in PARTS:
            taken[name].append((model.seconds[name] - before[name]) / steps)
    return {name: statistics.median(values) for name, values in taken.items()}


def share(cost: Mapping[str, float]) -> float:
    """Exchange and structure over the grains."""
    return (cost["exchange"] + cost["structure"]) / cost["grains"]


def coupled() -> dict[str, float]:
    """Shares with one thread and two, with facets in place of glued grains, and microseconds of each part."""
    saved = beds.reference()
    alone = shares(pressed(saved, 1), 300, 7)
    numbers = {"coupled_share_1_thread": share(alone)} | {f"coupled_{name}_us": 1e6 * alone[name] for name in PARTS}
    if len(os.sched_getaffinity(0)) > 1:
        numbers["coupled_share_2_threads"] = share(shares(pressed(saved, 2), 300, 7))
    facets = pressed(saved, 1, ["interface.kind=facets"])
    return numbers | {"coupled_share_facets": share(shares(facets, 300, 7))}
