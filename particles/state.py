"""The state of all discs as a struct of arrays."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particles.errors import ParticleError, require

Floats = NDArray[np.float64]
FREE = -1
LEADS = ("lead_x", "lead_y", "lead_spin")
SINGLE = ("fx", "fy", "torque", "mass", "inertia", "inverse_mass", "inverse_inertia", "roll_compliance")
PRECISIONS = ("float64", "float32")
WHOLE_NUMBERS = ("n_free", "body", "number", "material")


@dataclass(kw_only=True)
class Grains:
    """Discs: the free ones first, then the prescribed ones (glued grains, rows).

    All arrays have shape (n,). SI units per unit thickness: m, m/s, rad, rad/s, kg/m, kg m, N/m;
    counter-clockwise positive. Free grains are reordered in memory while they move; `number` is
    the place a grain had at the beginning, `body` is -1 for a free grain or the number of the
    prescribed body that carries it, and `material` the row of a `ContactTable`, 0 without one. Between calls of `ParticleSystem.advance` positions and forces
    belong to the present time, velocities to half a step later; what they gained in half a step is
    kept in `lead_x`, `lead_y`, `lead_spin` where a scheme needs it, else these are None.
    """

    n_free: int
    x: Floats
    y: Floats
    theta: Floats
    vx: Floats
    vy: Floats
    omega: Floats
    fx: Floats
    fy: Floats
    torque: Floats
    radius: Floats
    mass: Floats
    inertia: Floats
    inverse_mass: Floats
    inverse_inertia: Floats
    roll_compliance: Floats
    material: NDArray[np.int32]
    x_listed: Floats
    y_listed: Floats
    body: NDArray[np.int32]
    number: NDArray[np.int64]
    lead_x: Floats | None = None
    lead_y: Floats | None = None
    lead_spin: Floats | None = None

    @classmethod
    def discs(
        cls,
        position: ArrayLike,
        radius: ArrayLike,
        density: ArrayLike,
        *,
        velocity: ArrayLike = 0.0,
        spin: ArrayLike = 0.0,
        material: ArrayLike = 0,
    ) -> "Grains":
        """Free discs at `position` (n, 2) [m], `radius` (n,) or one [m], `density` [kg/m3].

        Mass ``pi r^2 rho`` [kg/m], inertia ``m r^2 / 2`` [kg m]; `velocity` (n, 2) [m/s], `spin`
        (n,) [rad/s], `material` (n,) the rows of a `ContactTable`.
        """
        place = np.atleast_2d(np.asarray(position, float)).reshape(-1, 2)
        n = len(place)
        zeros = {f.name: np.zeros(n) for f in fields(cls) if f.name not in WHOLE_NUMBERS + LEADS}
        grains = cls(
            n_free=n, body=np.full(n, FREE, np.int32), number=np.arange(n), material=np.zeros(n, np.int32), **zeros
        )
        grains.x[:], grains.y[:] = place.T
        grains.radius[:] = radius
        speed = np.broadcast_to(np.asarray(velocity, float), (n, 2))
        grains.vx[:], grains.vy[:] = speed.T
        grains.omega[:] = spin
        grains.material[:] = material
        grains.mass[:] = np.pi * grains.radius**2 * np.asarray(density, float)
        grains._check()
        grains.inertia[:] = 0.5 * grains.mass * grains.radius**2
        grains.inverse_mass[:], grains.inverse_inertia[:] = 1.0 / grains.mass, 1.0 / grains.inertia
        grains.roll_compliance[:] = 1.0 / (grains.inertia + grains.mass * grains.radius**2)
        return grains

    @classmethod
    def from_saved(cls, saved: Mapping[str, NDArray[Any]]) -> "Grains":
        """The free grains of a state saved by `ParticleSystem.state`, in the same order."""
        n_free = int(saved["grains.n_free"])
        names = [f.name for f in fields(cls) if f.name != "n_free" and f"grains.{f.name}" in saved]
        return cls(n_free=n_free, **{name: np.array(saved[f"grains.{name}"][:n_free]) for name in names})

    def with_prescribed(self, position: ArrayLike, radius: ArrayLike, body: int, *, material: int = 0) -> "Grains":
        """These grains and the discs of one more prescribed body (no mass: they are not integrated)."""
        place = np.asarray(position, float).reshape(-1, 2)
        n = len(place)
        more = {name: np.zeros(n) for name in self.arrays() if name not in WHOLE_NUMBERS}
        more["x"], more["y"] = place[:, 0].copy(), place[:, 1].copy()
        more["radius"] = np.broadcast_to(np.asarray(radius, float), (n,)).copy()
        more["body"] = np.full(n, body, np.int32)
        more["material"] = np.full(n, material, np.int32)
        more["number"] = np.arange(len(self.x), len(self.x) + n, dtype=np.int64)
        both = {name: np.concatenate([getattr(self, name), array]) for name, array in more.items()}
        grains = Grains(n_free=self.n_free, **both)
        grains._check()
        return grains

    def __len__(self) -> int:
        return len(self.x)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """All arrays (n,) that are kept, by name."""
        return {f.name: getattr(self, f.name) for f in fields(self) if isinstance(getattr(self, f.name), np.ndarray)}

    @property
    def position(self) -> Floats:
        """(n, 2) [m], a copy."""
        return np.column_stack([self.x, self.y])

    def bodies(self) -> dict[int, slice]:
        """The places of each prescribed body."""
        found = {}
        for body in np.unique(self.body[self.n_free :]):
            at = np.nonzero(self.body == body)[0]
            found[int(body)] = slice(int(at[0]), int(at[-1]) + 1)
        return found

    def reorder(self, order: NDArray[np.int64]) -> None:
        """Put free grain order[k] into place k."""
        for array in self.arrays().values():
            array[: self.n_free] = array[order]

    def keep_leads(self, wanted: bool) -> None:
        """Have arrays for the gain of half a step, or none."""
        for name in LEADS:
            if wanted and getattr(self, name) is None:
                setattr(self, name, np.zeros(len(self)))
            elif not wanted:
                setattr(self, name, None)

    def keep_in(self, precision: str) -> None:
        """Have what may be stored in single precision, `SINGLE`, in "float64" or in "float32".

        Positions, velocities and radii are none of it: a step adds too little to the first two, and overlaps are small
        differences of the others.
        """
        for name in SINGLE:
            setattr(self, name, getattr(self, name).astype(precision, copy=False))

    def _check(self) -> None:
        for name in ("x", "y", "vx", "vy", "omega", "radius", "mass"):
            bad = np.nonzero(~np.isfinite(getattr(self, name)))[0]
            if len(bad):
                raise ParticleError(f"{name} of grain {bad[0]} is not a finite number")
        if len(self.radius) and not self.radius.min() > 0.0:
            raise ParticleError(f"radius of grain {self.radius.argmin()} = {self.radius.min():g} must be positive")
        free = self.mass[: self.n_free]
        if len(free):
            require("grain mass", float(free.min()), above=0.0)
