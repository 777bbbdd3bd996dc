"""The law of a pair of materials out of a table."""

from collections.abc import Callable
from typing import Any

from numba.core import types
from numba.extending import overload


def of_pair(laws, i, j):
    """The laws between materials `i` and `j`: the numbers at [i, j] wherever `laws` has arrays.

    Laws without arrays are the same for all, and are handed through when a kernel is compiled.
    """


def _at_pair(law: types.Type, path: str, names: dict[str, Any]) -> str:
    """Python for the law at [i, j]; enters the classes it calls into `names`."""
    if isinstance(law, types.Array):
        return f"{path}[i, j]"
    if isinstance(law, types.BaseNamedTuple):
        names[law.instance_class.__name__] = law.instance_class
        parts = [_at_pair(part, f"{path}.{field}", names) for field, part in zip(law.fields, law.types, strict=True)]
        return f"{law.instance_class.__name__}({', '.join(parts)})"
    return path


@overload(of_pair, strict=False, jit_options={"forceinline": True})
def _of_pair(laws: types.Type, i: types.Type, j: types.Type) -> Callable[..., Any]:
    names: dict[str, Any] = {}
    source = _at_pair(laws, "laws", names)
    if "[i, j]" not in source:
        return lambda laws, i, j: laws
    exec(f"def choice(laws, i, j):\n    return {source}", names)
    return names["choice"]
