"""Where scene files are found: a path, or the bare name of a scene that ships."""

from __future__ import annotations

import sys
from pathlib import Path

from coupled.errors import SceneError
from coupled.scene.refusal import nearest


def shipping_folder() -> Path | None:
    """Return the folder of the scenes that ship: the checkout's, or the installed one."""
    checkout = Path(__file__).resolve().parents[2] / "scenes"
    installed = Path(sys.prefix) / "share" / "leito" / "scenes"
    return next((folder for folder in (checkout, installed) if any(folder.glob("*.toml"))), None)


def shipping_scenes() -> dict[str, Path]:
    """Return the scenes that ship, by name."""
    folder = shipping_folder()
    return {path.stem: path for path in sorted(folder.glob("*.toml"))} if folder else {}


def find_scene(name: str | Path, *, beside: Path | None = None) -> Path:
    """Return the file of a scene.

    Parameters
    ----------
    name
        Path of a scene file, or the bare name of a scene.
    beside
        Folder that is searched first, for a scene that another one names.

    Raises
    ------
    SceneError
        When there is no such file.
    """
    asked = Path(name)
    folder = beside or Path()
    for candidate in (folder / asked, folder / f"{asked}.toml"):
        if candidate.is_file():
            return candidate
    shipping = shipping_scenes()
    if str(name) in shipping:
        return shipping[str(name)]
    if asked.suffix == ".toml" or len(asked.parts) > 1:
        raise SceneError(f"{folder / asked}: there is no such file; give the path of a scene file.")
    hint = nearest(str(name), shipping)
    raise SceneError(f"{name}: no scene file and no scene that ships has this name; {hint}.")
