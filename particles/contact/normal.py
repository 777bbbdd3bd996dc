"""Normal contact: the linear spring and dashpot."""

from dataclasses import dataclass

from particles.errors import require
from particles.kernels import layout


@dataclass(frozen=True, kw_only=True)
class LinearSpringDashpot:
    """Normal force of a spring and a dashpot in parallel.

    ``F_n = max(0, k_n delta - c_n v_n)``; without the maximum if the contact `may_pull`.

    Parameters
    ----------
    stiffness : float
        k_n [N/m per unit thickness], > 0.
    damping : float
        c_n [N s/m], >= 0; one value for all contacts.
    may_pull : bool
        Keep the force when it is an attraction (ends the contact at zero overlap instead of
        zero force).

    Notes
    -----
    overlap: delta [m] > 0 in contact. v_n [m/s] is the normal velocity of j against i, negative
    on approach. F_n > 0 pushes the grains apart. Valid for overlaps small against the radii.
    Source: model 1.2; Gomes 2014, section 2.1.6 and figure 2.6.

    Raises
    ------
    ParticleError
        If a number is not finite or has the wrong sign.
    """

    stiffness: float
    damping: float = 0.0
    may_pull: bool = False

    def __post_init__(self) -> None:
        require("normal stiffness", self.stiffness, above=0.0)
        require("normal damping", self.damping, at_least=0.0)

    def numbers(self) -> layout.LinearNormal:
        return layout.LinearNormal(float(self.stiffness), float(self.damping), bool(self.may_pull))
