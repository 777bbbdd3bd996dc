"""From the tables of loads to the loads of the structure, and to what `leito check` says of them."""

from __future__ import annotations

import math

import numpy as np

import structure as fem
from coupled.errors import LeitoError
from coupled.scene import loads as tables
from meshes import StructureMesh
from structure.loads.load import Load
from structure.loads.point_location import shares_at
from structure.loads.schedules import Schedule

FEWEST_STEPS = 20  # per period of a sine: Newmark then lengthens a period by 1 %


def loads_of(given: tuple[tables.Load, ...], mesh: StructureMesh, centroid: tuple[float, float]) -> list[Load]:
    """The loads that tables describe; a point counts from the centroid (x, y) [m] of the shape.

    Raises
    ------
    LeitoError
        A point load lies off the structure.
    """
    loads: list[Load] = []
    for index, table in enumerate(given):
        loads.append(load := _load(table, centroid))
        if isinstance(load, fem.PointLoad):
            try:
                shares_at(mesh, load.point)
            except fem.StructureError as error:
                raise LeitoError(
                    f"structure.loads.{index}.point = {list(table.point)} from the centroid, which is at "
                    f"{centroid!r}: {error}"
                ) from None
    return loads


def _load(table: tables.Load, centroid: tuple[float, float]) -> Load:
    schedule = _schedule(table.schedule)
    match table:
        case tables.BoundaryLoad():
            return fem.BoundaryLoad(boundary=table.boundary, total_force=table.total_force, schedule=schedule)
        case tables.PressureLoad():
            return fem.Pressure(
                boundary=table.boundary, pressure=table.pressure, follows=table.follows, schedule=schedule
            )
        case tables.BodyLoad():
            return fem.BodyForce(acceleration=table.acceleration, schedule=schedule)
    point = (centroid[0] + table.point[0], centroid[1] + table.point[1])
    return fem.PointLoad(point=point, force=table.force, schedule=schedule)


def _schedule(table: tables.Schedule) -> Schedule:
    match table:
        case tables.Ramp():
            return fem.Ramp(over=table.over)
        case tables.Sine():
            return fem.Sine(frequency=table.cycles_per_second, phase=table.phase, offset=table.offset)
        case tables.Rows():
            return fem.Table(times=table.times, factors=table.factors)
    return fem.Constant()


def unresolved_schedules(loads: tuple[tables.Load, ...], step: float) -> list[str]:
    """Sentences on schedules that change too fast for steps of a length [s]."""
    said = [(index, _unresolved(load.schedule, step)) for index, load in enumerate(loads)]
    return [f"structure.loads.{index}: {sentence}" for index, sentence in said if sentence]


def _unresolved(schedule: tables.Schedule, step: float) -> str:
    if isinstance(schedule, tables.Sine):
        steps = 1.0 / (schedule.cycles_per_second * step)
        return f"the sine has {steps:.3g} steps a period; take at least {FEWEST_STEPS}" if steps < FEWEST_STEPS else ""
    if isinstance(schedule, tables.Rows):
        shortest = min(np.diff(schedule.times))
        missed = f"rows of the table are {shortest:.3g} s apart, and a step of {step:.3g} s misses some of them"
        return missed if shortest < step else ""
    return ""


def load_rows(loads: tuple[tables.Load, ...]) -> list[tuple[str, str, str]]:
    """Rows (section, quantity, value) with what acts where, and its schedule."""
    return [("loads", _place(load), f"{_strength(load)}, {_course(load.schedule)}") for load in loads]


def _place(load: tables.Load) -> str:
    match load:
        case tables.BoundaryLoad():
            return f"on {load.boundary}"
        case tables.PressureLoad():
            return f"pressure on {load.boundary}" + (", follows" if load.follows else "")
        case tables.BodyLoad():
            return "on the whole body"
    return "at {:g}, {:g} m from the centroid".format(*load.point)


def _strength(load: tables.Load) -> str:
    match load:
        case tables.BoundaryLoad():
            return "{:g}, {:g} N/m".format(*load.total_force)
        case tables.PressureLoad():
            return f"{load.pressure:g} Pa"
        case tables.BodyLoad():
            return "{:g}, {:g} m/s2".format(*load.acceleration)
    return "{:g}, {:g} N/m".format(*load.force)


def _course(schedule: tables.Schedule) -> str:
    match schedule:
        case tables.Ramp():
            return f"ramp over {schedule.over:g} s"
        case tables.Sine():
            mean = f" about {schedule.offset:g}" if schedule.offset else ""
            phase = f" from {math.degrees(schedule.phase):.4g} degrees" if schedule.phase else ""
            return f"sine of {schedule.cycles_per_second:.4g} Hz{mean}{phase}"
        case tables.Rows():
            low, high = min(schedule.factors), max(schedule.factors)
            return f"table of {len(schedule.times)} rows up to {schedule.times[-1]:g} s, factor {low:g} to {high:g}"
    return "constant"
