"""The writers of a run: its history and its frames."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coupled.model import Model
from coupled.output import history
from coupled.output.frames import Frames
from coupled.running.observe import Observation
from structure import StructureFields


class Writers:
    """History, frames of the grains, frames of the structure, in the folder of a run.

    Parameters
    ----------
    folder : Path
    model : Model
    keep_until : float, optional
        Of a run that is taken up again: time [s] of its checkpoint.
    """

    def __init__(self, folder: Path, model: Model, *, keep_until: float | None) -> None:
        self.history = history.History(folder / history.NAME, keep_until=keep_until)
        self.grains = Frames(folder, "grains", keep_until=keep_until) if model.particles is not None else None
        self.structure = Frames(folder, "structure", keep_until=keep_until) if model.structure is not None else None

    def write_frame(self, model: Model, seen: Observation, fields: StructureFields | None) -> None:
        """One frame of each. Grains stand in the order of their numbers, glued ones and rows last."""
        if self.grains is not None:
            grains = model.particles.grains
            order = np.argsort(grains.number)
            data = {
                "radius": grains.radius,
                "velocity": np.column_stack([grains.vx, grains.vy]),
                "spin": grains.omega,
                "angle": grains.theta,
                "force": np.column_stack([grains.fx, grains.fy]),
                "overlap": seen.look.overlap,
                "contacts": seen.look.contacts,
                "body": grains.body,
            }
            if model.particles.facets is not None:
                data["facet_force"] = model.contact_force
            self.grains.write(model.time, grains.position[order], {name: a[order] for name, a in data.items()})
        if fields is not None:
            data = dict(fields.point_data)
            if model.interface is not None:
                data["grain_force"] = _on_mesh(model, fields)
            self.structure.write(model.time, fields.points, data, cells=fields.cells, kind=fields.cell_kind)


def _on_mesh(model: Model, fields: StructureFields) -> np.ndarray:
    """Forces (n, 2) [N/m] of the grains on all mesh nodes: those of the boundary, zero elsewhere."""
    force = np.zeros_like(fields.points)
    force[model.structure.mesh.outer_nodes] = model.nodal_force
    return force
