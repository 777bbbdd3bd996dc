"""The grid of an ensemble: `--vary key=a,b,c`, each with every other."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass

from coupled.errors import LeitoError
from coupled.scene.overrides import parse_override

_UNFIT = re.compile(r"[^\w.,=+-]+")  # for the name of a folder
_OPENS, _CLOSES, _QUOTES = "[{", "]}", "\"'"


@dataclass(frozen=True)
class Combination:
    """One value for each key that is varied, as the user wrote them; without any, the scene itself."""

    values: tuple[tuple[str, str], ...]

    @property
    def overrides(self) -> list[str]:
        """As `--set` takes them."""
        return [f"{key}={value}" for key, value in self.values]

    @property
    def label(self) -> str:
        """Name of a folder."""
        return _UNFIT.sub("_", ",".join(self.overrides))


def grid(vary: Sequence[str], fixed: Sequence[str] = ()) -> list[Combination]:
    """All combinations, the last key running fastest.

    Parameters
    ----------
    vary : sequence of str
        ``"key=a,b,c"``.
    fixed : sequence of str
        Overrides of single keys, which must be others.

    Raises
    ------
    LeitoError
        For a key or a value that is given twice, or a text that is no list of values.
    """
    axes = [_axis(text) for text in vary]
    taken = [".".join(parse_override(text)[0]) for text in fixed]
    for key, _ in axes:
        if key in taken:
            raise LeitoError(f"--vary {key}: the key is given twice; set it, or vary it once with all its values.")
        taken.append(key)
    keys = [key for key, _ in axes]
    found = [Combination(tuple(zip(keys, values, strict=True))) for values in itertools.product(*(v for _, v in axes))]
    labels = [combination.label for combination in found]
    for combination in found:
        if labels.count(combination.label) > 1:
            raise LeitoError(
                f"--vary: {combination.label} would be the folder of two combinations; give each value once."
            )
    return found


def _axis(text: str) -> tuple[str, list[str]]:
    key, equals, values = (part.strip() for part in text.partition("="))
    pieces = _pieces(values)
    if not equals or not key or not all(pieces):
        raise LeitoError(f"--vary {text}: write it as key=a,b,c, e.g. --vary contact.friction=0.2,0.5.")
    for piece in pieces:
        parse_override(f"{key}={piece}")
    return key, pieces


def _pieces(values: str) -> list[str]:
    """The values between commas, those inside brackets and quotes left alone."""
    pieces, depth, quote = [""], 0, ""
    for letter in values:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in _QUOTES:
            quote = letter
        elif letter == "," and depth == 0:
            pieces.append("")
            continue
        else:
            depth += (letter in _OPENS) - (letter in _CLOSES)
        pieces[-1] += letter
    return [piece.strip() for piece in pieces]
