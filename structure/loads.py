"""External loads: linear ramp from 0 at t = 0 to full at `ramp_time`, then constant."""

from __future__ import annotations

from dataclasses import dataclass

from structure import checks


def _check_ramp(ramp_time: float) -> None:
    checks.not_negative("ramp_time", ramp_time, "s")


@dataclass(frozen=True, kw_only=True)
class BodyForce:
    """Force ``rho acceleration`` per volume; acceleration (2,) [m/s^2], ramp_time [s]."""

    acceleration: tuple[float, float]
    ramp_time: float = 0.0

    def __post_init__(self) -> None:
        checks.plane_vector("acceleration", self.acceleration, "m/s^2")
        _check_ramp(self.ramp_time)


@dataclass(frozen=True, kw_only=True)
class BoundaryLoad:
    """Force spread evenly over the reference length of a named boundary, of fixed direction.

    boundary : name; total_force (2,) : resultant [N per metre of thickness]; ramp_time [s].
    """

    boundary: str
    total_force: tuple[float, float]
    ramp_time: float = 0.0

    def __post_init__(self) -> None:
        checks.plane_vector("total_force", self.total_force, "N per metre of thickness")
        _check_ramp(self.ramp_time)


@dataclass(frozen=True, kw_only=True)
class PointLoad:
    """Force on the outer boundary node nearest to a reference point.

    point (2,) [m], at most half a facet away from a node; force (2,) [N/m]; ramp_time [s]. Under
    a point force the displacement of a plane continuum has no mesh limit.
    """

    point: tuple[float, float]
    force: tuple[float, float]
    ramp_time: float = 0.0

    def __post_init__(self) -> None:
        checks.plane_vector("point", self.point, "m")
        checks.plane_vector("force", self.force, "N per metre of thickness")
        _check_ramp(self.ramp_time)


Load = BodyForce | BoundaryLoad | PointLoad


def ramp(load: Load, time: float) -> float:
    """Factor between 0 and 1 of a load at `time` [s]."""
    return 1.0 if time >= load.ramp_time else time / load.ramp_time
