"""What is measured: one function per group of runs that take turns."""

import os

import beds
import numpy as np
import processes
from timing import interleaved, per_particle_step, rebuild_share, seconds

from particles import ParticleSystem, Wall, box

Numbers = dict[str, float | None]
ROUNDS = 7
SHARE_STEPS = 2000
COPIES_100K, COPIES_MILLION = 7, 67  # times 15 000


class Rates:
    """Particle-steps per second of every run, with what was run."""

    def __init__(self) -> None:
        self.rows: list[dict[str, object]] = []

    def add(self, what: str, n: int, threads: int, cost: float, system: ParticleSystem) -> None:
        """Enter the cost of one particle-step [s]."""
        self.rows.append(
            {
                "what": what, "discs": n, "threads": threads, "particle_steps_per_second": 1.0 / cost,
                "rebuilds_per_step": system.rebuilds / max(system.steps_done, 1),
                "bytes_per_disc": bytes_held(system) / n,
            }
        )  # fmt: skip


def bytes_held(system: ParticleSystem) -> int:
    """Bytes of all arrays of state, lists and histories."""
    groups = [vars(system.grains).values(), system.list.pairs, system.list.walls]
    return sum(array.nbytes for group in groups for array in group if isinstance(array, np.ndarray))


def two_cores() -> bool:
    return len(os.sched_getaffinity(0)) > 1


def threads_15k(rates: Rates) -> Numbers:
    """The reference on one and two threads, and memory."""
    saved = beds.reference()
    systems = {k: beds.system_of(saved, threads=k) for k in ((1, 2) if two_cores() else (1,))}
    cost = interleaved({str(k): per_particle_step(s, 300) for k, s in systems.items()}, ROUNDS)
    for k, system in systems.items():
        rates.add("settled", len(system.grains), k, cost[str(k)], system)
    speedup = cost["1"] / cost["2"] if two_cores() else None
    return {
        "speedup_2_threads_15k": speedup,
        "bytes_per_disc": bytes_held(systems[1]) / len(systems[1].grains),
    }


def sizes(rates: Rates) -> Numbers:
    """Settled beds of 10^3, 10^5 and 10^6 discs, and the peak memory of the last."""
    threads = (1, 2) if two_cores() else (1,)
    small = {k: beds.system_of(beds.thousand(), width=beds.WIDTH / 15, threads=k) for k in threads}
    found: Numbers = {}
    for copies, steps, rounds in ((COPIES_100K, 40, 5), (COPIES_MILLION, 8, 3)):
        wide = beds.side_by_side(beds.reference(), copies).state()
        tasks, systems = {"small 1": per_particle_step(small[1], 4000)}, {}
        for k in threads:
            systems[k] = beds.system_of(wide, width=copies * beds.WIDTH, threads=k)
            tasks[str(k)] = per_particle_step(systems[k], steps)
        if two_cores():
            tasks["small 2"] = per_particle_step(small[2], 400)  # few: slow where others share the cores
        del wide
        cost = interleaved(tasks, rounds)
        for k, system in systems.items():
            rates.add("settled", len(system.grains), k, cost[str(k)], system)
        if copies == COPIES_100K:
            found["speedup_2_threads_100k"] = cost["1"] / cost["2"] if two_cores() else None
        else:
            found["cost_1e6_over_1e3"] = cost["1"] / cost["small 1"]
            for k, system in small.items():
                rates.add("settled", len(system.grains), k, cost[f"small {k}"], system)
    found["peak_memory_1e6_discs"] = processes.peak_memory(COPIES_MILLION)
    return found


def phases(rates: Rates) -> Numbers:
    """Settled, falling, sheared and shaken grains; then, apart from the rates, their shares of new lists."""
    saved = beds.reference()
    left, right, floor = box(beds.WIDTH, beds.HEIGHT)
    lifted = Wall(point=floor.point, normal=floor.normal, velocity=(0.0, 0.5), name="floor")
    systems = {
        "settled": beds.system_of(saved),
        "falling": beds.falling(),
        "sheared": beds.system_of(saved),
        "shaken": beds.system_of(saved, walls=[left, right, lifted]),
    }
    systems["sheared"].grains.vx += 5.0 * systems["sheared"].grains.y  # 5 per second
    cost = interleaved({name: per_particle_step(s, 200) for name, s in systems.items()}, ROUNDS)
    for name in list(systems)[1:]:
        rates.add(name, len(systems[name].grains), 1, cost[name], systems[name])
    shares: Numbers = {f"rebuild_share_{name}": rebuild_share(s, SHARE_STEPS) for name, s in systems.items()}
    return shares | {"falling_over_settled": cost["falling"] / cost["settled"]}


def size_ratio(rates: Rates) -> Numbers:
    """Radii 1:20 with half the area in each, against equal discs, per contact."""
    saved = {"equal discs": beds.equal(), "radii 1:20": beds.bimodal()}
    systems = {name: beds.system_of(state, width=beds.BIMODAL_WIDTH) for name, state in saved.items()}
    cost = interleaved({name: per_particle_step(s, 400) for name, s in systems.items()}, ROUNDS)
    per_contact = {}
    for name, system in systems.items():
        rates.add(name, len(system.grains), 1, cost[name], system)
        per_contact[name] = cost[name] * len(system.grains) / system.look().count
    return {"size_ratio_20_over_1": per_contact["radii 1:20"] / per_contact["equal discs"]}


def few_discs() -> Numbers:
    """25 discs: the time of one step."""
    system = beds.twenty_five()
    steps = 50_000
    cost = interleaved({"heap": lambda: seconds(system, steps) / steps}, 5)
    return {"microseconds_per_step_25_discs": 1e6 * cost["heap"]}
