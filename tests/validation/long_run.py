"""A shaken box for 400 periods of 25 000 steps, in a process of its own that is watched from outside."""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

from coupled.output import checkpoint
from coupled.output.folder import SUMMARY

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "runs" / "validation" / "long"
RUN, LATE, RESUMED = FOLDER / "run", FOLDER / "late", FOLDER / "resumed"
SAMPLES, RESUMED_SAMPLES = FOLDER / "samples.csv", FOLDER / "resumed_samples.csv"
STEP = "1.5811388e-4"  # the source's 0.01 sqrt(m/k_n)
PERIOD, SETTLING, PERIODS = 25_000, 200_000, 400  # in steps; the shaking begins at a whole number of periods
LAST = SETTLING + PERIODS * PERIOD
ROWS, FRAMES, CHECKPOINTS = PERIOD // 4, 10 * PERIOD, 4 * PERIOD  # what is asked for, steps between two
AT = LAST - CHECKPOINTS  # step of the checkpoint that is copied: 99 %
OVERRIDES = (
    f"time.step={STEP}", "time.duration=1612.761576", "shaking.start=31.622776",
    "output.history_interval=0.98821175", "output.frames_per_second=0.02529822",
    "output.checkpoint_interval=15.811388", "output.figures=false", "quantities=[]",
)  # fmt: skip
PAUSE, CLOSE_PAUSE = 15.0, 0.5  # seconds between two looks; shortly before the copy


def command(out: Path) -> list[str]:
    """What a user types, on one thread; a run that was begun is taken up."""
    sets = [word for override in OVERRIDES for word in ("--set", override)]
    resume = ["--resume"] if out.exists() else []
    return [
        sys.executable, "-m", "coupled.cli", "run", "shaken_walls", "--out", str(out), "--threads", "1",
        "--no-progress", *sets, *resume,
    ]  # fmt: skip


def make() -> None:
    """Make the run or take it up; copy its folder at 99 %."""
    _watched(RUN, SAMPLES, copies=True)


def resume_late() -> None:
    """Take a copy of that copy to the end, in a process of its own."""
    if not RESUMED.exists():
        shutil.copytree(LATE, RESUMED)
    _watched(RESUMED, RESUMED_SAMPLES, copies=False)


def _watched(out: Path, samples: Path, *, copies: bool) -> None:
    """Run in a process, note its memory and the sizes of its files on the way."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    if (out / SUMMARY).exists():
        return
    process = subprocess.Popen(command(out), cwd=ROOT)
    while process.poll() is None:
        note(process.pid, out, samples)
        close = last_step(out) >= AT - CHECKPOINTS
        if copies and close and not LATE.exists():
            copy_late()
        with suppress(subprocess.TimeoutExpired):
            process.wait(CLOSE_PAUSE if close else PAUSE)
    assert process.returncode == 0, process.returncode


def copy_late() -> None:
    """Copy the folder while it is written to, its checkpoint first: whatever comes after that a resumed run drops."""
    beside = LATE.with_suffix(".part")
    shutil.rmtree(beside, ignore_errors=True)
    beside.mkdir()
    shutil.copyfile(RUN / checkpoint.NAME, beside / checkpoint.NAME)  # appears in one move, so the copy is whole
    if int(checkpoint.load(beside / checkpoint.NAME)[0]["model.steps_done"]) != AT:
        return
    rest = shutil.ignore_patterns(checkpoint.NAME, SUMMARY, "*.part")
    shutil.copytree(RUN, beside, ignore=rest, dirs_exist_ok=True)
    beside.rename(LATE)


def note(pid: int, out: Path, samples: Path) -> None:
    """A line of the samples: step, memory and processor time of the process, sizes of what it has written."""
    with suppress(FileNotFoundError, ProcessLookupError, KeyError):  # it has just ended
        row = {
            "clock_seconds": time.time(),
            "pid": pid,
            "step": last_step(out),
            **memory(pid),
            "cpu_seconds": processor_seconds(pid),
            "load": os.getloadavg()[0],
            **sizes(out),
        }
        new = not samples.exists()
        with open(samples, "a", newline="") as file:
            writer = csv.DictWriter(file, list(row))
            if new:
                writer.writeheader()
            writer.writerow(row)


def memory(pid: int) -> dict[str, int]:
    """Resident memory now and its highest so far, and what of it belongs to no file [B]."""
    kilobytes = {}
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        name, _, value = line.partition(":")
        if name in ("VmRSS", "VmHWM", "RssAnon"):
            kilobytes[name] = 1024 * int(value.split()[0])
    return {"resident": kilobytes["VmRSS"], "highest": kilobytes["VmHWM"], "anonymous": kilobytes["RssAnon"]}


def processor_seconds(pid: int) -> float:
    """User and system time of a process [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def last_step(out: Path) -> int:
    """The step of the last whole row of the history, 0 before the first."""
    try:
        with open(out / "history.csv", "rb") as file:
            file.seek(max(0, file.seek(0, os.SEEK_END) - 4096))
            rows = file.read().decode().split("\n")[:-1]  # what follows the last end of a line is not whole
        return round(float(rows[-1].split(",")[0]) / float(STEP))
    except (FileNotFoundError, IndexError, ValueError):
        return 0


def sizes(out: Path) -> dict[str, int]:
    """Bytes of each kind of file in the folder, and the number of frames."""
    frames = [path.stat().st_size for path in (out / "frames").glob("*.h5")]
    files = {name: out / name for name in ("history.csv", "checkpoint.h5", "grains.xdmf", "log.txt")}
    held = {name: path.stat().st_size if path.exists() else 0 for name, path in files.items()}
    return held | {"frames": sum(frames), "frame_count": len(frames)}


if __name__ == "__main__":
    make()
