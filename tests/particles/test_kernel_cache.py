"""Two processes that compile one function for different types leave both builds on the disk, each under its own name."""

import importlib.util
import multiprocessing
import sys
import time
from pathlib import Path
from types import ModuleType

import pytest

from particles.kernels import jit

LIMIT = 300.0  # seconds; only a defect takes so long


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a module, and with the cache for it."""
    monkeypatch.setattr(jit, "CACHE_FOLDER", tmp_path / "cache")
    monkeypatch.setitem(sys.modules, "doubling", ModuleType("doubling"))  # taken away at the end
    (tmp_path / "doubling.py").write_text(
        "from particles.kernels.jit import kernel\n\n\n@kernel\ndef twice(x):\n    return x + x\n"
    )
    return tmp_path


def doubling(place: Path) -> ModuleType:
    """The module, loaded anew."""
    spec = importlib.util.spec_from_file_location("doubling", place / "doubling.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["doubling"] = module
    spec.loader.exec_module(module)
    return module


def test_builds_of_two_processes_at_the_same_time_are_both_kept(place: Path) -> None:
    """The second comes to save while the first stands between reading the index and writing it."""
    fork = multiprocessing.get_context("fork")
    between, comes = fork.Event(), fork.Event()

    def first() -> None:
        twice = doubling(place).twice
        file = twice._cache._cache_file
        write_index = file._save_index

        def write_late(index: dict) -> None:
            between.set()
            comes.wait(LIMIT)
            time.sleep(0.5)  # in which the second, were it let, would save
            write_index(index)

        file._save_index = write_late
        twice(1.5)

    def second() -> None:
        twice = doubling(place).twice
        between.wait(LIMIT)
        save = twice._cache._cache_file.save

        def come_and_save(*build: object) -> None:
            comes.set()
            save(*build)

        twice._cache._cache_file.save = come_and_save
        twice(1j)

    both = [fork.Process(target=action) for action in (first, second)]
    for process in both:
        process.start()
    for process in both:
        process.join(LIMIT)
    assert [process.exitcode for process in both] == [0, 0]
    twice = doubling(place).twice
    assert (twice(1.5), twice(1j)) == (3.0, 2j)
    assert sum(twice.stats.cache_hits.values()) == 2 and not twice.stats.cache_misses
