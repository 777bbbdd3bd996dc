"""Small commented scenes that `leito new` writes for a user to start from."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from coupled.errors import LeitoError
from coupled.scene.refusal import nearest

KINDS = ("tube", "beam", "grains")


def write_template(kind: str, to: Path | None = None) -> Path:
    """Write the template of a kind of scene and return the file.

    Parameters
    ----------
    kind
        One of `KINDS`.
    to
        File to write; ``<kind>.toml`` in the working folder when absent. Never overwritten.

    Raises
    ------
    LeitoError
        For an unknown kind, a file that exists, or a folder that does not.
    """
    if kind not in KINDS:
        raise LeitoError(f"{kind}: there is no such kind of scene; {nearest(kind, KINDS)}.")
    path = to if to is not None else Path(f"{kind}.toml")
    text = files(__package__).joinpath(f"{kind}.toml").read_text(encoding="utf-8")
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise LeitoError(f"{path}: is there already; choose another name with --to.") from None
    except OSError as error:
        raise LeitoError(f"{path}: cannot be written: {error.strerror}.") from None
    return path
