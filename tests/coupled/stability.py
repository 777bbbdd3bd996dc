"""Growth of a small disturbance in the real coupled model, and the stiffness ratio at which it begins.

A rigid beam is pressed onto two discs, fixed ones or free ones that lie on fixed ones, so that all contacts are
closed and all forces balance. A small step of the load disturbs it; as no contact opens, what follows is a linear map
from window to window. Its eigenvalues are read off the motion (eigensystem realisation, Juang and Pappa 1985).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coupled.build import build
from coupled.errors import LeitoError
from coupled.exchange.iterated import ROUND_OFF
from coupled.model import Model
from coupled.scene import Scene
from particles import ParticleError

STIFFNESS, MASS, RADIUS = 1e6, 50.0, 0.15  # of each contact [N/m], of the beam [kg/m], of discs and glued grains [m]
OVERLAP, DISTURBED = 3e-5, 0.05  # at rest [m], and the share of the load by which it steps
WINDOWS, BLOCK = 60, 12
FEWEST = 5  # windows: a disturbance that opens springs sooner grows
NOISE = 1e-7  # singular values below it, over the largest, are round-off
NEUTRAL = 1e-4  # above 1 by less is read as 1
SLOW = 0.03  # from 1: eigenvalues of more than 200 windows a period, of which 60 windows do not tell the growth
GRID = 1.25  # between the stiffness ratios at which growth is looked for


@dataclass(frozen=True, kw_only=True)
class Press:
    """A beam on two springs, as the rows and columns of the map name it.

    `damping` is that of the beam on its contacts over the critical one, with free discs that of a disc between
    its two contacts; `mass_ratio` that of a free disc to half the beam, None for fixed discs.
    """

    exchange: str = "predicted"
    substeps: int = 1
    damping: float = 0.0
    mass_ratio: float | None = None
    interface: str = "glued"

    def window(self, ratio: float) -> float:
        """The H [s] of ``r = (k H^2 + 2 c H) 2/m``."""
        lag = self.dashpot() / STIFFNESS
        return float(np.sqrt(lag**2 + ratio * MASS / (2 * STIFFNESS)) - lag)

    def dashpot(self) -> float:
        """Of each contact [N s/m]."""
        if self.mass_ratio is None:
            return self.damping * np.sqrt(2 * STIFFNESS * MASS)
        return self.damping * np.sqrt(STIFFNESS * self.mass_ratio * MASS)

    def model(self, ratio: float) -> Model:
        """The model at a stiffness ratio, in equilibrium but for the disturbance."""
        window = self.window(ratio)
        interface: dict[str, Any] = {"boundaries": ["bottom"], "largest_stiffness_ratio": 1e9}
        interface |= {"exchange": self.exchange, "substeps": self.substeps}
        if self.exchange == "iterated":
            interface |= {"tolerance": 1e-10}
        interface |= {"kind": "facets"} if self.interface == "facets" else {"per_facet": 1, "diameter": 2 * RADIUS}
        surface = -RADIUS if self.interface == "glued" else 0.0
        depth = surface - RADIUS + OVERLAP
        load = -2 * STIFFNESS * OVERLAP
        tables: dict[str, Any] = {
            "title": "a beam pressed onto two discs",
            "time": {"duration": 1e3 * window, "step": window / self.substeps},
            "structure": {
                "kind": "free_rigid", "density": MASS / 0.05,
                "beam": {"length": 1.0, "height": 0.05, "along": 3, "across": 1},
                "placement": {"x": 0.5, "y": 0.025},
                "loads": [
                    {"kind": "boundary", "boundary": "top", "total_force": [0.0, load]},
                    {"kind": "boundary", "boundary": "top", "total_force": [0.0, DISTURBED * load],
                     "schedule": {"kind": "ramp", "over": 0.5 * window}},
                ],
            },
            "interface": interface,
            "contact": {
                "normal_stiffness": STIFFNESS,
                "normal_damping": self.dashpot(),
            },
            "output": {"history_interval": 1e3 * window, "figures": False},
        }  # fmt: skip
        if self.mass_ratio is not None:
            density = self.mass_ratio * MASS / 2 / (np.pi * RADIUS**2)
            tables["grains"] = {
                "sizes": [{"radius": RADIUS, "count": 2}], "density": density, "layout": "list",
                "positions": [[1 / 3, depth], [2 / 3, depth]],
            }  # fmt: skip
            depth -= 2 * RADIUS - OVERLAP
        tables["rows"] = [{"start": (1 / 3, depth), "end": (2 / 3, depth), "count": 2, "radius": RADIUS}]
        return build(Scene.model_validate(tables)).model

    def growth(self, ratio: float) -> float:
        """Spectral radius of a window; infinite where the grains' own step is refused or a window does not converge."""
        try:
            model, seen = self.model(ratio), []
            for _ in range(WINDOWS):
                model.advance(1)
                seen.append([model.structure.centroid()[1], model.structure.momentum()[1], model.reaction[1]])
                push = model.reaction[1] / (2 * STIFFNESS * OVERLAP)
                if not (abs(seen[-1][0] - 0.025) < 0.5 * OVERLAP and abs(push - 1.0) < 0.5):
                    break  # springs are about to open: it grows
        except (LeitoError, ParticleError):
            return math.inf
        if len(seen) <= FEWEST:
            return math.inf
        series = np.diff(np.array(seen), axis=0)
        left = 100 * ROUND_OFF / np.abs(series[:, 0]).max() if self.exchange == "iterated" else 0.0
        return spectral_radius(series, max(NOISE, left))

    def limit(self, low: float, high: float) -> float:
        """The stiffness ratio above `low` where growth begins, to 2 %; infinite if it does not up to `high`."""
        steps = math.ceil(math.log(high / low) / math.log(GRID))
        below = 0.0
        for ratio in np.geomspace(low, high, steps + 1).tolist():
            if self.growth(ratio) > 1.0 + NEUTRAL:
                return self._between(below, ratio) if below else 0.0
            below = ratio
        return math.inf

    def _between(self, low: float, high: float) -> float:
        while high > 1.02 * low:
            middle = math.sqrt(low * high)
            low, high = (low, middle) if self.growth(middle) > 1.0 + NEUTRAL else (middle, high)
        return low


def spectral_radius(series: NDArray[np.float64], noise: float = NOISE) -> float:
    """Largest magnitude of the eigenvalues of the linear map whose free motion (times, quantities) is seen.

    `noise` of the motion, over its largest, is not the map's.
    """
    scaled = series / np.abs(series).max(axis=0)
    block = min(BLOCK, len(scaled) // 2)
    columns = len(scaled) - block
    hankel = np.array([scaled[k : k + block].ravel() for k in range(columns + 1)]).T
    left, sizes, _ = np.linalg.svd(hankel[:, :-1], full_matrices=False)
    order = int(np.count_nonzero(sizes > noise * sizes[0]))
    projected = left[:, :order].T @ hankel
    step = np.linalg.lstsq(projected[:, :-1].T, projected[:, 1:].T, rcond=None)[0]
    found = np.linalg.eigvals(step)
    return float(np.abs(found[np.abs(found - 1.0) > SLOW]).max(initial=0.0))
