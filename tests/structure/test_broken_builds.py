"""A process that is killed while it compiles leaves the cache of finite elements as if it were still at it."""

import os
import time
from pathlib import Path

from structure.compat import WAIT, clear_broken_builds


def test_only_what_nobody_compiles_any_more_is_removed(tmp_path: Path) -> None:
    old = time.time() - 10.0 * WAIT
    for name in ("broken", "built", "under_way"):
        (tmp_path / f"{name}.c").write_text("")
    (tmp_path / "built.c.cached").write_text("")
    for name in ("broken.c", "built.c", "built.c.cached"):
        os.utime(tmp_path / name, (old, old))
    clear_broken_builds(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["built.c", "built.c.cached", "under_way.c"]


def test_a_cache_that_is_not_there_is_none_of_our_business(tmp_path: Path) -> None:
    clear_broken_builds(tmp_path / "none")
    assert not (tmp_path / "none").exists()
