"""What the theories share whose bodies turn by any angle."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from structure.errors import StructureError
from structure.loads.vectors import LoadVectors
from structure.theories.conserving import ConservingStepper
from structure.theories.theory import TheoryName


class TurningTheory:
    """Whole turns are counted and remembered; a position of rest is refused. See `Theory`."""

    name: ClassVar[TheoryName]
    stepper: ConservingStepper

    def rotation(self) -> float:
        """See `Theory`; whole turns counted."""
        return self.stepper.turn

    def static_displacement(self, loads: LoadVectors) -> NDArray[np.float64]:
        """See `Theory`; refused."""
        raise StructureError(
            f"static_displacement is that of theory = 'linear', not of '{self.name}': let the body come to rest "
            "under Rayleigh damping instead"
        )

    def memory(self) -> dict[str, NDArray[np.float64]]:
        """See `Theory`: the whole turns."""
        return {"rotation": np.array(self.rotation())}

    def recall(self, state: dict[str, NDArray[np.float64]]) -> None:
        """See `Theory`."""
        self.stepper.resume(float(state["rotation"]))
