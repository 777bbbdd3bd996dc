"""Frames for ParaView: one HDF5 file per frame and an XDMF index.

A file per frame and not one that grows: a run killed in the middle of a frame loses that frame
alone, and a resumed run drops the frames that lie after its checkpoint. The index gets each frame in
one write over its closing tags: what a frame costs does not grow with their number.
"""

from __future__ import annotations

import math
import os
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

LARGEST_SINGLE = float(np.finfo(np.float32).max)
# XDMF's name of each cell and its number of nodes
CELLS = {
    "point": ("Polyvertex", 1),
    "quadrilateral": ("Quadrilateral", 4),
    "quadrilateral9": ("Quadrilateral_9", 9),
    "triangle": ("Triangle", 3),
    "triangle6": ("Triangle_6", 6),
}


OPENING = '<?xml version="1.0" encoding="us-ascii"?>\n<Xdmf Version="3.0"><Domain>'
CLOSING = b"</Grid></Domain></Xdmf>"


class Frames:
    """A time series of one kind of points and cells, `<name>.xdmf` and `frames/<name>.*.h5`.

    Parameters
    ----------
    folder : Path
        Of the run.
    name : str
        "grains" or "structure".
    keep_until : float, optional
        Keep the frames up to this time [s] and drop the others; without it all are dropped.
    """

    def __init__(self, folder: Path, name: str, *, keep_until: float | None = None) -> None:
        self.folder, self.name = folder, name
        self._count = 0
        self.last_time = -math.inf  # of the last frame [s]
        self._index = folder / f"{name}.xdmf"
        kept = []
        (folder / "frames").mkdir(parents=True, exist_ok=True)
        for path in sorted((folder / "frames").glob(f"{name}.*.h5")):
            time = _time_of(path)
            if keep_until is not None and time is not None and time <= keep_until:
                kept.append(self._entry(time, path))
            else:
                path.unlink()
        if kept:
            self._begin(b"".join(kept))

    def write(
        self,
        time: float,
        points: NDArray[np.float64],
        data: Mapping[str, NDArray[Any]],
        *,
        cells: NDArray[np.int64] | None = None,
        kind: str = "point",
    ) -> None:
        """Add a frame: points (n, 2) [m], cells (m, k), data (n,) or (n, 2) per point, in single precision."""
        path = self.folder / "frames" / f"{self.name}.{self._count:06d}.h5"
        beside = path.with_suffix(".part")
        with h5py.File(beside, "w") as file:
            file.attrs["time"], file.attrs["kind"] = time, kind
            file["points"] = points
            if cells is not None:
                file["cells"] = cells
            for label, values in data.items():
                file[f"data/{label}"] = _in_space(values)
        os.replace(beside, path)
        first = self._count == 0
        entry = self._entry(time, path)
        if first:
            self._begin(entry)
        else:
            with open(self._index, "r+b", buffering=0) as file:
                file.seek(-len(CLOSING), os.SEEK_END)
                file.write(entry + CLOSING)

    def _begin(self, entries: bytes) -> None:
        """Put an index of some frames into its place."""
        series = f'<Grid Name="{self.name}" GridType="Collection" CollectionType="Temporal">'
        beside = self._index.with_suffix(".part")
        beside.write_bytes((OPENING + series).encode() + entries + CLOSING)
        os.replace(beside, self._index)

    def _entry(self, time: float, path: Path) -> bytes:
        """What the index says of the next frame."""
        self._count += 1
        self.last_time = time
        grid = ET.Element("Grid", Name=self.name, GridType="Uniform")
        ET.SubElement(grid, "Time", Value=repr(time))
        with h5py.File(path, "r") as file:
            cell, nodes = CELLS[str(file.attrs["kind"])]
            count = len(file["cells"]) if "cells" in file else len(file["points"])
            topology = ET.SubElement(grid, "Topology", TopologyType=cell, NumberOfElements=str(count))
            if "cells" in file:
                _refer(topology, file["cells"], path)
            else:
                topology.set("NodesPerElement", str(nodes))
            _refer(ET.SubElement(grid, "Geometry", GeometryType="XY"), file["points"], path)
            for label, data in file["data"].items():
                kind = "Vector" if data.ndim == 2 else "Scalar"
                _refer(ET.SubElement(grid, "Attribute", Name=label, AttributeType=kind, Center="Node"), data, path)
        return ET.tostring(grid)


def read_frame(path: Path) -> tuple[float, dict[str, NDArray[Any]]]:
    """Time and arrays ("points", "cells", and the data by name) of one frame file."""
    with h5py.File(path, "r") as file:
        arrays = {name: np.array(file[name]) for name in ("points", "cells") if name in file}
        arrays |= {name: np.array(data) for name, data in file["data"].items()}
        return float(file.attrs["time"]), arrays


def _refer(element: ET.Element, data: h5py.Dataset, path: Path) -> None:
    item = ET.SubElement(
        element,
        "DataItem",
        Format="HDF",
        Dimensions=" ".join(str(size) for size in data.shape),
        NumberType="Int" if data.dtype.kind == "i" else "Float",
        Precision=str(data.dtype.itemsize),
    )
    item.text = f"frames/{path.name}:{data.name}"


def _in_space(values: NDArray[Any]) -> NDArray[Any]:
    """Single precision where it holds them; vectors get a third component, without which ParaView sees none."""
    array = np.asarray(values)
    if array.dtype.kind == "f" and not np.abs(array).max(initial=0.0) > LARGEST_SINGLE:
        array = array.astype(np.float32)
    if array.ndim == 2 and array.shape[1] == 2:
        array = np.column_stack([array, np.zeros(len(array), array.dtype)])
    return array


def _time_of(path: Path) -> float | None:
    try:
        with h5py.File(path, "r") as file:
            return float(file.attrs["time"])
    except (OSError, KeyError):
        return None
