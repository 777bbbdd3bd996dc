"""What contacts remember from step to step: arrays with one entry for each listed pair."""

from typing import Any

import numpy as np

from particles.contact import Contact

NAMES = ("spring", "moment", "dash_n", "dash_t", "dash_r")


def fresh_history(contact: Contact, slots: int, *, ledger: bool, precision: str = "float64") -> dict[str, np.ndarray]:
    """Zeros for `slots` pairs, by name: springs as the law has them, dashpot forces for the ledger."""
    kept = (contact.spins, contact.rolls, ledger, ledger, ledger and contact.damps_rolling)
    return {name: np.zeros(slots if wanted else 0, precision) for name, wanted in zip(NAMES, kept, strict=True)}


def history_of(listed: Any) -> tuple[np.ndarray, ...]:
    """The same arrays of a list of pairs, walls or facets, in one order."""
    return tuple(getattr(listed, name) for name in NAMES)
