"""Global damping: a drag on every free grain."""

from dataclasses import dataclass

from particles.errors import require
from particles.kernels import layout


@dataclass(frozen=True, kw_only=True)
class GlobalDamping:
    """Force ``-alpha_t m v`` and torque ``-alpha_r I omega`` on every free grain.

    Parameters
    ----------
    translational, rotational : float
        alpha_t, alpha_r [1/s], >= 0. Source: model 1.2; Gomes 2014, section 2.1.9.

    Raises
    ------
    ParticleError
        If a number is not finite or negative.
    """

    translational: float = 0.0
    rotational: float = 0.0

    def __post_init__(self) -> None:
        require("translational damping", self.translational, at_least=0.0)
        require("rotational damping", self.rotational, at_least=0.0)

    def numbers(self) -> layout.GlobalDamping:
        return layout.GlobalDamping(float(self.translational), float(self.rotational))
