"""The energy ledger of the whole model, interface included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coupled.model import Model
from particles import ContactLook

STORED = ("kinetic", "rotational", "gravity", "normal_springs", "tangential_springs", "rolling_springs")


@dataclass(frozen=True)
class Balance:
    """Energies [J/m] at one moment and the sums since the start.

    Attributes
    ----------
    entries : dict
        Every line by name: stored energies, losses (positive), works of walls, rows and loads
        (positive when done on the model).
    total : float
        Stored + lost - works: constant but for the error of the integrators and the exchange.
    throughput : float
        Half the sum of the magnitudes of all changes, losses and works: what the error is measured
        against. Needs the entries of the start.
    error, relative_error : float
        Change of the total since the start, and over the throughput.
    interface_residual : float
        Work that the interface did on the grains plus work of the nodal forces on the
        structure: zero if no energy is lost or made at the interface.
    """

    entries: dict[str, float]
    total: float
    throughput: float
    error: float
    interface_residual: float

    @property
    def relative_error(self) -> float:
        return abs(self.error) / self.throughput if self.throughput > 0.0 else 0.0


def take_balance(model: Model, look: ContactLook | None, start: dict[str, float] | None) -> Balance:
    """The ledger of the model now; `start` are the entries of the first one.

    Collective under MPI; whole on rank 0.
    """
    stored: dict[str, float] = {}
    losses: dict[str, float] = {}
    works: dict[str, float] = {}
    residual = 0.0
    if model.particles is not None:
        own = model.particles.energies(look)
        stored |= {f"grains_{name}": own[name] for name in STORED}
        losses |= {f"grains_{name}": value for name, value in own.items() if name.startswith("loss_")}
        given = model.interface.work(model.particles) if model.interface is not None else 0.0
        works |= {
            "walls_work": own["work_walls"],
            "rows_work": own["work_prescribed"] + own.get("work_facets", 0.0) - given,
        }
        residual += given
    if model.structure is not None:
        body = model.structure.energies()
        stored |= {"structure_kinetic": body.kinetic, "structure_strain": body.strain}
        losses["structure_loss_rayleigh"] = body.rayleigh_loss
        scheme = getattr(model.structure, "scheme", None)  # an elastic structure alone has one
        if scheme is not None and not scheme.conserves:
            losses["structure_loss_scheme"] = body.scheme_loss
        works["loads_work"] = body.external_work
        residual += body.boundary_work
    entries = {**stored, **losses, **works}
    if model.interface is None:
        residual = 0.0
    total = sum(stored.values()) + sum(losses.values()) - sum(works.values())
    start = start or entries
    signs = {**dict.fromkeys(stored, 1.0), **dict.fromkeys(losses, 1.0), **dict.fromkeys(works, -1.0)}
    changes = np.array([signs[name] * (entries[name] - start.get(name, 0.0)) for name in entries])
    return Balance(entries, total, 0.5 * float(np.abs(changes).sum()), float(changes.sum()), residual)
