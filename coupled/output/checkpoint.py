"""A state on disk that is either whole or not there."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from coupled.errors import LeitoError

NAME = "checkpoint.h5"


def save(path: Path, arrays: Mapping[str, NDArray[Any]], *, scene: str) -> None:
    """Write all arrays and the scene, then put the file into its place in one move.

    A process killed in the middle leaves the file of before untouched.
    """
    beside = path.with_suffix(".part")
    with h5py.File(beside, "w") as file:
        for name, array in arrays.items():
            file.create_dataset(name, data=array)
        file.attrs["scene"] = scene
        file.attrs["complete"] = True
    with open(beside, "rb") as written:
        os.fsync(written.fileno())
    os.replace(beside, path)


def load(path: Path) -> tuple[dict[str, NDArray[Any]], str]:
    """Read back what `save` wrote: the arrays and the scene's text.

    Raises
    ------
    LeitoError
        If the file is missing, cut short or not a checkpoint.
    """
    try:
        with h5py.File(path, "r") as file:
            if not file.attrs.get("complete", False):
                raise OSError("no mark of completeness")
            return {name: np.array(data) for name, data in file.items()}, str(file.attrs["scene"])
    except FileNotFoundError:
        raise LeitoError(f"{path}: there is no checkpoint; start the run without --resume") from None
    except (OSError, KeyError) as error:
        raise LeitoError(f"{path} cannot be read as a checkpoint ({error}); start anew with --overwrite") from None
