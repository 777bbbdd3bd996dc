"""All settings against the references of all quantities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from coupled.errors import LeitoError
from coupled.scene.quantities import Quantity
from coupled.study.judging.errors import Judged, judge
from coupled.study.judging.reference import EXACT, Reference, own_error, scale_of
from coupled.study.settings.setting import Ran


def references(rans: Sequence[Ran], quantities: Sequence[Quantity], *, chance: bool) -> dict[str, Reference]:
    """The reference of each quantity: its closed form, or the finest setting that came to its end and has it.

    Quantities that no setting has, or that lack a reference beside others that do not, are left out.

    Raises
    ------
    LeitoError
        If there is nothing to compare, or nothing to compare with.
    """
    known = [quantity for quantity in quantities if any(quantity.name in ran.values for ran in rans)]
    if not known:
        raise LeitoError(f"no setting of this study has any of its quantities: {rans[0].lacking}")
    found = {quantity.name: _reference(rans, quantity, chance) for quantity in known}
    there = {name: reference for name, reference in found.items() if reference is not None}
    if not there:
        finest = next((ran.lacking for ran in rans if ran.setting.role == "reference"), "it was not run")
        raise LeitoError(f"the reference of this study has no {known[0].name}: {finest}; give another with --reference")
    return there


def _reference(rans: Sequence[Ran], quantity: Quantity, chance: bool) -> Reference | None:
    name = quantity.name
    done = [ran for ran in rans if name in ran.values]
    finest = _finest(done, name, chance)
    if quantity.exact is not None:
        return _closed_form(finest, quantity, _scale(done, quantity, quantity.exact))
    return None if finest is None else replace(finest, scale=_scale(done, quantity, finest.mean))


def _finest(done: Sequence[Ran], name: str, chance: bool) -> Reference | None:
    """The finest level that is there, with its own error from the levels before it."""
    by_role = {ran.setting.role: ran for ran in done}
    chain = [by_role[role] for role in ("base", "finer", "reference") if role in by_role]
    if not chain or chain[-1].setting.role == "base":
        return None
    finest = chain[-1]
    means = [sum(ran.values[name]) / len(ran.values[name]) for ran in chain]
    graded = bool(finest.setting.knobs)  # not one that the user has given
    error, order = own_error(means if graded else means[-1:])
    found = Reference(samples=finest.values[name], error=error, source=finest.setting.name, order=order, scale=1.0)
    if graded and chance and judge(chain[-2], name, found, chance=True).verdict in ("not resolved", "one sample"):
        return replace(found, error=0.0, order=None, open=True)
    return found


def _closed_form(finest: Reference | None, quantity: Quantity, scale: float) -> Reference:
    """A closed form; how far the finest levels go past it is its own error.

    A beam theory has assumptions that a mesh does not share. Settings cannot be told apart where they are closer to it
    than what they converge to.
    """
    error = 0.0
    if finest is not None and len(finest.samples) == 1 and finest.error < abs(finest.mean - quantity.exact):
        error = abs(finest.mean - quantity.exact) - finest.error
    return Reference(samples=(quantity.exact,), error=error, source=EXACT, scale=scale)


def _scale(done: Sequence[Ran], quantity: Quantity, right: float) -> float:
    return quantity.scale or scale_of(right, [value for ran in done for value in ran.values[quantity.name]])


def judge_all(rans: Sequence[Ran], found: dict[str, Reference], *, chance: bool) -> dict[str, list[Judged]]:
    """Every setting that is done, by quantity."""
    return {
        name: [judge(ran, name, reference, chance=chance) for ran in rans if name in ran.values]
        for name, reference in found.items()
    }
