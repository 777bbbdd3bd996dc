"""Cost of a step by theory of strain: `python benchmarks/theories.py [cells around ...]`, on a quiet machine.

A free tube, 15 times as many cells around as through the wall, spins and is pushed by forces at random. The best of
several repetitions counts.
"""

from __future__ import annotations

import argparse
import time

import meshes
import numpy as np
from structure import ElasticStructure, PlaneStrain

THEORIES = ("linear", "corotational", "large_strain")
SECONDS, REPETITIONS = 0.5, 5  # in all, for each theory and mesh


def cost(theory: str, around: int) -> tuple[int, float]:
    """Unknowns, and seconds per step of 4e-5 s, spinning with 1 rad/s."""
    tube = meshes.tube(outer_radius=0.05, inner_radius=0.04, around=around, layers=max(1, around // 15))
    material = PlaneStrain(youngs_modulus=70e9, poissons_ratio=0.35, density=2700.0)
    body = ElasticStructure(tube, material=material, time_step=4e-5, theory=theory, element="standard")
    body.set_initial(velocity=np.column_stack([-tube.points[:, 1], tube.points[:, 0]]))
    pushes = np.random.default_rng(1).normal(size=(16, *body.polyline.points.shape))
    best = np.inf
    for _ in range(REPETITIONS):
        steps, begun = 0, time.perf_counter()
        while (spent := time.perf_counter() - begun) < SECONDS / REPETITIONS or steps < len(pushes):
            body.advance(pushes[steps % len(pushes)])
            steps += 1
        best = min(best, spent / steps)
    return tube.points.size, best


def main() -> None:
    """Print one row per mesh."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("around", nargs="*", type=int, default=[30, 120, 480], help="cells around")
    print(f"{'unknowns':>9}" + "".join(f"{theory:>20}" for theory in THEORIES))
    for around in parser.parse_args().around:
        found = [cost(theory, around) for theory in THEORIES]
        linear = found[0][1]
        row = "".join(f"{1e6 * seconds:>11.0f} us {seconds / linear:>4.0f} x" for _, seconds in found)
        print(f"{found[0][0]:>9}{row}")


if __name__ == "__main__":
    main()
