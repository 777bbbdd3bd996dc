"""External loads. Each has a schedule in time, `Constant()` unless it is given another."""

from __future__ import annotations

from dataclasses import dataclass

from structure import checks
from structure.loads.schedules import Constant, Schedule


@dataclass(frozen=True, kw_only=True)
class BodyForce:
    """Force ``rho acceleration`` per volume; acceleration (2,) [m/s^2]."""

    acceleration: tuple[float, float]
    schedule: Schedule = Constant()

    def __post_init__(self) -> None:
        checks.plane_vector("acceleration", self.acceleration, "m/s^2")
        checks.schedule(self.schedule)


@dataclass(frozen=True, kw_only=True)
class BoundaryLoad:
    """Force spread evenly over the reference length of a named boundary, of fixed direction.

    boundary : name; total_force (2,) : resultant [N per metre of thickness].
    """

    boundary: str
    total_force: tuple[float, float]
    schedule: Schedule = Constant()

    def __post_init__(self) -> None:
        checks.plane_vector("total_force", self.total_force, "N per metre of thickness")
        checks.schedule(self.schedule)


@dataclass(frozen=True, kw_only=True)
class PointLoad:
    """Force of fixed direction at a reference point inside the body or on its boundary.

    point (2,) [m]; force (2,) [N/m]. The nodes of the cell that holds the point share the force by their
    shape functions: resultant, moment and virtual work are exact. A point that lies off the mesh by no
    more than a round boundary bulges over its facets is taken to the nearest facet. Under a point
    force the displacement of a plane continuum has no mesh limit.
    """

    point: tuple[float, float]
    force: tuple[float, float]
    schedule: Schedule = Constant()

    def __post_init__(self) -> None:
        checks.plane_vector("point", self.point, "m")
        checks.plane_vector("force", self.force, "N per metre of thickness")
        checks.schedule(self.schedule)


@dataclass(frozen=True, kw_only=True)
class Pressure:
    """Pressure on a named boundary.

    ``f = -p int N n ds`` with the outward normal n.

    boundary : name; pressure [Pa], positive when it presses on the body; follows : whether normal and
    length are those of the present shape, or of the reference shape.
    """

    boundary: str
    pressure: float
    follows: bool = False
    schedule: Schedule = Constant()

    def __post_init__(self) -> None:
        checks.finite("pressure", self.pressure, "Pa")
        checks.schedule(self.schedule)


Load = BodyForce | BoundaryLoad | PointLoad | Pressure
