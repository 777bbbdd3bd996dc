"""`make validate`: the scenes of Gomes 2014, chapter 4, at full size, against what the source reports.

Runs (or takes up) every scene in `runs/validation` and writes `docs/validation/sources.md` with the
pictures. The source's numbers come from its figures and text, to the digits given there.
"""

import math
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from coupled.output.frames import read_frame
from coupled.output.history import read_history
from coupled.running.run import run_scene
from coupled.scene import load_scene

ROOT = Path(__file__).parents[2]
RUNS, PAGE = ROOT / "runs" / "validation", ROOT / "docs" / "validation" / "sources.md"
FRICTION_ANGLE = math.radians(20.5)  # slope of the source's pile of the same grains
UNIT_WEIGHT = 1600.0 * 0.82 * 9.81  # N/m3, with the solid fraction of the settled bed

History = dict[str, np.ndarray]


@dataclass(frozen=True)
class Check:
    """One statement of the source, what we find, and whether they agree."""

    scene: str
    what: str
    source: str
    ours: str
    agrees: bool


def bearing(width: float, depth: float) -> float:
    """Strip footing on cohesionless soil [N/m], Reissner's N_q and Vesic's N_gamma."""
    n_q = math.exp(math.pi * math.tan(FRICTION_ANGLE)) * math.tan(math.pi / 4 + FRICTION_ANGLE / 2) ** 2
    n_gamma = 2.0 * (n_q + 1.0) * math.tan(FRICTION_ANGLE)
    return UNIT_WEIGHT * width * (depth * n_q + 0.5 * width * n_gamma)


def structure_frame(folder: Path) -> dict[str, np.ndarray]:
    return read_frame(sorted((folder / "frames").glob("structure.*.h5"))[-1])[1]


def near(history: History, name: str, time: float, width: float = 0.25) -> float:
    """Mean of a column over `width` [s] before `time`."""
    chosen = (history["time"] > time - width) & (history["time"] <= time)
    return float(history[name][chosen].mean())


def rigid_tube(folder: Path, history: History) -> list[Check]:
    deep, left = near(history, "reaction_y", 10.0), near(history, "reaction_y", 12.0)
    strip = bearing(0.1, 0.1)
    return [
        Check(
            "rigid_tube", "vertical force at full depth", "about 1200 N/m", f"{deep:.0f} N/m",
            abs(deep / 1200 - 1) < 0.3,
        ),
        Check("rigid_tube", "force 2 s after the turn", "drops at once", f"{left:.0f} N/m", abs(left) < 0.1 * deep),
        Check(
            "rigid_tube", "bearing of a strip 0.1 m wide, 0.1 m deep, at 20.5 degrees", f"order {strip:.0f} N/m",
            f"{deep:.0f} N/m", 0.5 < deep / strip < 2.0,
        ),
    ]  # fmt: skip


def rigid_beam(folder: Path, history: History) -> list[Check]:
    most, strip = float(history["reaction_y"].max()), bearing(0.5, 0.05)
    return [
        Check(
            "rigid_beam", "largest vertical force", "about 13 350 N/m", f"{most:.0f} N/m",
            abs(most / 13350 - 1) < 0.15,
        ),
        Check(
            "rigid_beam", "bearing of a strip 0.5 m wide, 0.05 m deep, at 20.5 degrees", f"order {strip:.0f} N/m",
            f"{most:.0f} N/m", 0.5 < most / strip < 2.0,
        ),
    ]  # fmt: skip


def rigid_tube_trench(folder: Path, history: History) -> list[Check]:
    left, right = near(history, "reaction_x", 9.5, 2.0), near(history, "reaction_x", 19.5, 2.0)
    return [
        Check(
            "rigid_tube_trench", "horizontal force going left, then right", "changes sign with the direction",
            f"{left:.0f}, then {right:.0f} N/m", left > 0.0 > right,
        )
    ]  # fmt: skip


def elastic_tube(folder: Path, history: History) -> list[Check]:
    frame, reaction = structure_frame(folder), near(history, "reaction_y", 5.0)
    cells = load_scene(folder / "scene.toml").structure.element
    places = frame["points"] + frame["displacement"][:, :2]
    height = (places[:, 1] - places[:, 1].mean()) / np.ptp(places[:, 1])
    hottest, lowest = height[frame["von_mises"].argmax()], height[frame["grain_force"][:, 1].argmax()]
    gauss, nodal = float(history["max_von_mises"][-1]) / 1e6, frame["von_mises"].max() / 1e6
    return [
        Check("elastic_tube", "reaction at rest", "1000 N/m", f"{reaction:.2f} N/m", abs(reaction / 1000 - 1) < 0.02),
        Check(
            "elastic_tube", "height of the largest von Mises stress, over the diameter", "0, at the centre",
            f"{hottest:.2f}", abs(hottest) < 0.15,
        ),
        Check(
            "elastic_tube", "height of the largest nodal force, over the diameter", "near the bottom, -0.5",
            f"{lowest:.2f}", lowest < -0.3,
        ),
        Check(
            "elastic_tube", "largest von Mises stress", "27.7 MPa; equilibrium allows 0.36 to 0.79",
            f"{gauss:.2f} MPa at Gauss points, {nodal:.2f} of nodal averages (60 cells, {cells})", False,
        ),
    ]  # fmt: skip


def elastic_beam(folder: Path, history: History) -> list[Check]:
    frame, reaction = structure_frame(folder), near(history, "reaction_y", 5.0)
    x, y = frame["points"].T
    axis = np.abs(y - np.median(np.unique(np.round(y, 9)))) < 1e-9
    order = np.argsort(x[axis])
    moved = frame["displacement"][axis][order, 1]
    bow = float(moved[len(moved) // 2] - 0.5 * (moved[0] + moved[-1]))
    return [
        Check("elastic_beam", "reaction at rest", "6000 N/m", f"{reaction:.2f} N/m", abs(reaction / 6000 - 1) < 0.02),
        Check(
            "elastic_beam", "middle of the axis above its ends", "yes, the ends bend down", f"{1e6 * bow:.1f} um",
            bow > 0.0,
        ),
    ]  # fmt: skip


SCENES: dict[str, tuple[Callable[[Path, History], list[Check]], tuple[str, ...]]] = {
    "elastic_tube": (elastic_tube, ("near_structure", "interface_forces", "centroid", "reaction")),
    "elastic_beam": (elastic_beam, ("near_structure", "interface_forces", "neutral_axis")),
    "rigid_tube": (rigid_tube, ("configuration", "penetration")),
    "rigid_beam": (rigid_beam, ("configuration", "penetration")),
    "rigid_tube_trench": (rigid_tube_trench, ("configuration", "reaction")),
}


def write_page(checks: list[Check], pictures: list[str]) -> None:
    """The page as computed; nothing in it is typed by hand but the source's own numbers."""
    lines = ["# The scenes of Gomes 2014, chapter 4", "", "Written by `make validate`.", ""]
    lines += ["| scene | what | source | here | agree |", "|---|---|---|---|---|"]
    lines += [f"| {c.scene} | {c.what} | {c.source} | {c.ours} | {'yes' if c.agrees else 'no'} |" for c in checks]
    lines += ["", *(f"![{name}]({name})" for name in pictures), ""]
    PAGE.write_text("\n".join(lines))


@pytest.mark.validate
def test_scenes_of_the_source() -> None:
    checks: list[Check] = []
    pictures: list[str] = []
    PAGE.parent.mkdir(exist_ok=True)
    for name, (look, figures) in SCENES.items():
        folder = run_scene(load_scene(name), out=RUNS / name, resume=(RUNS / name).exists())
        checks += look(folder, read_history(folder / "history.csv"))
        for figure in figures:
            shutil.copy(folder / "figures" / f"{figure}.png", PAGE.parent / f"{name}_{figure}.png")
            pictures.append(f"{name}_{figure}.png")
        write_page(checks, pictures)
    # the one statement that cannot hold: the source's stress is above what equilibrium allows
    impossible = [c for c in checks if "27.7 MPa" in c.source]
    assert len(impossible) == 1
    assert all(c.agrees for c in checks if c not in impossible), [c for c in checks if not c.agrees]
