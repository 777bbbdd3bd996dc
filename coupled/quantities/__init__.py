"""Quantities of interest: numbers of a scene's [[quantities]] out of the files of a finished run."""

from coupled.errors import QuantityError
from coupled.quantities.evaluate import evaluate, known_of

__all__ = ["QuantityError", "evaluate", "known_of"]
