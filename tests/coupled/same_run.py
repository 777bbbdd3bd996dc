"""Two folders of runs that must hold the same bits."""

from pathlib import Path

import h5py
import numpy as np

from coupled.output import checkpoint


def assert_same_run(left: Path, right: Path) -> None:
    """Same history, same frames, same last state, to the bit."""
    assert (left / "history.csv").read_text() == (right / "history.csv").read_text()
    names = sorted(path.name for path in (left / "frames").glob("*.h5"))
    assert names == sorted(path.name for path in (right / "frames").glob("*.h5"))
    for name in names:
        with h5py.File(left / "frames" / name) as a, h5py.File(right / "frames" / name) as b:
            np.testing.assert_array_equal(a["points"], b["points"])
    a, _ = checkpoint.load(left / "checkpoint.h5")
    b, _ = checkpoint.load(right / "checkpoint.h5")
    assert a.keys() == b.keys()
    for name in a.keys() - {"run.seconds"}:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)
