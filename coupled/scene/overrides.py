"""Overrides of single keys: ``grains.sizes.0.count=10``, ``damping=absent``."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from coupled.errors import SceneError

ABSENT = "absent"  # the bare word; in quotes it is a string
_BARE_WORD = re.compile(r"[A-Za-z_][\w./-]*")


def parse_override(text: str) -> tuple[list[str], Any]:
    """Split ``a.b=value`` into the path and the value, read as TOML.

    A bare word that is no TOML value counts as a string, because a shell eats quotes; the word ``absent`` is None,
    which leaves the key or table out.
    """
    key, equals, value = (part.strip() for part in text.partition("="))
    if not equals or not key or not all(key.split(".")):
        raise SceneError(f"--set {text}: write it as key=value, e.g. --set time.step=1e-5.")
    try:
        parsed = tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        if not _BARE_WORD.fullmatch(value):
            raise SceneError(
                f"--set {text}: '{value}' is no TOML value; write a number, true, a list or a string in quotes.",
                key=key,
            ) from None
        parsed = None if value == ABSENT else value
    return key.split("."), parsed


def apply_override(data: dict[str, Any], path: list[str], value: Any) -> None:
    """Set one key of the nested tables ``data`` in place; missing tables are made. None takes the key out."""
    here: Any = data
    for depth, part in enumerate(path):
        walked = ".".join(path[:depth])
        slot = _slot(here, part, walked, ".".join(path))
        if depth == len(path) - 1 and value is None:
            here.pop(slot, None) if isinstance(here, dict) else here.pop(slot)
        elif depth == len(path) - 1:
            here[slot] = value
        else:
            here = here[slot] if isinstance(here, list) else here.setdefault(slot, {})


def _slot(here: Any, part: str, walked: str, whole: str) -> str | int:
    """Return the key or index to take in ``here``."""
    if isinstance(here, dict):
        return part
    if not isinstance(here, list):
        raise SceneError(f"--set {whole}: {walked} is a value and has no keys.", key=whole)
    if not part.isdigit() or int(part) >= len(here):
        last = len(here) - 1
        allowed = f"an index from 0 to {last}" if here else "no index, the list is empty"
        raise SceneError(f"--set {whole}: after {walked} comes {allowed}, not {part}.", key=whole)
    return int(part)
