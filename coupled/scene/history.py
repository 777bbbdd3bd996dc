"""Columns of history.csv: which ones a scene writes, and their units."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from coupled.scene.scene import Scene

ENERGY = "J/m"
UNITS = {
    "time": "s",
    "applied_x": "N/m",
    "applied_y": "N/m",
    "reaction_x": "N/m",
    "reaction_y": "N/m",
    "centroid_x": "m",
    "centroid_y": "m",
    "rotation": "rad",
    "max_von_mises": "Pa",
    "max_strain": "-",
    "local_rotation": "rad",
    "compression": "-",
    "contacts": "-",
    "coordination": "-",
    "deepest_overlap": "-",
    "fastest_grain": "m/s",
    "highest_grain": "m",
    "floor_x": "m",
    "floor_y": "m",
    "walls_x": "m",
    "walls_y": "m",
    "ledger_error": "J/m",
    "ledger_relative_error": "-",
    "interface_residual": "J/m",
    "interface_residual_window": "J/m",
    "interface_work": "J/m",
    "moment_dropped": "N m s/m",
    "moment_dropped_share": "-",
    "momentum_residual": "-",
    "stiffness_ratio": "-",
}
"""Units by column; the others are lines of the energy ledger, in `ENERGY`."""

_STRUCTURE = ("applied_x", "applied_y", "centroid_x", "centroid_y", "rotation", "max_von_mises", "max_strain")
_OF_THEORY = {"corotational": ("local_rotation",), "large_strain": ("compression",)}
_FREE_GRAINS = ("contacts", "coordination", "deepest_overlap", "fastest_grain", "highest_grain")
_INTERFACE = ("reaction_x", "reaction_y", "interface_residual", "interface_residual_window", "interface_work")
_GRAIN_ENERGIES = (
    "kinetic", "rotational", "gravity", "normal_springs", "tangential_springs", "rolling_springs",
    "loss_normal_dashpot", "loss_tangential_dashpot", "loss_sliding", "loss_rolling_dashpot", "loss_rolling_slip",
    "loss_global_damping",
)  # fmt: skip
_STRUCTURE_ENERGIES = ("structure_kinetic", "structure_strain", "structure_loss_rayleigh", "loads_work")


def unit_of(column: str, units: str = "SI") -> str:
    """Unit of a column of the history of a scene whose key `units` is given."""
    if units != "SI":
        return "-"
    if column.startswith("intruder_"):
        return "m/s" if column.endswith(("_vx", "_vy")) else "m"
    return UNITS.get(column, ENERGY)


def intruder_columns(index: int) -> tuple[str, ...]:
    """Place and velocity of an intruder, numbered from 0."""
    name = "intruder" if index == 0 else f"intruder_{index + 1}"
    return tuple(f"{name}_{part}" for part in ("x", "y", "vx", "vy"))


def history_columns(scene: Scene) -> tuple[str, ...]:
    """Names of the columns that a run of a scene writes, the time first; it is known before anything is built."""
    names = ["time"]
    if scene.structure is not None:
        names += [*_STRUCTURE, *_OF_THEORY.get(scene.structure.theory or "", ())]
    if scene.grains is not None:
        names += _FREE_GRAINS
        names += [column for k in range(len(scene.intruders)) for column in intruder_columns(k)]
    if scene.shaking is not None:
        names.append(f"{'floor' if _floor_shakes(scene) else 'walls'}_{scene.shaking.direction}")
    names += ["ledger_error", "ledger_relative_error"]
    if scene.interface is not None:
        names += _interface_columns(scene)
    if scene.grains is not None or scene.rows:
        names += ["momentum_residual", *(f"grains_{name}" for name in _GRAIN_ENERGIES), "walls_work", "rows_work"]
    if scene.structure is not None:
        names += [*_STRUCTURE_ENERGIES, *_scheme_columns(scene)]
    return tuple(names)


def _floor_shakes(scene: Scene) -> bool:
    """Whether the floor moves: the wall, or rows in its place."""
    assert scene.shaking is not None
    if scene.box is None or "floor" not in scene.box.walls:
        return bool(scene.shaken_rows)
    return "floor" in scene.shaking.moved(scene.box)


def _interface_columns(scene: Scene) -> list[str]:
    assert scene.interface is not None and scene.structure is not None, "the rules of the scene demand both"
    names = list(_INTERFACE)
    if scene.interface.kind == "glued" and not scene.interface.couple:
        names += ["moment_dropped", "moment_dropped_share"]
    if scene.structure.kind != "rigid":
        names.append("stiffness_ratio")
    return names


def _scheme_columns(scene: Scene) -> list[str]:
    """What the scheme dissipates, where it may."""
    structure = scene.structure
    assert structure is not None
    newmark, generalised, hht = structure.newmark, structure.generalised_alpha, structure.hht
    dissipates = (
        (newmark is not None and (newmark.beta, newmark.gamma) != (0.25, 0.5))
        or (generalised is not None and generalised.spectral_radius != 1.0)
        or (hht is not None and hht.alpha != 0.0)
    )
    return ["structure_loss_scheme"] if dissipates else []
