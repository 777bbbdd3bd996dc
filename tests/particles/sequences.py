"""Random sequences whose large-deviation function is known in closed form."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

MEAN, SPREAD = 0.3, 1.0  # of the Gaussian increments
UP = 0.75  # chance of a step up of the walk
LEAVE_UP, LEAVE_DOWN = 0.1, 0.3  # chances to change of the chain


def walk(rng: np.random.Generator, n: int) -> np.ndarray:
    """Steps 1 and -1."""
    return np.where(rng.random(n) < UP, 1.0, -1.0)


def gaussian(rng: np.random.Generator, n: int) -> np.ndarray:
    """Independent normal increments."""
    return MEAN + SPREAD * rng.standard_normal(n)


def chain(rng: np.random.Generator, n: int) -> np.ndarray:
    """Steps 1 and -1 of a two-state chain, by the lengths of its stays, from its stationary state."""
    stays = 2 * n  # enough
    state = np.where((np.arange(stays) + (rng.random() < LEAVE_UP / (LEAVE_UP + LEAVE_DOWN))) % 2, -1.0, 1.0)
    length = rng.geometric(np.where(state > 0.0, LEAVE_UP, LEAVE_DOWN))
    return np.repeat(state, length)[:n]


def walk_cumulant(k: np.ndarray) -> np.ndarray:
    return np.log(UP * np.exp(k) + (1.0 - UP) * np.exp(-k))


def walk_rate(v: np.ndarray) -> np.ndarray:
    share = 0.5 * (1.0 + v)
    return share * np.log(share / UP) + (1.0 - share) * np.log((1.0 - share) / (1.0 - UP))


def gaussian_cumulant(k: np.ndarray) -> np.ndarray:
    return MEAN * k + 0.5 * (SPREAD * k) ** 2


def gaussian_rate(v: np.ndarray) -> np.ndarray:
    return 0.5 * ((v - MEAN) / SPREAD) ** 2


def chain_cumulant(k: np.ndarray) -> np.ndarray:
    """Logarithm of the largest eigenvalue of the tilted matrix of transitions."""
    found = []
    for tilt in k:
        up, down = math.exp(tilt), math.exp(-tilt)
        tilted = np.array([[(1.0 - LEAVE_UP) * up, LEAVE_UP * down], [LEAVE_DOWN * up, (1.0 - LEAVE_DOWN) * down]])
        found.append(math.log(np.linalg.eigvals(tilted).real.max()))
    return np.array(found)


def chain_rate(v: np.ndarray) -> np.ndarray:
    """Legendre's transform, maximised numerically."""

    def one(rate: float) -> float:
        return -minimize_scalar(
            lambda k: chain_cumulant(np.array([k]))[0] - k * rate, bounds=(-5.0, 5.0), method="bounded"
        ).fun

    return np.array([one(rate) for rate in v])


class Sequence(NamedTuple):
    """A sequence with its closed forms; `slope` is that of the symmetry of Gallavotti and Cohen."""

    make: Callable[[np.random.Generator, int], np.ndarray]
    cumulant: Callable[[np.ndarray], np.ndarray]
    rate: Callable[[np.ndarray], np.ndarray]
    slope: float


SEQUENCES = {
    "walk": Sequence(walk, walk_cumulant, walk_rate, math.log(UP / (1.0 - UP))),
    "gaussian": Sequence(gaussian, gaussian_cumulant, gaussian_rate, 2.0 * MEAN / SPREAD**2),
    # lambda(k) = lambda(-k - s): the trace of the tilted matrix is symmetric, its determinant constant
    "chain": Sequence(chain, chain_cumulant, chain_rate, math.log((1.0 - LEAVE_UP) / (1.0 - LEAVE_DOWN))),
}
