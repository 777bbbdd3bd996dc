"""PETSc options of the linear solvers: taken from text, recorded, and asked whether they were of use."""

from __future__ import annotations

import ctypes
import shlex

from petsc4py import PETSc

from structure.errors import StructureError
from structure.solvers.solver import PREFIX

EXAMPLE = f'"-{PREFIX}ksp_type cg -{PREFIX}pc_type gamg"'


def set_solver_options(text: str) -> None:
    """Set options for all solvers that are made from now on, e.g. ``-leito_ksp_type cg -leito_pc_type gamg``.

    Raises
    ------
    StructureError
        A name without the prefix, or a value without a name.
    """
    words = _words(text)
    options = PETSc.Options()
    for place, word in enumerate(words):
        if not _is_name(word):
            if place == 0 or not _is_name(words[place - 1]):
                raise StructureError(
                    f"PETSc options have {word!r} where a name is expected: write names and values in turn, "
                    f"as in {EXAMPLE}"
                )
            continue
        if not word.startswith(f"-{PREFIX}"):
            raise StructureError(
                f"PETSc option {word} does not begin with -{PREFIX}: options of the structure's solvers do, "
                f"as in {EXAMPLE}"
            )
        value = words[place + 1] if place + 1 < len(words) and not _is_name(words[place + 1]) else None
        options.setValue(word, value)


def solver_options() -> dict[str, str]:
    """The options of our solvers that are set, by name, whoever has set them."""
    return {name: value for name, value in PETSc.Options().getAll().items() if name.startswith(PREFIX)}


def unused_solver_options() -> list[str]:
    """Names of options that no solver has asked for so far.

    petsc4py does not tell this; PETSc's own function is found through the library it has loaded.
    """
    was_used = ctypes.CDLL(PETSc.__file__).PetscOptionsUsed
    unused = []
    for name in solver_options():
        used = ctypes.c_int(0)
        was_used(None, name.encode(), ctypes.byref(used))
        if not used.value:
            unused.append(f"-{name}")
    return unused


def _words(text: str) -> list[str]:
    try:
        return shlex.split(text)
    except ValueError as error:
        raise StructureError(f"PETSc options {text!r} cannot be read ({error}): close the quotes") from None


def _is_name(word: str) -> bool:
    """Whether a word is a name; numbers may begin with a minus sign too."""
    return word.startswith("-") and word[1:2].isalpha()
