"""Whether a bed is still a bed: one judge for the end states of all codes."""

import numpy as np
from scipy.spatial import cKDTree

MASS_ERROR = 1e-9  # relative; one code takes pi with twelve digits only


def look(state: np.ndarray, width: float) -> dict[str, float]:
    """Numbers of a bed at rest, from columns x, y, vx, vy, radius, mass in a box of `width` [m]."""
    place, radius = state[:, :2], state[:, 4]
    pairs = cKDTree(place).query_pairs(2.0 * radius.max(), output_type="ndarray")
    i, j = pairs.T
    overlap = radius[i] + radius[j] - np.hypot(*(place[i] - place[j]).T)
    inside = (place[:, 0] > 0.0) & (place[:, 0] < width) & (place[:, 1] > 0.0)
    return {
        "inside": float(inside.mean()),
        "coordination": 2.0 * float((overlap > 0.0).sum()) / len(place),
        "deepest": float((overlap / np.minimum(radius[i], radius[j])).max()),
        "root_mean_square_speed": float(np.sqrt(np.mean(state[:, 2] ** 2 + state[:, 3] ** 2))),
    }


def require_sane(name: str, seen: dict[str, float]) -> None:
    """Refuse times of a run that blew up or fell apart."""
    still = seen["root_mean_square_speed"] < 0.02  # a fall of a hundredth of a diameter
    sane = seen["inside"] == 1.0 and 2.0 < seen["coordination"] < 4.5 and seen["deepest"] < 0.02 and still
    if not sane:
        raise RuntimeError(f"{name} ended in a state that is not a bed at rest: {seen}")


def require_same_discs(name: str, state: np.ndarray, radius: np.ndarray, mass: np.ndarray) -> None:
    """Refuse a code that holds other grains than those it was given, in order."""
    for what, theirs, ours in (("radius", state[:, 4], radius), ("mass", state[:, 5], mass)):
        if (error := float(np.abs(theirs / ours - 1.0).max())) > MASS_ERROR:
            raise RuntimeError(f"{name} has a {what} that is not the one given: off by {error:.1e}")


def summary(name: str, seen: dict[str, float]) -> str:
    """One line."""
    return (
        f"{name}: {'all' if seen['inside'] == 1.0 else 'NOT ALL'} inside, coordination {seen['coordination']:.2f}, "
        f"deepest overlap {100.0 * seen['deepest']:.2g} % of r, speeds {1e3 * seen['root_mean_square_speed']:.2g} mm/s"
    )
