"""The page `docs/validation/extremes.md`."""

from __future__ import annotations

from collections.abc import Sequence

from limit_search import ranges
from trials import Axis
from verdict import GOOD, Verdict

LONGEST = 130  # characters of what is wrong, and of the remedy
REMEDY = " To change: "
TEXT = """# Where the limits lie

Written by `make validate`.

Every axis is pushed until it breaks. A run must end in one of three ways: *right*, checked against a closed form, a
conservation law or a scaling law; *refused* at the start in a sentence; *stopped* by a watchdog in a sentence, with the
last good state on disk. Each is a run of the command `leito` in a process with limits of time and memory; all files
that it leaves are searched for numbers that are not finite. Where an axis has a number, the changes are closed in on by
bisection. Any other end is a defect; the map has a column for it while there is one.

## Map

{map}

{parts}
"""


def page(found: Sequence[tuple[Axis, list[Verdict]]]) -> str:
    """The whole page."""
    ends = [*GOOD, *sorted({verdict.outcome for _, verdicts in found for verdict in verdicts} - set(GOOD))]
    rows = [
        [f"[{axis.name}](#{_anchor(axis.name)})", *(ranges(verdicts, axis, end) for end in ends)]
        for axis, verdicts in found
    ]
    parts: dict[str, list[str]] = {}
    for axis, verdicts in found:
        parts.setdefault(axis.part, []).append(_section(axis, verdicts))
    text = "\n\n".join(f"## {name}\n\n" + "\n\n".join(sections) for name, sections in parts.items())
    return TEXT.format(map=_table(["axis", *ends], rows), parts=text)


def _section(axis: Axis, verdicts: list[Verdict]) -> str:
    rows = []
    for verdict in verdicts:
        number = verdict.measured
        against = ["", "", ""]
        if number is not None:
            against = [number.what, f"{number.value:.6g}", f"{number.expected:.6g} ± {number.allowed:.1g}"]
        rows.append([axis.show(verdict.value), verdict.outcome, *against, _shortened(verdict.sentence)])
    head = ["value", "outcome", "farthest from right", "measured", "expected", "sentence"]
    return f"### {axis.name}\n\n{axis.text}\n\n{_table(head, rows)}"


def _shortened(sentence: str) -> str:
    wrong, remedy, change = sentence.replace("|", "\\|").replace("\n", " ").partition(REMEDY)
    return _cut(wrong) + remedy + _cut(change)


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    return "\n".join(lines + [f"| {' | '.join(row)} |" for row in rows])


def _anchor(heading: str) -> str:
    """As GitHub makes it."""
    kept = "".join(letter for letter in heading.lower() if letter.isalnum() or letter in " -_")
    return kept.replace(" ", "-")
