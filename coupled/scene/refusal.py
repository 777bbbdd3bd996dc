"""Sentences of refusal: the key's path, its value, what is allowed, the remedy."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import Any

from pydantic import ValidationError

from coupled.errors import SceneError

_WORD = {
    "greater_than": ("must be greater than", "gt"),
    "greater_than_equal": ("must be at least", "ge"),
    "less_than": ("must be less than", "lt"),
    "less_than_equal": ("must be at most", "le"),
}
_KIND = {
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "string_type": "a string in quotes",
    "bool_type": "true or false",
    "tuple_type": "a list in square brackets",
    "model_type": "a table",
    "dict_type": "a table",
    "model_attributes_type": "a table",
}


class Plain(str):
    """A value that is described in words rather than shown."""


def refusal(key: str, value: Any, reason: str) -> SceneError:
    """Return the error ``key = value reason``; the reason is a verb phrase with the remedy."""
    return SceneError(f"{key} = {_shown(value)} {reason}.", key=key)


def missing(key: str, reason: str) -> SceneError:
    """Return the error for a key or table that is not there."""
    return SceneError(f"{key} is missing: {reason}.", key=key)


def nearest(word: str, allowed: Iterable[str]) -> str:
    """Return a suggestion for a mistyped word, with all that is allowed."""
    names = list(allowed)
    close = difflib.get_close_matches(word, names, n=1, cutoff=0.5)
    choice = f"allowed: {', '.join(names)}"
    return f"did you mean '{close[0]}'? ({choice})" if close else choice


def translate(error: ValidationError, describe: dict[str, str]) -> SceneError:
    """Turn a pydantic error into one sentence.

    An unknown key goes first: it is the usual cause of the missing one.

    Parameters
    ----------
    describe
        Descriptions of the keys by their name without list indices.
    """
    problems = error.errors(include_url=False)
    problems.sort(key=lambda problem: problem["type"] not in ("unknown_key", "replaced_key"))
    problem = problems[0]
    path = [str(part) for part in problem["loc"] if not str(part).startswith("<")]
    plain = ".".join(part for part in path if not part.isdigit())
    meaning = f" ({describe[plain]})" if describe.get(plain) else ""
    is_table = any(name.startswith(f"{plain}.") for name in describe)
    return _sentence(problem, ".".join(path), meaning, is_table)


def _sentence(problem: Any, key: str, meaning: str, is_table: bool) -> SceneError:
    kind, value, context = problem["type"], problem["input"], problem.get("ctx", {})
    if kind == "unknown_key":
        unknown = context["unknown"]
        full = f"{key}.{unknown}" if key else unknown
        hint = nearest(unknown, context["allowed"])
        return SceneError(f"{full} is not a known key{context['beside']}: {hint}.", key=full)
    if kind == "replaced_key":
        full = f"{key}.{context['key']}"
        return SceneError(f"{full} is no longer a key: write {context['instead']}.", key=full)
    if kind == "missing":
        return _missing(key, value, meaning, is_table)
    if kind == "unknown_kind":
        given = value.get("kind") if isinstance(value, dict) else value
        return _choice(f"{key}.kind", given, context["allowed"])
    if kind == "literal_error":
        return refusal(key, value, f"must be {context['expected']}{meaning}")
    if kind in _WORD:
        words, name = _WORD[kind]
        return refusal(key, value, f"{words} {context[name]:g}{meaning}")
    if kind in _KIND:
        return refusal(key, value, f"must be {_KIND[kind]}{meaning}")
    if kind == "finite_number":
        return refusal(key, value, f"must be a finite number{meaning}")
    if kind in ("too_short", "too_long"):
        fewest, most = context.get("min_length"), context.get("max_length")
        bound = f"at least {fewest}" if kind == "too_short" else f"at most {most}"
        return refusal(key, value, f"must have {bound} entries{meaning}")
    return refusal(key, value, f"{problem['msg'][:1].lower()}{problem['msg'][1:]}{meaning}")


def _missing(key: str, value: Any, meaning: str, is_table: bool) -> SceneError:
    table, _, last = key.rpartition(".")
    if last.isdigit():
        return refusal(table, value, f"has too few entries{meaning}")
    if is_table:
        return missing(key, f"add the table [{key}]{meaning}")
    where = f"to the table [{table}]" if table else "at the top of the file"
    return missing(key, f"add it {where}{meaning}")


def _choice(key: str, value: Any, allowed: Sequence[str]) -> SceneError:
    if value is None:
        return missing(key, f"give one of {', '.join(allowed)}")
    return refusal(key, value, f"is unknown; {nearest(str(value), allowed)}")


def _shown(value: Any) -> str:
    """Return a value as TOML would write it, shortened."""
    if isinstance(value, Plain):
        return value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{...}"
    if isinstance(value, (list, tuple)):
        text = "[" + ", ".join(_shown(item) for item in value) + "]"
    elif isinstance(value, float):
        text = f"{value:.6g}"
    elif isinstance(value, str):
        text = f'"{value}"'
    else:
        text = str(value)
    return text if len(text) <= 60 else text[:57] + "..."
