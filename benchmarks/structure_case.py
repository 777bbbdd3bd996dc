"""One beam of a given size on the ranks of this process: our step, with and without ledger, and the bare one in turns; prints one line of JSON.

``mpirun -n 2 python structure_case.py UNKNOWNS``
"""

import json
import resource
import sys
import time

import numpy as np
from bare_structure import BareBeam
from mpi4py import MPI
from timing import interleaved

import meshes
from structure import BodyForce, ElasticStructure, PlaneStrain, Rayleigh

MATERIAL = PlaneStrain(youngs_modulus=70e9, poissons_ratio=0.35, density=2700.0)
DAMPING = Rayleigh(mass_factor=0.5, stiffness_factor=1e-6)
FALL, STEP, ROUNDS = (0.0, -9.81), 1e-5, 7
TIME_OF_ROUND, FEWEST = 0.05, 2  # [s], steps


def beam(unknowns: float) -> meshes.StructureMesh:
    """A beam 4 m long and about 1 m high of square cells with about so many unknowns."""
    across = max(1, round((unknowns / 8.0) ** 0.5))
    return meshes.beam(length=4.0, height=1.0, along=4 * across, across=across, comm=MPI.COMM_WORLD)


def main() -> None:
    """Build both, let them take turns, compare where they are, print."""
    comm, mesh = MPI.COMM_WORLD, beam(float(sys.argv[1]))
    options = {"material": MATERIAL, "damping": DAMPING, "loads": [BodyForce(acceleration=FALL)], "time_step": STEP}
    begin = time.perf_counter()
    ours = ElasticStructure(mesh, element="standard", **options)
    setup = time.perf_counter() - begin
    lean = ElasticStructure(mesh, element="standard", ledger=False, **options)
    lean._theory.stepper._solve = ours._theory.stepper._solve  # one factor in memory for all
    bare = BareBeam(
        mesh.domain, ours._body.space, young=MATERIAL.youngs_modulus, poisson=MATERIAL.poissons_ratio,
        density=MATERIAL.density, mass_factor=DAMPING.mass_factor, stiffness_factor=DAMPING.stiffness_factor,
        acceleration=FALL, step=STEP, boundary=_boundary(ours), solve=ours._theory.stepper._solve,
    )  # fmt: skip
    nothing, local = np.zeros_like(mesh.outer_polyline.points), np.zeros(len(bare.boundary))
    first = _seconds(lambda: bare.advance(local), FEWEST, comm) / FEWEST
    steps = max(FEWEST, int(TIME_OF_ROUND / first))
    cost = interleaved(
        {
            "ours": lambda: _seconds(lambda: ours.advance(nothing), steps, comm) / steps,
            "lean": lambda: _seconds(lambda: lean.advance(nothing), steps, comm) / steps,
            "bare": lambda: _seconds(lambda: bare.advance(local), steps, comm) / steps,
        },
        ROUNDS,
    )
    _require_same_motion(ours, bare, steps)
    memory = comm.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) / 1024
    if comm.rank == 0:
        row = {
            "unknowns": 2 * len(mesh.points), "ranks": comm.size, "step_seconds": cost["ours"],
            "lean_step_seconds": cost["lean"], "bare_step_seconds": cost["bare"], "setup_seconds": setup, "peak_memory_mib": memory,
        }  # fmt: skip
        print(json.dumps(row))


def _boundary(body: ElasticStructure) -> np.ndarray:
    """This rank's unknowns on the outer boundary."""
    (nodes,) = np.nonzero(np.isin(body._body.nodes.owned, body.mesh.outer_nodes))
    return np.column_stack([2 * nodes, 2 * nodes + 1]).ravel()


def _seconds(step, count: int, comm: MPI.Intracomm) -> float:
    """Wall time of `count` steps on all ranks; the longest."""
    comm.Barrier()
    begin = time.perf_counter()
    for _ in range(count):
        step()
    return comm.allreduce(time.perf_counter() - begin, op=MPI.MAX)


def _require_same_motion(ours: ElasticStructure, bare: BareBeam, steps: int) -> None:
    """Both are where free fall under mass damping takes them, after the steps that each has taken."""
    for name, taken, place in (
        ("ours", round(ours.time / STEP), ours.centroid()[1] - ours._body.centroid[1]),
        ("bare", FEWEST + (ROUNDS + 1) * steps, ours._body.centroid_now(bare.u.array_r)[1] - ours._body.centroid[1]),
    ):
        rate, end = DAMPING.mass_factor, taken * STEP
        exact = FALL[1] / rate * (end - (1.0 - np.exp(-rate * end)) / rate)
        if abs(place / exact - 1.0) > 1e-4:
            raise RuntimeError(f"{name} has fallen {place:.6g} m instead of {exact:.6g} m")


if __name__ == "__main__":
    main()
