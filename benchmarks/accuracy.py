"""`make bench ARGS=accuracy`: what the presets cost and how far off they are, on the scenes that ship.

Studies of the scenes, shortened so that all fit into twenty minutes on two cores. Writes
`docs/validation/accuracy.md` with its pictures; the studies stay in `runs/studies/accuracy`, where `--resume` takes
them up. `python benchmarks/accuracy.py rolling_tube` tries some scenes only, and writes its page beside the studies.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import accuracy_page

from coupled.study.study import Study, Wishes, run_study

ROOT = Path(__file__).parents[1]
STUDIES = ROOT / "runs" / "studies" / "accuracy"
PAGE = ROOT / "docs" / "validation" / "accuracy.md"

NARROW = (
    "bed.box.width=0.3", "bed.grains.sizes.0.count=600", "bed.grains.sizes.1.count=1200",
    "bed.grains.sizes.2.count=600", "bed.time.duration=1.0", "structure.placement.x=0.15",
)  # fmt: skip
NARROW_SAID = "On 2400 grains in a box of 0.3 m that settle for 1 s"


@dataclass(frozen=True, kw_only=True)
class Case:
    """A scene that ships, shortened.

    Parameters
    ----------
    scene : str
    said : str
        What differs from the scene as it ships; empty: nothing.
    overrides : tuple
    knobs : tuple, optional
        Knobs to turn beside the presets; absent: all.
    levels : int
        Of refinement of the reference.
    seeds : int, optional
    """

    scene: str
    said: str = ""
    overrides: tuple[str, ...] = ()
    knobs: tuple[str, ...] | None = ()
    levels: int = 1
    seeds: int | None = None


CASES = (
    Case(scene="beam_vibration", knobs=None, levels=2),
    Case(scene="pulsing_tube", knobs=None, levels=2),
    Case(
        scene="winkler_beam",
        said="For 0.2 s under a load that is full after 0.1 s.",
        overrides=("time.duration=0.2", "structure.loads.0.schedule.over=0.1"),
        knobs=None,
        levels=2,
    ),
    Case(
        scene="rolling_tube",
        said="For 0.2 s.",
        overrides=("time.duration=0.2", "quantities.2.start=0.1"),
    ),
    Case(
        scene="bed",
        said="2400 grains in a box of 0.3 m, for 1 s.",
        overrides=(
            "box.width=0.3", "grains.sizes.0.count=600", "grains.sizes.1.count=1200", "grains.sizes.2.count=600",
            "time.duration=1.0", "quantities.1.left=0.05", "quantities.1.right=0.25", "quantities.1.top=0.1",
        ),  # fmt: skip
        knobs=("coarsening", "stiffness"),
    ),
    Case(
        scene="elastic_tube",
        said=f"{NARROW_SAID}, for 0.4 s under a load that is full after 0.15 s.",
        overrides=(
            *NARROW, "time.duration=0.4", "structure.loads.0.schedule.over=0.15", "quantities.0.start=0.3",
            "quantities.2.start=0.3",
        ),  # fmt: skip
    ),
    Case(
        scene="elastic_beam",
        said=f"{NARROW_SAID}, a beam of 0.15 m under 1800 N, for 0.4 s, the load full after 0.15 s.",
        overrides=(
            *NARROW, "time.duration=0.4", "structure.loads.0.schedule.over=0.15", "structure.beam.length=0.15",
            "structure.beam.along=12", "structure.loads.0.total_force=[0.0, -1800.0]", "quantities.0.exact=1800.0",
            "quantities.0.start=0.3", "quantities.2.start=0.3",
        ),  # fmt: skip
    ),
    Case(
        scene="rigid_tube",
        said=f"{NARROW_SAID}; 20 mm down in 0.7 s, three times as fast.",
        overrides=(
            *NARROW, "time.duration=0.7", "structure.path.points=[[0.0, 0.0, 0.0], [0.7, 0.0, -0.02]]",
            "quantities.0.changes_by=-0.01", "quantities.1.start=0.35", "quantities.1.end=0.7",
        ),  # fmt: skip
    ),
    Case(
        scene="rigid_beam",
        said=f"{NARROW_SAID}; a beam of 0.15 m, 20 mm down in 0.7 s, six times as fast.",
        overrides=(
            *NARROW, "time.duration=0.7", "structure.path.points=[[0.0, 0.0, 0.0], [0.7, 0.0, -0.02]]",
            "structure.beam.length=0.15", "structure.beam.along=12", "quantities.0.changes_by=-0.01",
            "quantities.1.start=0.35", "quantities.1.end=0.7",
        ),  # fmt: skip
    ),
    Case(
        scene="rigid_tube_trench",
        said=f"{NARROW_SAID}; 20 mm down, 20 mm left and 40 mm right in 2.5 s.",
        overrides=(
            *NARROW, "time.duration=2.5",
            "structure.path.points=[[0.0, 0.0, 0.0], [0.7, 0.0, -0.02], [1.3, -0.02, -0.02], [2.5, 0.02, -0.02]]",
            "quantities.0.start=0.5", "quantities.0.end=0.7", "quantities.1.start=1.0", "quantities.1.end=1.3",
            "quantities.2.start=2.0", "quantities.2.end=2.5",
        ),  # fmt: skip
        seeds=3,
    ),
)  # fmt: skip
LEFT_OUT = (
    "Not measured: `bed_million`, the bed again with sixty-seven times its grains, and the shaken boxes, whose answers "
    "are means over hundreds of periods (`leito ensemble`)."
)


def run_cases(cases: Sequence[Case], folder: Path, *, resume: bool) -> list[tuple[Case, Study]]:
    """Run the studies one after the other."""
    found = []
    for case in cases:
        wishes = Wishes(overrides=case.overrides, knobs=case.knobs, levels=case.levels, seeds=case.seeds)
        print(f"{case.scene}:", flush=True)
        out = folder / case.scene
        found.append(
            (case, run_study(case.scene, wishes, out=out, resume=resume, overwrite=not resume, progress=False))
        )
    return found


def measure(scenes: Sequence[str] = (), *, resume: bool = False) -> Path:
    """Run the studies of all scenes, or of some, and write the page; returns its path."""
    unknown = set(scenes) - {case.scene for case in CASES}
    if unknown:
        raise SystemExit(f"no study of {', '.join(sorted(unknown))}: take any of {', '.join(c.scene for c in CASES)}")
    cases = [case for case in CASES if not scenes or case.scene in scenes]
    done = run_cases(cases, STUDIES, resume=resume)
    page = STUDIES / PAGE.name if scenes else PAGE
    accuracy_page.write(page, [(case.scene, case.said, study) for case, study in done], LEFT_OUT)
    return page


def main() -> None:
    """Measure what the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", help="scenes to study; all by default")
    parser.add_argument("--resume", action="store_true", help="go on with what is done")
    given = parser.parse_args()
    print(measure(given.scenes, resume=given.resume))


if __name__ == "__main__":
    main()
