"""What a run came to: numbers by name, and the lines a user reads."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coupled.bodies import stable_ratio
from coupled.build import Built
from coupled.report.contact import contact_numbers
from coupled.report.preset import preset_sentences
from coupled.report.quantities import quantity_lines
from coupled.report.units import Shown
from coupled.running.observe import Observation
from coupled.scene import Scene
from coupled.step import limits_of


def summarise(
    built: Built,
    seen: Observation,
    first: dict[str, float],
    peaks: dict[str, float],
    seconds: dict[str, float],
    stepping: NDArray[np.float64],
) -> dict[str, Any]:
    """Numbers of `summary.json`.

    Parameters
    ----------
    built, seen
        The model and its last observation.
    first : dict
        Numbers of the first observation.
    peaks : dict
        Largest magnitudes over all observations.
    seconds : dict
        Wall time per part [s].
    stepping : array, shape (2,)
        Wall time and processor time of the steps and their output [s].
    """
    scene, model = built.scene, built.model
    summary = {
        "title": scene.title,
        "simulated_seconds": model.time,
        **_speed(built, peaks, seconds, stepping),
        **_step(built, peaks),
        **_balances(built, seen, peaks),
        **contact_numbers(scene),
    }
    if scene.preset is not None:
        summary["accuracy"] = scene.preset.model_dump()
    if model.structure is not None:
        summary |= _structure(scene, seen.numbers, first, peaks)
    return summary


def _speed(
    built: Built, peaks: dict[str, float], seconds: dict[str, float], stepping: NDArray[np.float64]
) -> dict[str, Any]:
    """What was done, and in which time."""
    model = built.model
    return {
        "steps": model.steps_done * model.substeps,
        "wall_seconds": sum(seconds.values()),
        "wall_seconds_by_part": seconds,
        "stepping_seconds": float(stepping[0]),
        "cpu_seconds": float(stepping[1]),
        "free_grains": model.particles.grains.n_free if model.particles is not None else 0,
        "particle_steps_per_second": peaks["particle_steps"] / seconds["grains"] if seconds.get("grains") else 0.0,
    }


def _step(built: Built, peaks: dict[str, float]) -> dict[str, Any]:
    """The step, and its shares of the limits."""
    limits = limits_of(built.model)
    return {
        "time_step": built.scene.time.step,
        "stable_dt_ratio": built.stable_dt_ratio,
        "packing_dt_ratio": limits.of_packing if limits is not None else 0.0,
        "network_dt_ratio": limits.of_network if limits is not None else 0.0,
        "stiffness_ratio_r": built.stiffness_ratio,
        "stable_ratio": stable_ratio(built.scene) if built.model.interface is not None else 0.0,
        "stiffness_ratio_max": peaks["stiffness_ratio"],
    }


def _balances(built: Built, seen: Observation, peaks: dict[str, float]) -> dict[str, Any]:
    """Energy and momentum, of the whole and across the interface."""
    model, numbers = built.model, seen.numbers
    residual = numbers.get("interface_residual", 0.0)
    balances = {
        "ledger_relative_error": numbers["ledger_relative_error"],
        "ledger_error": numbers["ledger_error"],
        "energy_turned_over": seen.balance.throughput,
        "interface_residual": residual,
        "interface_residual_share": model.exchanged.share_of_work(residual),
        "interface_work": model.exchanged.work,
        "moment_dropped": model.exchanged.moment_dropped,
        "moment_dropped_share": model.exchanged.share_dropped,
        "momentum_residual_max": peaks["momentum_residual"],
    }
    if model.iterated is not None:
        balances |= {
            "exchange_iterations": model.iterated.trials / max(1, model.steps_done),
            "exchange_unsettled": model.iterated.unsettled,
            "exchange_farthest": model.iterated.farthest,
        }
    return balances


def _structure(
    scene: Scene, numbers: dict[str, float], first: dict[str, float], peaks: dict[str, float]
) -> dict[str, Any]:
    return {
        "kind": scene.structure.kind,
        "applied_y": numbers["applied_y"],
        "reaction_y": numbers.get("reaction_y", 0.0),
        "reaction_y_max": peaks["reaction_y"],
        "centroid_y": numbers["centroid_y"],
        "centroid_drop": first["centroid_y"] - numbers["centroid_y"],
        "rotation": numbers["rotation"],
        "max_von_mises": peaks["max_von_mises"],
        "max_strain": peaks["max_strain"],
    }


# Told only where they are not zero; folders of earlier versions lack them.
ADDED = ("network_dt_ratio", "interface_work", "moment_dropped_share", "stiffness_ratio_max")


def tell(summary: dict[str, Any], pictures: list[Path], folder: Path, scene: Scene | None = None) -> str:
    """The lines printed at the end of a run, also of one that an earlier version made, and its quantities."""
    summary = dict.fromkeys(ADDED, 0.0) | summary
    shown = Shown(scene.units if scene is not None else "SI")
    simulated = f"{summary['simulated_seconds']:g}{shown.after('s')}"
    parts = ", ".join(f"{name} {seconds:.1f}" for name, seconds in summary["wall_seconds_by_part"].items() if seconds)
    lines = [
        f"{summary['title']}: {simulated} simulated in {summary['wall_seconds']:.1f} s",
        *_structure_lines(summary, shown),
        *_balance_lines(summary, shown),
        *_step_lines(summary),
    ]
    if scene is not None:
        lines += quantity_lines(scene.quantities, summary.get("quantities", {}), scene.units)
        lines += [f"  {sentence}" for sentence in preset_sentences(scene)]
    lines += [f"  wall time [s]            {parts}", f"  files in                 {folder}"]
    lines += [f"  picture                  {path}" for path in pictures]
    return "\n".join(lines)


def _structure_lines(summary: dict[str, Any], shown: Shown) -> list[str]:
    if "applied_y" not in summary:
        return []
    force = shown.after("N/m")
    drop, stress = shown.number(summary["centroid_drop"], "mm"), shown.number(summary["max_von_mises"], "MPa")
    what = "drive" if summary["kind"] == "rigid" else "applied load"
    return [
        f"  reaction of the grains   {summary['reaction_y']:12.2f}{force}   against "
        f"{summary['applied_y']:.2f}{force} of {what}; largest {summary['reaction_y_max']:.2f}{force}",
        f"  centroid drop            {drop:12.3f}{shown.after('mm')}    rotation {summary['rotation']:.4f} rad",
        f"  largest von Mises        {stress:12.4f}{shown.after('MPa')}   largest strain {summary['max_strain']:.3g}",
    ]


def _balance_lines(summary: dict[str, Any], shown: Shown) -> list[str]:
    energy = shown.after("J/m")
    lines = [
        f"  energy-ledger error      {summary['ledger_relative_error']:12.2e}       of "
        f"{summary['energy_turned_over']:.4g}{energy} turned over",
        f"  momentum residual        {summary['momentum_residual_max']:12.2e}       of the contact forces",
    ]
    if summary["interface_work"]:
        lines.append(
            f"  interface residual       {summary['interface_residual']:12.2e}{energy}   "
            f"{summary['interface_residual_share']:.2e} of {summary['interface_work']:.4g}{energy} exchanged"
        )
    if summary["moment_dropped_share"]:
        lines.append(
            f"  moment dropped           {summary['moment_dropped']:12.2e}{shown.after('N m s/m')}, "
            f"{summary['moment_dropped_share']:.2g} of that of the forces; interface.couple = true keeps it"
        )
    return lines


def _step_lines(summary: dict[str, Any]) -> list[str]:
    lines = []
    if summary["free_grains"]:
        network = summary["network_dt_ratio"]
        lines.append(
            f"  particle-steps per s     {summary['particle_steps_per_second']:12.3g}       time step "
            f"{100 * summary['stable_dt_ratio']:.0f} % of the source's bound"
            + (f", {100 * network:.0f} % of the limit of its contacts" if network > 0.0 else "")
        )
    if summary["stiffness_ratio_r"]:
        lines.append(
            f"  stiffness ratio r        {summary['stiffness_ratio_r']:12.3g}       stable up to "
            f"{summary['stable_ratio']:.4g} on fixed partners; of closed contacts at most "
            f"{summary['stiffness_ratio_max']:.3g}"
        )
    if "exchange_iterations" in summary:
        unsettled, farthest = summary["exchange_unsettled"], summary["exchange_farthest"]
        lines.append(
            f"  iterations per step      {summary['exchange_iterations']:12.3g}       of the exchange; {unsettled} "
            "steps not settled" + (f", by {farthest:.1g} of the motion at most" if unsettled else "")
        )
    return lines
