"""What the tests of moving bodies measure by themselves: turns, angular momentum, the energy that must stay."""

import numpy as np
from held import HeldBody

from structure import ElasticStructure, StructureEnergies


def balance(e: StructureEnergies) -> float:
    """The sum [J/m] that stays."""
    return e.kinetic + e.strain + e.rayleigh_loss - e.external_work - e.boundary_work


def exchanged(e: StructureEnergies) -> float:
    """Scale [J/m] of the energies."""
    return sum(abs(value) for value in vars(e).values())


def quarter(vectors: np.ndarray) -> np.ndarray:
    """Vectors (n, 2) turned by +90 degrees."""
    return np.column_stack([-vectors[:, 1], vectors[:, 0]])


def turned(vectors: np.ndarray, angle: float) -> np.ndarray:
    """Vectors (n, 2) turned by an angle [rad]."""
    return np.cos(angle) * vectors + np.sin(angle) * quarter(vectors)


def cross(a: np.ndarray, b: np.ndarray) -> float:
    """Sum of a x b over rows (n, 2)."""
    return float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())


class Scales:
    """Angular momentum of a body about the origin, by the mass matrix in original order."""

    def __init__(self, body: ElasticStructure) -> None:
        self._body = body
        self._mass = HeldBody(body.mesh, body.material, "standard").mass

    def angular_momentum(self) -> float:
        """``sum x x M v`` [kg m/s]."""
        fields = self._body.fields().point_data
        places = self._body.mesh.points + fields["displacement"]
        return cross(places, (self._mass @ fields["velocity"].ravel()).reshape(-1, 2))
