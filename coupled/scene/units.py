"""Units behind numbers in sentences: those of a dimensionless scene are told without."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

from coupled.errors import is_sentence

_UNITS = (
    "N m s/m", "N/m^(3/2)", "N m/rad", "N s/m", "N/m", "J/m", "kg/m3", "kg/m", "m/s2", "m/s", "rad/s", "1/s", "Pa",
    "Hz", "kg", "m", "s",
)  # fmt: skip
_ANY = "|".join(re.escape(unit) for unit in _UNITS)
_NUMBERED = re.compile(rf"(?<=[0-9)\]]) (?:{_ANY})(?![\w/^(])")
_BRACKETED = re.compile(rf" \[(?:{_ANY})(?:, (?:{_ANY}))*\]")
_ASKED = re.compile(rf" in (?:{_ANY})(?![\w/^(])")


def in_units(text: str, units: str) -> str:
    """A sentence written with SI units, for a scene whose key `units` is given.

    A dimensionless scene's loses the units behind numbers, in brackets, and after "in". Radians stay. Wall times are
    seconds in every scene: texts that have some must not come here.
    """
    if units == "SI":
        return text
    for pattern in (_NUMBERED, _BRACKETED, _ASKED):
        text = pattern.sub("", text)
    return text


@contextmanager
def told_in(units: str) -> Iterator[None]:
    """Give the sentence of an error that leaves the block the units of a scene."""
    try:
        yield
    except Exception as error:
        if units != "SI" and is_sentence(error) and error.args:
            error.args = (in_units(str(error), units), *error.args[1:])
        raise
