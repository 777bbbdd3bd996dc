"""What a user asks of a study: knobs, values of knobs (``step=2,1,0.5``), keys of the reference."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Sequence

from coupled.errors import LeitoError
from coupled.scene.overrides import parse_override
from coupled.scene.refusal import nearest
from coupled.study.settings.knobs import BY_NAME
from coupled.study.settings.turns import Value


def knob_names(text: str) -> tuple[str, ...]:
    """Read names of knobs between commas; the word none is no knob."""
    return () if text.strip() == "none" else tuple(name.strip() for name in text.split(","))


def knob_values(texts: Iterable[str]) -> dict[str, tuple[Value, ...]]:
    """Read values of knobs; numbers of a knob whose values are numbers must be positive.

    Raises
    ------
    LeitoError
        For an unknown knob, one given twice, or values that it cannot have.
    """
    found: dict[str, tuple[Value, ...]] = {}
    for text in texts:
        name, equals, listed = (part.strip() for part in text.partition("="))
        if not equals or not listed:
            raise LeitoError(f"--values {text}: write it as knob=a,b,c, e.g. --values step=2,1,0.5")
        if name not in BY_NAME:
            raise LeitoError(f"--values {text}: there is no knob {name}; {nearest(name, BY_NAME)}")
        if name in found:
            raise LeitoError(f"--values {text}: {name} is given twice; give all its values at once")
        found[name] = tuple(_value(text, name, part.strip()) for part in listed.split(","))
    return found


def reference_keys(texts: Sequence[str]) -> tuple[str, ...]:
    """Keys of the reference, as ``--set`` takes them.

    Raises
    ------
    LeitoError
        For a text that is none.
    """
    for text in texts:
        try:
            parse_override(text)
        except LeitoError as error:
            raise LeitoError(str(error).replace("--set", "--reference")) from None
    return tuple(texts)


def _value(text: str, name: str, part: str) -> Value:
    usual = BY_NAME[name].values
    if isinstance(usual[0], str):
        if part not in usual:
            raise LeitoError(f"--values {text}: '{part}' is no value of {name}; {nearest(part, map(str, usual))}")
        return part
    try:
        value = tomllib.loads(f"value = {part}")["value"]
    except tomllib.TOMLDecodeError:
        value = None
    whole = isinstance(usual[0], int)
    if isinstance(value, bool) or not isinstance(value, int if whole else (int, float)) or not value > 0:
        raise LeitoError(
            f"--values {text}: '{part}' is no value of {name}; give {'whole numbers' if whole else 'numbers'} above 0"
        )
    return value if whole else float(value)
