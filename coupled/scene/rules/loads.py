"""Rules of the loads: boundaries of the shape, and complete schedules."""

from __future__ import annotations

from coupled.scene.loads import BoundaryLoad, PressureLoad, Rows, Sine
from coupled.scene.refusal import Plain, missing, nearest, refusal
from coupled.scene.structure import Structure


def check_loads(structure: Structure) -> None:
    """Check that loads act on boundaries of the shape and that their schedules are complete."""
    known = structure.shape.boundaries
    for index, load in enumerate(structure.loads):
        key = f"structure.loads.{index}"
        if isinstance(load, (BoundaryLoad, PressureLoad)) and load.boundary not in known:
            raise refusal(
                f"{key}.boundary", load.boundary, f"is no boundary of this shape; {nearest(load.boundary, known)}"
            )
        if isinstance(load, PressureLoad) and load.follows and structure.theory == "linear":
            raise refusal(
                f"{key}.follows",
                True,
                'needs a theory that follows the body; give structure.theory = "corotational" or "large_strain", or '
                "follows = false",
            )
        if isinstance(load.schedule, Sine):
            _check_sine(f"{key}.schedule", load.schedule)
        if isinstance(load.schedule, Rows):
            _check_rows(f"{key}.schedule", load.schedule)


def _check_sine(key: str, sine: Sine) -> None:
    if sine.frequency is None and sine.period is None:
        raise missing(f"{key}.frequency", "give it in Hz, or period in s")
    if sine.frequency is not None and sine.period is not None:
        raise refusal(f"{key}.period", sine.period, "is given together with frequency; keep one")


def _check_rows(key: str, rows: Rows) -> None:
    times, factors = rows.times, rows.factors
    if rows.file is not None:
        lists = times is not None or factors is not None
        reason = (
            "is given together with times or factors; keep one"
            if lists
            else ("is read where a scene file is loaded; give times and factors")
        )
        raise refusal(f"{key}.file", rows.file, reason)
    for name, column in (("times", times), ("factors", factors)):
        if column is None:
            raise missing(f"{key}.{name}", "give times and factors, or file")
        if len(column) < 2:
            raise refusal(f"{key}.{name}", list(column), "has too few entries; give at least 2")
    if len(times) != len(factors):
        raise refusal(
            f"{key}.factors",
            Plain(f"{len(factors)} numbers"),
            f"do not match the {len(times)} times; give one for each",
        )
    for index in range(1, len(times)):
        if times[index] <= times[index - 1]:
            raise refusal(
                f"{key}.times.{index}",
                times[index],
                f"must be later than {times[index - 1]:g} s; let the times increase",
            )
