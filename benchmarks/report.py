"""The goals, the table and the file of results."""

import json
import os
import platform
from collections.abc import Iterable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

from rich.console import Console
from rich.table import Table

Rate = dict[str, object]

QUIET = 0.7  # load average above which times are not to be trusted
LOAD_BEFORE = os.getloadavg()[0]
RESULTS = Path(__file__).parent / "results" / "latest.json"


class Goal(NamedTuple):
    """What is asked: `least` says whether the value should be at least or at most the goal."""

    unit: str
    goal: float
    aim: float
    least: bool = False


GOALS = {
    "ratio_lammps_granular": Goal("1", 6.0, 10.0, True),
    "ratio_lammps_hooke_history": Goal("1", 3.0, 5.0, True),
    "speedup_2_threads_15k": Goal("1", 1.8, 1.95, True),
    "speedup_2_threads_100k": Goal("1", 1.8, 1.95, True),
    "cost_1e6_over_1e3": Goal("1", 1.5, 1.2),
    "normal_only_over_full": Goal("1", 0.5, 0.35),
    "ledger_overhead": Goal("1", 0.15, 0.05),
    "size_ratio_20_over_1": Goal("1", 1.5, 1.2),
    "falling_over_settled": Goal("1", 1.0, 0.6),
    "bytes_per_disc": Goal("B", 600.0, 300.0),
    "second_start_seconds": Goal("s", 2.0, 1.0),
    "microseconds_per_step_25_discs": Goal("us", 3.0, 1.0),
    "structure_overhead": Goal("1", 0.1, 0.0),
    "coupled_share_1_thread": Goal("1", 0.1, 0.05),
    "coupled_share_2_threads": Goal("1", 0.1, 0.05),
}

FURTHER = {
    "rebuild_share_settled": "%",
    "rebuild_share_falling": "%",
    "rebuild_share_sheared": "%",
    "rebuild_share_shaken": "%",
    "first_start_seconds": "s",
    "peak_memory_1e6_discs": "MiB",
    "facets_over_glued": "1",
    "coupled_share_facets": "1",
    "coupled_grains_us": "us",
    "coupled_structure_us": "us",
    "coupled_exchange_us": "us",
    "ratio_liggghts": "1",
    "ratio_lammps_granular_2_ranks": "1",
    "ratio_lammps_hooke_history_2_ranks": "1",
    "ratio_lammps_granular_1k": "1",
    "ratio_lammps_hooke_history_1k": "1",
    "ratio_liggghts_1k": "1",
    "ratio_lammps_granular_105k": "1",
    "ratio_lammps_hooke_history_105k": "1",
    "ratio_liggghts_105k": "1",
    "search_list_beats_brute_from": "discs",
    "search_cells_beat_list_from": "discs",
    "structure_ledger": "1",
    "absent_features": "1",
    "structure_overhead_1e6": "1",
    "structure_strong_100k": "1",
    "structure_strong_1e6": "1",
    "structure_weak_50k": "1",
}  # a row without a value is left out


def machine() -> dict[str, object]:
    """What the numbers were taken on."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    model = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.processor())
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return {
        "processor": model, "cores": len(os.sched_getaffinity(0)), "memory_gib": round(memory / 2**30, 1),
        "system": f"{platform.system()} {platform.machine()}", "load_average": LOAD_BEFORE,
    }  # fmt: skip


def versions() -> dict[str, str]:
    return {"python": platform.python_version()} | {name: version(name) for name in ("leito", "numpy", "numba")}


def entry(name: str, value: float | None) -> dict[str, object]:
    """One row of the goals with its value."""
    goal = GOALS[name]
    met = None if value is None else (value >= goal.goal if goal.least else value <= goal.goal)
    return {
        "value": value, "unit": goal.unit, "goal": goal.goal, "aim": goal.aim,
        "sense": "at least" if goal.least else "at most", "met": met,
    }  # fmt: skip


def _joined(before: Iterable[Rate], now: Iterable[Rate], *key: str) -> list[Rate]:
    """Rates of one file: a run measured now takes the place of the run before that has the same `key`."""
    return list({tuple(rate[name] for name in key): rate for rate in [*before, *now]}.values())


def joined_peers(now: Mapping[str, Any]) -> dict[str, object]:
    """What the file holds of other codes, with the runs of now in place of the same runs before."""
    before = read().get("peers", {}) if RESULTS.exists() else {}
    return {
        "versions": before.get("versions", {}) | now["versions"],
        "runs": _joined(before.get("runs", []), now["runs"], "code", "discs", "cores"),
    }


def joined_structure(now: Iterable[Rate]) -> list[Rate]:
    """Steps of the structure in the file, with those of now in place of the same before."""
    before = read().get("structure", []) if RESULTS.exists() else []
    return sorted(_joined(before, now, "unknowns", "ranks"), key=lambda row: (row["unknowns"], row["ranks"]))


def write(
    values: Mapping[str, float | None], rates: Iterable[Rate] = (), *, anew: bool = False, **more: object
) -> None:
    """Write all rows in the order of the goals; what was not measured now keeps its last value.

    `anew` forgets the rates of runs before: for a run of all groups.
    """
    before = read() if RESULTS.exists() else {}
    content: dict[str, object] = {
        name: entry(name, values.get(name, before.get(name, {}).get("value"))) for name in GOALS
    }
    last = {name: row["value"] for name, row in before.get("further", {}).items()} | dict(values)
    content["further"] = {
        name: {"value": last[name], "unit": unit} for name, unit in FURTHER.items() if last.get(name) is not None
    }
    content["rates"] = _joined([] if anew else before.get("rates", []), rates, "what", "discs", "threads")
    content |= {name: before[name] for name in before if name not in content}
    content |= more | {"machine": machine(), "versions": versions()}
    RESULTS.parent.mkdir(exist_ok=True)
    RESULTS.write_text(json.dumps(content, indent=2) + "\n")


def read() -> dict[str, Any]:
    """What the file holds."""
    content: dict[str, Any] = json.loads(RESULTS.read_text())
    return content


def _shown(value: float | None) -> str:
    return "not measured" if value is None else f"{value:.3g}"


def show() -> None:
    """Print what the file holds."""
    content = read()
    table = Table(title="{processor}, {cores} cores".format(**content["machine"]))
    for column, side in (("what", "left"), ("value", "right"), ("unit", "left"), ("goal", "right"), ("aim", "right")):
        table.add_column(column, justify=side)  # type: ignore[arg-type]
    for name in GOALS:
        row = content[name]
        colour = {True: "green", False: "red", None: "dim"}[row["met"]]
        value = f"[{colour}]{_shown(row['value'])}[/]"
        table.add_row(name, value, row["unit"], f"{row['sense']} {row['goal']:g}", f"{row['aim']:g}")
    for name, row in content.get("further", {}).items():
        table.add_row(name, _shown(row["value"]), row["unit"], "", "")
    for rate in content.get("rates", []):
        name = f"{rate['what']}, {rate['discs']} discs, {rate['threads']} thread{'s' * (rate['threads'] > 1)}"
        table.add_row(name, f"{rate['particle_steps_per_second']:.3g}", "1/s", "", "")
    for rate in content.get("peers", {}).get("runs", []):
        name = (
            f"{rate['code']} beside the others, {rate['discs']} discs, {rate['cores']} core{'s' * (rate['cores'] > 1)}"
        )
        table.add_row(name, f"{rate['particle_steps_per_second']:.3g}", "1/s", "", "")
    for row in content.get("features", []):
        beside = f" beside {row['beside']}" if row["beside"] else ""
        told = f"{row['added']:+.2f}, {row['low']:+.2f} to {row['high']:+.2f}; {row['percent']:+.0f} %"
        table.add_row(f"{row['feature']}{beside}, of a grain's step", told, "ns", "", "")
    for row in content.get("structure", []):
        name = f"step of {row['unknowns']} unknowns, {row['ranks']} rank{'s' * (row['ranks'] > 1)}; over the bare one, and without ledger"
        more, lean = (row[key] / row["bare_step_seconds"] - 1.0 for key in ("step_seconds", "lean_step_seconds"))
        told = f"{1e6 * row['step_seconds']:.3g}; {100.0 * more:+.0f} %, {100.0 * lean:+.0f} %"
        table.add_row(name, told, "us", "", "")
    console = Console(width=110)
    console.print(table)
    if (load := content["machine"]["load_average"]) > QUIET:
        console.print(f"[red]load average {load:.2g} before the runs: others were at work, take these times again[/]")
